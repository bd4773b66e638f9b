"""`boresight simulate`."""

from __future__ import annotations

from pathlib import Path

from rich.markup import escape

from boresight.calibration.simulate import simulate
from boresight.cli.codes import LARGEST_SEED
from boresight.cli.consoles import PipedConsole
from boresight.cli.doing import Doing
from boresight.errors import InputError
from boresight.files import load_campaign
from boresight.files.rehearsals import write_rehearsal

MOST_ROWS = 1_000_000
"""As many readings as a calibration is meant for."""


def run_simulate(
    path: Path, output: Path | None, *, rows: int | None, validation_rows: int, size: float, seed: int
) -> int:
    """Returns the exit code of a simulation, its campaign written."""
    problems = [
        f"{option}: expected {expected}, got {given}"
        for option, given, expected, wrong in (
            ("--rows", rows, f"1 to {MOST_ROWS}", rows is not None and not 1 <= rows <= MOST_ROWS),
            ("--validation-rows", validation_rows, f"1 to {MOST_ROWS}", not 1 <= validation_rows <= MOST_ROWS),
            ("--size", size, "a factor from 0 to 100", not 0.0 <= size <= 100.0),
            ("--seed", seed, f"a whole number from 0 to {LARGEST_SEED}", not 0 <= seed <= LARGEST_SEED),
        )
        if wrong
    ]
    if problems:
        raise InputError(problems)
    with Doing() as doing:
        doing.begin(f"reading {path.name}")
        campaign = load_campaign(path)
        folder = output or Path(f"{campaign.name}-simulated")
        doing.begin("drawing configurations and their readings")
        rehearsal = simulate(campaign, rows=rows, validation_rows=validation_rows, size=size, seed=seed)
        doing.begin(f"writing {folder.name}")
        written = write_rehearsal(campaign, rehearsal, path, folder)
    console = PipedConsole()
    console.print(
        f"Simulated {len(rehearsal.readings)} calibration and {len(rehearsal.validation)} validation rows of "
        f"[bold]{escape(campaign.name)}[/], seed {seed}."
    )
    console.print(f"Next: boresight calibrate {escape(str(written))}", soft_wrap=True, highlight=False)
    return 0
