"""`boresight inspect`."""

from __future__ import annotations

from pathlib import Path

from boresight import __version__
from boresight.calibration.inspect import inspect
from boresight.cli.codes import LARGEST_SEED
from boresight.cli.compiling import told_of_compiling
from boresight.cli.consoles import PipedConsole, print_plain
from boresight.cli.doing import Doing
from boresight.errors import InputError
from boresight.files import load_campaign
from boresight.kernels.linearising import linearise_rows
from boresight.report.inspection import inspection_json, print_inspection
from boresight.sensing.linear import is_compiled

MOST_ROWS = 100_000
"""More configurations than anyone plans by hand; what can be known settles long before."""


def run_inspect(path: Path, *, rows: int | None, seed: int, as_json: bool) -> int:
    """Returns the exit code of an inspection, its findings shown."""
    problems = []
    if rows is not None and not 1 <= rows <= MOST_ROWS:
        problems.append(f"--rows: expected 1 to {MOST_ROWS}, got {rows}")
    if not 0 <= seed <= LARGEST_SEED:
        problems.append(f"--seed: expected a whole number from 0 to {LARGEST_SEED}, got {seed}")
    if problems:
        raise InputError(problems)
    with Doing(silent=as_json) as doing:
        doing.begin(f"reading {path.name}")
        campaign = load_campaign(path)
        told_of_compiling(*([linearise_rows] if is_compiled(campaign.cell) else []))
        doing.begin("asking what the rows can know")
        found = inspect(campaign, rows=rows, seed=seed)
    if as_json:
        print_plain(inspection_json(found, __version__))
    else:
        print_inspection(PipedConsole(), found)
    return 0
