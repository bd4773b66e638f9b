"""The unknown frames of a cell, or a refusal where the readings fit two places alike."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from boresight.calibration.placement.by_evolution import placed_by_evolution
from boresight.calibration.placement.comparison import unexplained
from boresight.calibration.placement.equations import Equations, equations_of
from boresight.calibration.placement.gauge import is_near, nearest_to, same_but_for_the_base
from boresight.calibration.placement.placements import Placements, Unknowns
from boresight.calibration.placement.search import TRIALS, search
from boresight.calibration.placement.settling import settled
from boresight.calibration.placement.telling_apart import alike_in_words, mirrored_in_words
from boresight.calibration.placement.touched_points import (
    only_touched,
    placed_by_contacts,
    rows_at,
    unknown_points,
)
from boresight.calibration.slips import slips
from boresight.calibration.thinning import thinned
from boresight.errors import InputError
from boresight.geometry import Frame
from boresight.inference import listed
from boresight.sensing import Cell, Readings
from boresight.sensing.cell import MOUNT

SEARCHED, JUDGED, FEWEST = 100, 200, 12
"""Values that the search looks at and that placements are compared by, and rows that each aim keeps. More would not
make frames plainer."""

NEAR, COMPARED = 4.0, 6
"""Placements that leave up to so many times what the best leaves are compared with the geometry free, and how many."""

ALIKE = 1.3
"""Two placements explain the readings alike where one leaves no more than this many times what the other does."""

BAD, BETTER = 50.0, 0.1
"""A placement that leaves more than this many times the stated noise with the geometry free is not believed before
slips are tried; one explains the readings where what is left falls to this share."""

TRIALS_OF_SLIPS = 300


@dataclass(frozen=True)
class Placed:
    """Where the unknown frames are.

    Attributes:
        cell: with its frames there, geometry nominal.
        warnings: what the readings cannot tell about it, a sentence each.
    """

    cell: Cell
    warnings: tuple[str, ...] = ()


def find_frames(
    cell: Cell,
    readings: Readings,
    unknown: frozenset[str],
    seed: int,
    stated_std: Mapping[str, float] = MappingProxyType({}),
) -> Placed:
    """Returns the cell with its unknown frames where the readings put them, geometry nominal.

    Args:
        cell: the nominal cell, unknown numbers at neutral values.
        readings: measured values; of many, some stand for all (`thinning`), since nominal geometry is off by more
            than the rest could add.
        unknown: the unknown parameters of the base, mounts and points, and unknown offsets.
        seed: of the evolution, where one is needed.
        stated_std: by parameter, standard deviations [m or rad] of frames that are roughly known: placements that are
            farther from where the cell has them than these allow are not considered.

    Raises:
        InputError: no frames explain the readings at all, or two placements explain them alike.
    """
    names = tuple(name for name in cell.index if name in unknown)
    if not names:
        return Placed(cell)
    readings = readings.chosen(thinned(readings))
    if set(names) <= set(cell.offsets):  # they add to readings: a straight line leads there from anywhere
        return Placed(settled(cell, readings, names)[0])
    points = unknown_points(cell, names)
    if points and only_touched(cell, readings, points):
        return _placed_by_contacts(cell, readings, names, points, seed, stated_std)
    placed = _placed_by_equations(cell, readings, names, stated_std)
    if placed is None:
        placed = Placed(placed_by_evolution(cell, readings, names, seed))
    if np.isnan(placed.cell.errors(readings)[readings.read]).mean() > 0.5:
        raise InputError(
            f"no placement of {listed(names)} explains the readings: with the best one found, most beams look away "
            "from their planes; check the joint columns, their units and the planes"
        )
    return placed


def _placed_by_contacts(
    cell: Cell,
    readings: Readings,
    names: tuple[str, ...],
    points: tuple[str, ...],
    seed: int,
    stated_std: Mapping[str, float],
) -> Placed:
    """Returns the placement where unknown points are touched: frames by all other rows, then points by contacts.

    Raises:
        InputError: the base is unknown too, and all rows are contacts of unknown points.
    """
    frames = [name for name in names if name.rpartition(".")[0] not in points]
    others = np.flatnonzero(~rows_at(cell, readings, points))
    warnings: tuple[str, ...] = ()
    if len(others) and frames:
        found = find_frames(cell, readings.chosen(others), frozenset(frames), seed, stated_std)
        cell, warnings, frames = found.cell, found.warnings, []
    if any(name.startswith("base.") for name in frames):
        raise InputError(
            f"`base` and the points {listed(points)} are unknown, and every reading is a contact of these points: "
            "nothing ties the base to the world; leave `base` out, which then is the world, or state the positions of "
            "three points"
        )
    mounts = tuple(name for name in cell.mounts if f"{name}.x" in frames)
    return Placed(settled(placed_by_contacts(cell, readings, points, mounts), readings, names)[0], warnings)


@dataclass(frozen=True)
class _Candidate:
    """A placement, and what the readings leave there, over the stated noise, with the geometry free."""

    cell: Cell
    ratio: float


def _placed_by_equations(
    cell: Cell, readings: Readings, names: tuple[str, ...], stated_std: Mapping[str, float]
) -> Placed | None:
    """Returns the placement that the readings' equations lead to; None where they have none."""
    equations = equations_of(cell, _few(readings, SEARCHED)) if _are_frames(cell, names) else None
    if equations is None:
        return None
    candidates = _candidates(cell, readings, names, equations, TRIALS)
    candidates = [each for each in candidates if is_near(each.cell, cell, stated_std)] or candidates
    best = candidates[0]
    if best.ratio > BAD:
        _refuse_slips(cell, readings, names, best)
    alike = [each.cell for each in candidates if each.ratio <= ALIKE * best.ratio]
    if len(alike) == 1:
        return Placed(settled(best.cell, readings, names)[0])
    if not same_but_for_the_base(alike):
        raise InputError(alike_in_words(alike, names, (best.ratio, candidates[1].ratio)))
    chosen, *others = nearest_to(cell.base, alike)
    return Placed(settled(chosen, readings, names)[0], (mirrored_in_words(chosen, others),))


