"""`boresight compensate`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.markup import escape

from boresight.cli.codes import NOT_REACHED
from boresight.cli.compiling import told_of_compiling
from boresight.cli.consoles import PipedConsole, print_plain
from boresight.compensation import Compensation, Reached, compensate
from boresight.errors import InputError, OutputError
from boresight.files.commands import commands_csv
from boresight.files.poses import read_poses
from boresight.files.writing import write_atomically
from boresight.kernels.reaching import reach
from boresight.report.stored import load_result
from boresight.units import Units, in_millimetres

_SHOWN = 5


def run_compensate(
    folder: Path,
    path: Path,
    output: Path | None,
    *,
    controller_poses: bool,
    position_only: bool,
    length: str,
    angle: str,
    overwrite: bool,
    as_json: bool,
) -> int:
    """Returns the exit code of a compensation, its commands written and what became of the poses shown."""
    stored, units = load_result(folder), Units(length, angle)  # type: ignore[arg-type]
    if not stored.accepted:
        raise InputError(f"{folder}: this result was rejected, so the arm it describes should not be used")
    target = output or Path(f"{path.stem}-compensated.csv")
    if target.exists() and not overwrite:
        raise OutputError(f"{target}: is there already; name another file with -o, or say --overwrite")
    if target.exists() and path.exists() and target.samefile(path):
        raise OutputError(f"{target}: is the file of the poses itself; name another file with -o")
    wanted = read_poses(path, stored.identified, units)
    told_of_compiling(reach)
    found = compensate(
        stored.nominal,
        stored.identified,
        joints=wanted.joints,
        poses=wanted.poses,
        position_only=position_only or wanted.free,
    )
    write_atomically(target, commands_csv(found, units, wanted.others, controller_poses))
    if as_json:
        print_plain(json.dumps(_summary(found, target) | {"notes": list(wanted.notes)}, indent=2) + "\n")
    else:
        _show(PipedConsole(), found, target, controller_poses, wanted.notes)
    return 0 if found.count(Reached.YES) + found.count(Reached.NEAR_SINGULAR) == len(found) else NOT_REACHED


def _summary(found: Compensation, target: Path) -> dict[str, object]:
    """Returns what became of the poses, as plain values."""
    return {
        "poses": len(found),
        "outcomes": {each.name.lower().replace("_", "-"): found.count(each) for each in Reached},
        "before": _sizes(found.before),
        "after": _sizes(found.missing),
        "not_reached_rows": [int(row) + 1 for row in np.flatnonzero(found.reached >= Reached.AT_A_LIMIT)],
        "near_singular_rows": [int(row) + 1 for row in np.flatnonzero(found.reached == Reached.NEAR_SINGULAR)],
        "output": str(target),
    }


def _sizes(errors: np.ndarray) -> dict[str, dict[str, float]]:
    return {
        what: {"rms": float(np.sqrt(np.mean(errors[:, column] ** 2))), "max": float(errors[:, column].max())}
        for column, what in enumerate(("position_m", "orientation_rad"))
    }


def _show(console: Console, found: Compensation, target: Path, controller_poses: bool, notes: tuple[str, ...]) -> None:
    """Prints what became of the poses, the first of those that were not reached row by row."""
    what = "Poses for a controller with the nominal model" if controller_poses else "Joint commands"
    reached = found.count(Reached.YES) + found.count(Reached.NEAR_SINGULAR)
    console.print(f"{what} for [bold]{len(found)}[/] pose{'s' if len(found) != 1 else ''}: {reached} reached.")
    off = np.sqrt(np.mean(found.before**2, axis=0))
    console.print(f"  Uncompensated, the tool would be {in_millimetres(off[0])} and {1e3 * off[1]:.3g} mrad off (RMS).")
    revolute = [joint.type == "revolute" for joint in found.calibrated.driven]
    moved = np.abs(found.moved[found.reached <= Reached.NEAR_SINGULAR][:, revolute])
    if moved.size:
        console.print(
            f"  Turning joints move by at most {1e3 * moved.max():.3g} mrad, half of them by less than "
            f"{1e3 * np.median(moved):.3g}."
        )
    singular = found.count(Reached.NEAR_SINGULAR)
    if singular:
        console.print(f"  {singular} near a singular configuration: small errors there need large joint motions.")
    failed = np.flatnonzero(found.reached >= Reached.AT_A_LIMIT)
    for row in failed[:_SHOWN]:
        console.print(f"  Row {row + 1}: {_why(found, int(row))}")
    if len(failed) > _SHOWN:
        console.print(f"  and {len(failed) - _SHOWN} more rows, marked in the column `reached`.")
    for note in notes:
        console.print(f"Note: {escape(note)}", highlight=False)
    console.print(f"Files: {escape(str(target))}", soft_wrap=True, highlight=False)


def _why(found: Compensation, row: int) -> str:
    reached = Reached(found.reached[row])
    hit = f" ({', '.join(found.limits_hit(row))})" if reached is Reached.AT_A_LIMIT else ""
    distance, angle = found.missing[row]
    return f"{reached.words}{escape(hit)}; the nearest is {in_millimetres(distance)} and {1e3 * angle:.3g} mrad off."
