"""Configurations at which a person would measure: the beam meets its plate, nominally and in truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.trust.cell import Cell, ranges

DRAWN, TRIES = 4000, 200
CLEARANCE = 0.05
"""Least height of the sensor over every plate [m for an arm of usual reach]."""


@dataclass(frozen=True)
class Beams:
    """Which beams are measured with.

    Attributes:
        nearest, farthest: distances [m for an arm of usual reach].
        cosine: least and largest cosine between beam and normal.
    """

    nearest: float = 0.08
    farthest: float = 2.5
    cosine: tuple[float, float] = (0.4, 1.01)


def measured(
    cells: tuple[Cell, ...], count: int, beams: Beams, random: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Returns (count, joints) configurations and (count,) planes, taken in turn, that every cell can measure.

    Raises:
        RuntimeError: the plates cannot be met: the scenario is wrong.
    """
    joints, target = [], []
    for plane in range(len(cells[0].planes)):
        wanted = len(range(plane, count, len(cells[0].planes)))
        found = _of_plane(cells, plane, wanted, beams, random)
        joints.append(found)
        target.append(np.full(wanted, plane))
    order = random.permutation(count)
    return np.concatenate(joints)[order], np.concatenate(target)[order]


def anywhere(cell: Cell, count: int, random: np.random.Generator) -> np.ndarray:
    """Returns (count, joints) configurations within the limits."""
    low, high = cell.arm.limits.T
    return random.uniform(low, high, (count, cell.arm.count))


def _of_plane(cells: tuple[Cell, ...], plane: int, count: int, beams: Beams, random: np.random.Generator) -> np.ndarray:
    found: list[np.ndarray] = []
    for _ in range(TRIES):
        joints = anywhere(cells[0], DRAWN, random)
        for cell in cells:
            joints = joints[_meets(cell, joints, plane, beams)]
        found += list(joints)
        if len(found) >= count:
            return np.array(found[:count]).reshape(count, -1)
    raise RuntimeError(f"plane {plane} is met by {len(found)} of {TRIES * DRAWN} configurations; {count} are needed")


def _meets(cell: Cell, joints: np.ndarray, plane: int, beams: Beams) -> np.ndarray:
    distance, cosine = ranges(cell, joints, np.full(len(joints), plane))
    place = cell.poses(joints)[0]
    low, high = beams.cosine
    good = (distance > beams.nearest * cell.size) & (distance < beams.farthest * cell.size)
    good &= (np.abs(cosine) > low) & (np.abs(cosine) < high)
    for each in cell.planes.values():
        good &= place @ each.normal + each.offset > CLEARANCE * cell.size
    return good