def _candidates(
    cell: Cell, readings: Readings, names: tuple[str, ...], equations: Equations, trials: int
) -> list[_Candidate]:
    """Returns the placements worth comparing, the best first."""
    at, left = search(equations, _neutral(cell), _sought(cell, names), trials)
    near = [k for k in range(min(len(at), COMPARED)) if left[k] <= NEAR * left[0]]
    few = _few(readings, JUDGED)
    found = [_placed(cell, at, trial) for trial in near]
    return sorted((_Candidate(each, unexplained(each, few, names)) for each in found), key=lambda each: each.ratio)


def _refuse_slips(cell: Cell, readings: Readings, names: tuple[str, ...], best: _Candidate) -> None:
    """Raises where a slip explains what the best placement does not.

    Raises:
        InputError: one does; the sentence names it.
    """
    explained = []
    for _, words, other, changed in slips(best.cell, readings):
        equations = equations_of(other, _few(changed, SEARCHED))
        assert equations is not None
        trial = replace(other, base=cell.base, mount=cell.mount)
        ratio = _candidates(trial, changed, names, equations, TRIALS_OF_SLIPS)[0].ratio
        if ratio <= BETTER * best.ratio:
            explained.append((ratio, words))
    if explained:
        ratio, words = min(explained)
        raise InputError(
            f"no placement of {listed(names)} explains the readings as they are. {words}: residuals fall from "
            f"{best.ratio:.2g}x to {ratio:.2g}x the stated noise"
        )


def _are_frames(cell: Cell, names: tuple[str, ...]) -> bool:
    """Returns whether the unknown numbers are those of frames, and of sessions, which add to readings."""
    frames = ("base", *cell.mounts)
    return all(name in cell.offsets or name.rsplit(".", 1)[0] in frames for name in names)


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
