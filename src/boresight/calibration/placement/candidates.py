"""The placements that readings allow, compared with the geometry free."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from boresight.calibration.placement.comparison import unexplained
from boresight.calibration.placement.equations import Equations, equations_of
from boresight.calibration.placement.gauge import is_near
from boresight.calibration.placement.placements import Placements, Unknowns
from boresight.calibration.placement.search import TRIALS, search
from boresight.calibration.thinning import thinned
from boresight.geometry import Frame
from boresight.sensing import Cell, Readings
from boresight.sensing.cell import MOUNT

SEARCHED, JUDGED, FEWEST = 100, 200, 12
"""Values that the search looks at and that placements are compared by, and rows that each aim keeps. More would not
make frames plainer."""

NEAR, COMPARED = 4.0, 6
"""Placements that leave up to so many times what the best leaves are compared with the geometry free, and how many."""

FEW_TRIALS = 300
"""Starts of a search that is one of many."""


@dataclass(frozen=True)
class Candidate:
    """A placement, and what the readings leave there, over the stated noise, with the geometry free."""

    cell: Cell
    ratio: float


def candidates_of(cell: Cell, readings: Readings, names: tuple[str, ...]) -> list[Candidate] | None:
    """Returns the placements worth comparing, the best first; None where the readings have no equations.

    Args:
        cell: nominal, its unknown numbers at neutral values.
        readings: measured values.
        names: the unknown parameters.
    """
    found = _searched(cell, readings, names, TRIALS)
    if found is None:
        return None
    cells, left = found
    near = [each for each, size in zip(cells[:COMPARED], left, strict=False) if size <= NEAR * left[0]]
    return compared(near, readings, names)


def compared(cells: list[Cell], readings: Readings, names: tuple[str, ...]) -> list[Candidate]:
    """Returns placements, the one that leaves least with the geometry free first."""
    few = _few(readings, JUDGED)
    return sorted((Candidate(each, unexplained(each, few, names)) for each in cells), key=lambda each: each.ratio)


def rough_candidate(
    cell: Cell, readings: Readings, names: tuple[str, ...], stated_std: Mapping[str, float]
) -> tuple[Cell, float] | None:
    """Returns the placement that a short search finds, and what it typically leaves with nominal geometry [m].

    Args:
        cell: nominal, its unknown numbers at neutral values.
        readings: measured values.
        names: the unknown parameters.
        stated_std: of frames that are roughly known, as `find_frames` has it.
    """
    found = _searched(cell, readings, names, FEW_TRIALS)
    if found is None:
        return None
    both = list(zip(*found, strict=True))
    return next((each for each in both if is_near(each[0], cell, stated_std)), both[0])


def _searched(
    cell: Cell, readings: Readings, names: tuple[str, ...], trials: int
) -> tuple[list[Cell], list[float]] | None:
    equations = _equations(cell, readings, names)
    if equations is None:
        return None
    at, left = search(equations, _neutral(cell), _sought(cell, names), trials)
    return [_placed(cell, at, trial) for trial in range(len(at))], left.tolist()


def _equations(cell: Cell, readings: Readings, names: tuple[str, ...]) -> Equations | None:
    """Returns the readings' equations where the unknown numbers are those of frames, and of offsets by session."""
    frames = ("base", *cell.mounts)
    if not all(name in cell.offsets or name.rsplit(".", 1)[0] in frames for name in names):
        return None
    return equations_of(cell, _few(readings, SEARCHED))


def _neutral(cell: Cell) -> Placements:
    base, mounts = cell.base.matrix, np.array([frame.matrix for frame in cell.mounts.values()])
    return Placements(base[None, :3, :3], base[None, :3, 3], mounts[None, :, :3, :3], mounts[None, :, :3, 3])


def _sought(cell: Cell, names: tuple[str, ...]) -> Unknowns:
    of = [(f"{frame}.roll" in names, f"{frame}.x" in names) for frame in ("base", *cell.mounts)]
    return Unknowns(of[0], tuple(of[1:]))


def _placed(cell: Cell, at: Placements, trial: int) -> Cell:
    """Returns the cell with base and mounts as in a trial."""

    def frame(turn: np.ndarray, shift: np.ndarray) -> Frame:
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = turn, shift
        return Frame.of(T)

    mounts = {name: frame(at.mount_turn[trial, k], at.mount_shift[trial, k]) for k, name in enumerate(cell.mounts)}
    return replace(
        cell,
        base=frame(at.base_turn[trial], at.base_shift[trial]),
        mount=mounts if isinstance(cell.mount, Mapping) else mounts[MOUNT],
    )


def _few(readings: Readings, values: int) -> Readings:
    """Returns a few of the readings that hold about so many values."""
    per_row = float(np.mean(readings.channels)) if len(readings) else 1.0
    return readings.chosen(thinned(readings, max(int(values / max(per_row, 1.0)), 1), FEWEST))
