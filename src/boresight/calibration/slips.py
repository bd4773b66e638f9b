"""Slips that no small correction mends, each made undone.

A plane whose offset has the wrong sign or is another plane's, two targets exchanged, rows that name another target, a
joint that counts the other way round, two joints exchanged, readings that stand one row too early or too late, and
those of `pose_slips`.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from boresight.calibration.pose_slips import pose_slips
from boresight.calibration.problem import MISSED_M
from boresight.geometry import Plane
from boresight.inference import listed
from boresight.sensing import Cell, Readings

FEWEST = 3
"""Rows that must fit another target than their own for that to be told."""


def slips(cell: Cell, readings: Readings) -> Iterator[tuple[str, str, Cell, Readings]]:
    """Yields each slip: its name, what to do, and cell and readings without it.

    Args:
        cell: nominal, its frames about where they are: rows are compared with every target from there.
        readings: as given.
    """
    planes = {name: target for name, target in cell.targets.items() if isinstance(target, Plane)}
    for count in range(1, len(planes) + 1):
        for names in itertools.combinations(planes, count) if len(planes) <= 4 or count in (1, len(planes)) else ():
            turned = {name: Plane.of(planes[name].normal, -planes[name].offset) for name in names}
            whose = f"`{names[0]}`" if count == 1 else listed([f"`{name}`" for name in names])
            yield (
                f"{names[0] if count == 1 else 'planes'} flipped",
                f"The offset of {whose} with the other sign explains the readings; a plane is n·p + offset = 0",
                replace(cell, targets={**cell.targets, **turned}),
                readings,
            )
    for one, other in itertools.combinations(planes, 2):
        a, b = planes[one], planes[other]
        offsets = {one: Plane.of(a.normal, b.offset), other: Plane.of(b.normal, a.offset)}
        yield (
            f"offsets of {one} and {other}",
            f"The offsets of `{one}` and `{other}` are exchanged",
            replace(cell, targets={**cell.targets, **offsets}),
            readings,
        )
    yield from _exchanged(cell, readings)
    for place, name in enumerate(cell.arm.joint_names):
        sign = np.where(np.arange(readings.joints.shape[1]) == place, -1.0, 1.0)
        since = None if readings.since is None else readings.since * sign
        yield (
            f"{name} counts backwards",
            f"Joint {name} counts the other way round than the robot's file says: negate its readings",
            cell,
            replace(readings, joints=readings.joints * sign, since=since),
        )
    names = cell.arm.joint_names
    for first, second in itertools.combinations(range(len(names)), 2):
        joints = readings.joints.copy()
        joints[:, [first, second]] = joints[:, [second, first]]
        yield (
            "joint columns",
            f"The columns of joints {names[first]} and {names[second]} are exchanged",
            cell,
            replace(readings, joints=joints),
        )
    for effect, words, changed in pose_slips(cell, readings):
        yield effect, words, cell, changed
    for shift, word in ((1, "earlier"), (-1, "later")):
        joints = np.roll(readings.joints, shift, axis=0)
        yield (
            "row order",
            f"Each reading belongs to the configuration one row {word}",
            cell,
            replace(readings, joints=joints),
        )
        if cell.targets:
            yield (
                "row order",
                f"Each reading belongs to the configuration and target one row {word}",
                cell,
                replace(readings, joints=joints, target=np.roll(readings.target, shift)),
            )


def _exchanged(cell: Cell, readings: Readings) -> Iterator[tuple[str, str, Cell, Readings]]:
    """Yields targets exchanged in all rows, and each row with the target that fits it best."""
    aims = cell.aims
    same = {
        place: [
            k for k, other in enumerate(aims) if (other.sensor, other.mount) == (aim.sensor, aim.mount) and other.target
        ]
        for place, aim in enumerate(aims)
    }
    used = [name for name in cell.targets if any(aims[k].target == name for k in np.unique(readings.target))]
    for first, second in itertools.combinations(used, 2):
        swap = {first: second, second: first}
        renamed = [
            next((k for k in same[p] if aims[k].target == swap.get(aims[p].target or "", aims[p].target)), p)
            for p in range(len(aims))
        ]
        yield (
            "targets",
            f"Targets `{first}` and `{second}` are exchanged in the rows' column target",
            cell,
            replace(readings, target=np.array(renamed)[readings.target]),
        )
    if len(used) < 2:
        return
    sizes = np.full((len(aims), len(readings)), np.inf)
    for place in range(len(aims)):
        own = np.array([place if place in same[p] else p for p in readings.target])
        errors = np.linalg.norm(cell.errors(replace(readings, target=own)), axis=1)
        sizes[place] = np.where(own == place, np.nan_to_num(errors, nan=MISSED_M), np.inf)
    given = sizes[readings.target, np.arange(len(readings))]
    best = np.argmin(sizes, axis=0)
    usual = 3.0 * float(np.median(np.min(sizes, axis=0))) + 1e-6
    wrong = (given > 3.0 * usual) & (np.min(sizes, axis=0) < usual)
    if np.count_nonzero(wrong) >= FEWEST:
        lines = [str(line) for line in readings.line[wrong]]
        plural = "s" if len(lines) > 1 else ""
        yield (
            "targets",
            f"{len(lines)} row{plural} fit another target than the one they name (line{plural} {listed(lines)})",
            cell,
            replace(readings, target=np.where(wrong, best, readings.target)),
        )
