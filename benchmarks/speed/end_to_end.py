"""A campaign's files to its result folder: `python -m boresight calibrate --solver least-squares`, a process each time.

One plane whose tilt is estimated, 25 parameters, 100 validation rows of other configurations; readings in CSV with
nine digits, and in Parquet where it is taken. Wall time, processor time and peak memory are those of the process,
imports, reading, fitting, judging and the report included; compiled code is on disk. Robot and campaign file are
those of the example `space-arm-one-plane`.
"""

from __future__ import annotations

import importlib.util
import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.report import Table
from benchmarks.space_arm import draw, one_plane
from benchmarks.speed.processes import ACCEPTED_OR_NOT, Ended, boresight
from benchmarks.speed.timing import say

EXAMPLE = Path(__file__).parents[2] / "examples" / "space-arm-one-plane"
VALIDATION_ROWS, VALIDATION_SEED = 100, 1_000_000

DRAWN_AT_ONCE = 50_000
"""Configurations of a seed; a million is drawn in parts."""


@dataclass(frozen=True)
class EndToEnd:
    """One size of campaign, calibrated.

    Attributes:
        readings: how many.
        kind: of file.
        size: of the file [bytes].
        runs: the processes.
    """

    readings: int
    kind: str
    size: int
    runs: tuple[Ended, ...]

    @property
    def wall(self) -> float:
        """Median wall time [s]."""
        return float(np.median([run.wall for run in self.runs]))

    @property
    def peak(self) -> int:
        """Largest memory of any run [bytes]."""
        return max(run.peak for run in self.runs)

    def as_values(self) -> dict[str, object]:
        """Returns it as plain values."""
        runs = [{"wall_s": run.wall, "user_s": run.user, "peak_bytes": run.peak} for run in self.runs]
        return {"readings": self.readings, "file": self.kind, "file_bytes": self.size, "runs": runs}


def measure(sizes: tuple[int, ...], rounds: int) -> tuple[list[EndToEnd], list[str]]:
    """Returns what every size took, and notes on what was left out."""
    found, notes = [], []
    with tempfile.TemporaryDirectory() as named:
        folder = Path(named)
        _prepare(folder)
        truth, drawn = _rows(max(sizes))
        _write_csv(folder / "validation.csv", _rows_of(truth, VALIDATION_ROWS, VALIDATION_SEED))
        kinds = ["rows.csv", *(["rows.parquet"] if importlib.util.find_spec("pyarrow") else [])]
        for kind in kinds:
            refused = False
            for readings in sizes:
                if refused:
                    break
                say(f"end to end: {readings:,} readings, {kind}")
                (_write_csv if kind.endswith("csv") else _write_parquet)(folder / kind, drawn[:readings])
                _name_rows(folder, kind)
                runs = tuple(_calibrate(folder) for _ in range(rounds if readings < 1_000_000 else 1))
                if any(run.code not in ACCEPTED_OR_NOT for run in runs):
                    reason = runs[0].said.strip().splitlines()[-1:] or [f"exit code {runs[0].code}"]
                    notes.append(f"End to end, {readings:,} readings in {kind}: refused ({reason[0][:160].strip()}).")
                    refused = True
                    continue
                found.append(EndToEnd(readings, kind.split(".")[1], (folder / kind).stat().st_size, runs))
    return found, notes


def table_of(found: list[EndToEnd]) -> Table:
    """Returns them as text."""
    header = ("readings", "file", "size, MB", "wall, s", "least, s", "processor, s", "peak memory, MB", "runs")
    rows = tuple(
        (
            f"{each.readings:,}", each.kind, f"{each.size / 1e6:.1f}", f"{each.wall:.2f}",
            f"{min(run.wall for run in each.runs):.2f}", f"{np.median([run.user for run in each.runs]):.2f}",
            f"{each.peak / 1e6:.0f}", f"{len(each.runs)}",
        )
        for each in found
    )  # fmt: skip
    return Table("Files to result folder, `calibrate --solver least-squares`, a process each", header, rows)


def write_campaign(folder: Path, readings: int, seed: int = 0) -> None:
    """Writes a campaign and its readings into a folder, for `python -m boresight calibrate campaign.yaml`."""
    _prepare(folder)
    truth, drawn = _rows(readings, seed)
    _write_csv(folder / "rows.csv", drawn)
    _write_csv(folder / "validation.csv", _rows_of(truth, VALIDATION_ROWS, VALIDATION_SEED))
    _name_rows(folder, "rows.csv")


def _prepare(folder: Path) -> None:
    shutil.copy(EXAMPLE / "robot.yaml", folder)


def _name_rows(folder: Path, kind: str) -> None:
    text = (EXAMPLE / "campaign.yaml").read_text().replace("observations.csv", kind)
    (folder / "campaign.yaml").write_text(text)


def _calibrate(folder: Path) -> Ended:
    arguments = ["calibrate", "campaign.yaml", "--solver", "least-squares", "-o", "result"]
    ended = boresight(arguments, folder)
    shutil.rmtree(folder / "result", ignore_errors=True)
    return ended


def _rows(count: int, seed: int = 0):
    """Returns the truth of a seed, and joint readings and ranges (count, joints + 1) of it."""
    truth = draw(one_plane(10), seed).truth
    starts = range(0, count, DRAWN_AT_ONCE)
    if count >= DRAWN_AT_ONCE:
        say(f"end to end: drawing {count:,} readings")
    parts = [_rows_of(truth, min(DRAWN_AT_ONCE, count - first), 1 + part) for part, first in enumerate(starts)]
    return truth, np.concatenate(parts)


def _rows_of(truth, count: int, seed: int) -> np.ndarray:
    from boresight.synthetic import draw_configurations, simulated_readings

    joints, target = draw_configurations((truth,), count, seed)
    return np.column_stack([joints, simulated_readings(truth, joints, target, seed).values])


def _names(rows: np.ndarray) -> list[str]:
    return [*(f"j{joint}" for joint in range(1, rows.shape[1])), "range"]


def _write_csv(path: Path, rows: np.ndarray) -> None:
    np.savetxt(path, rows, fmt="%.9f", delimiter=",", header=",".join(_names(rows)), comments="")


def _write_parquet(path: Path, rows: np.ndarray) -> None:
    import pyarrow
    from pyarrow import parquet

    parquet.write_table(pyarrow.table(dict(zip(_names(rows), rows.T, strict=True))), path)
