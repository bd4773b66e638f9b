"""Points that nobody has measured and a tip touches: with the base known they enter the readings linearly.

With the flange at (R, p) in the world, a tip at t on it and the point at c, each contact says R t + p = c. So the
points, and the tip where it is unknown too, as when the arm pivots about its tool's point, follow from linear least
squares.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Bool

from boresight.calibration.placement.flanges import flanges
from boresight.geometry import Frame, Point, triple_of
from boresight.sensing import Cell, PointContact, Readings
from boresight.sensing.cell import MOUNT


def unknown_points(cell: Cell, names: tuple[str, ...]) -> tuple[str, ...]:
    """Returns the points among the owners of unknown numbers."""
    owners = dict.fromkeys(name.rpartition(".")[0] for name in names)
    return tuple(name for name in owners if isinstance(cell.targets.get(name), Point))


def rows_at(cell: Cell, readings: Readings, points: tuple[str, ...]) -> Bool[np.ndarray, " rows"]:
    """Returns which rows are taken at any of some points."""
    return np.array([aim.target in points for aim in cell.aims], dtype=bool)[readings.target]


def only_touched(cell: Cell, readings: Readings, points: tuple[str, ...]) -> bool:
    """Returns whether every row at some points is a contact."""
    aims = {int(place) for place in readings.target[rows_at(cell, readings, points)]}
    return all(isinstance(cell.sensors[cell.aims[place].sensor], PointContact) for place in aims)


def placed_by_contacts(cell: Cell, readings: Readings, points: tuple[str, ...], mounts: tuple[str, ...]) -> Cell:
    """Returns the cell with points, and the origins of mounts, where contacts put them; the base as it stands.

    Args:
        cell: geometry nominal.
        readings: contacts of the points; others do not count.
        points: the unknown ones.
        mounts: those whose origin is unknown.
    """
    some = readings.chosen(np.flatnonzero(rows_at(cell, readings, points)))
    flange = flanges(cell, some)
    columns = {name: 3 * place for place, name in enumerate((*points, *mounts))}
    A, b = np.zeros((len(some), 3, 3 * len(columns))), np.array(flange[:, :3, 3])
    for row, place in enumerate(some.target):
        aim = cell.aims[place]
        A[row, :, columns[aim.target or ""] :][:, :3] = np.eye(3)
        if aim.mount in mounts:
            A[row, :, columns[aim.mount] :][:, :3] = -flange[row, :3, :3]
        else:
            b[row] += flange[row, :3, :3] @ cell.mounts[aim.mount].xyz
    found = np.linalg.lstsq(A.reshape(-1, A.shape[2]), b.ravel(), rcond=1e-6)[0].reshape(-1, 3)
    at = {name: triple_of(found[place // 3]) for name, place in columns.items()}
    moved = {name: Frame(at[name], frame.rpy) if name in mounts else frame for name, frame in cell.mounts.items()}
    return replace(
        cell,
        targets={name: Point(at[name]) if name in points else target for name, target in cell.targets.items()},
        mount=moved if isinstance(cell.mount, Mapping) else moved[MOUNT],
    )
