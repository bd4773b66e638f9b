"""`boresight simulate`."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console
from rich.markup import escape

from boresight.calibration.simulate import simulate
from boresight.errors import InputError
from boresight.files import load_campaign
from boresight.files.rehearsals import write_rehearsal


def run_simulate(
    path: Path, output: Path | None, *, rows: int | None, validation_rows: int, size: float, seed: int
) -> int:
    """Returns the exit code of a simulation, its campaign written."""
    problems = [
        f"{option}: expected {expected}, got {given}"
        for option, given, expected, wrong in (
            ("--rows", rows, "at least 1", rows is not None and rows < 1),
            ("--validation-rows", validation_rows, "at least 1", validation_rows < 1),
            ("--size", size, "a factor from 0 to 100", not 0.0 <= size <= 100.0),
            ("--seed", seed, "a whole number from 0", seed < 0),
        )
        if wrong
    ]
    if problems:
        raise InputError(problems)
    campaign = load_campaign(path)
    folder = output or Path(f"{campaign.name}-simulated")
    rehearsal = simulate(campaign, rows=rows, validation_rows=validation_rows, size=size, seed=seed)
    written = write_rehearsal(campaign, rehearsal, path, folder)
    console = Console()
    console.print(
        f"Simulated {len(rehearsal.readings)} calibration and {len(rehearsal.validation)} validation rows of "
        f"[bold]{escape(campaign.name)}[/], seed {seed}."
    )
    console.print(f"Next: boresight calibrate {escape(str(written))}", soft_wrap=True, highlight=False)
    return 0
