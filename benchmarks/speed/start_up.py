"""What a user waits for before anything is calibrated: whole processes, from their start to their end.

Warm is with compiled code on disk; cold is the first run on a machine, its cache an empty folder, where what is
compiled has to be said on stderr.
"""

from __future__ import annotations

import shutil
import tempfile
from dataclasses import replace
from pathlib import Path

from benchmarks.speed.end_to_end import write_campaign
from benchmarks.speed.lines import Line, lines_of
from benchmarks.speed.processes import ACCEPTED_OR_NOT, boresight
from benchmarks.speed.timing import Entry, interleaved

READINGS = 100
HELP, WARM, COLD = "--help", f"calibrate {READINGS} readings", f"calibrate {READINGS} readings, cold"
ANNOUNCED = "Compiling for this machine"


def measure(rounds: int, cold_rounds: int) -> list[Line]:
    """Returns the lines: `--help`, warm and cold calibrations with the default solver."""
    with tempfile.TemporaryDirectory() as named:
        folder = Path(named)
        write_campaign(folder, READINGS)

        def calibrate(environment: dict[str, str]) -> str:
            ended = boresight(["calibrate", "campaign.yaml", "-o", "result"], folder, environment)
            shutil.rmtree(folder / "result", ignore_errors=True)
            assert ended.code in ACCEPTED_OR_NOT, ended.said
            return ended.said

        def help_(_: int) -> None:
            ended = boresight(["--help"], folder)
            assert ended.code == 0, ended.said

        def warm(_: int) -> None:
            calibrate({})

        announced: list[bool] = []

        def cold(_: int) -> None:
            with tempfile.TemporaryDirectory() as cache:
                announced.append(ANNOUNCED in calibrate({"NUMBA_CACHE_DIR": cache}))

        warm(0)
        timed = interleaved([Entry(HELP, help_), Entry(WARM, warm)], rounds, title="start-up")
        first = interleaved([Entry(COLD, cold)], cold_rounds, title="start-up", warm=False)
        said = "compiling announced" if all(announced) else "NOT announced"
    lines = lines_of("process", timed) + lines_of("process", first)
    return [replace(line, notes=said) if line.who == COLD else line for line in lines]
