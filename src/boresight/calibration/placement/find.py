"""The unknown frames of a cell, or a refusal where the readings fit two places alike."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from boresight.calibration.gross import GROSS_SHARE
from boresight.calibration.placement.by_evolution import RUNS, placed_by_evolution
from boresight.calibration.placement.candidates import candidates_of, rough_candidate
from boresight.calibration.placement.gauge import is_near, nearest_to, same_but_for_the_base
from boresight.calibration.placement.settling import settled
from boresight.calibration.placement.slipped import slip_that_explains
from boresight.calibration.placement.telling_apart import alike_in_words, mirrored_in_words
from boresight.calibration.placement.touched_points import (
    only_touched,
    placed_by_contacts,
    rows_at,
    unknown_points,
)
from boresight.calibration.thinning import thinned
from boresight.errors import InputError
from boresight.inference import listed
from boresight.sensing import Cell, Readings

ALIKE = 1.3
"""Two placements explain the readings alike where one leaves no more than this many times what the other does."""

BAD = 50.0
"""A placement that leaves more than this many times the stated noise with the geometry free is not believed before
slips are tried."""

QUICK_RUNS = 2


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
    *,
    quick: bool = False,
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
        quick: whether a short search will do, one of many: nothing is compared with the best placement it finds.

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
        return _placed_by_contacts(cell, readings, names, points, seed, stated_std, quick)
    placed = (
        _placed_quickly(cell, readings, names, stated_std)
        if quick
        else _placed_by_equations(cell, readings, names, stated_std)
    )
    if placed is None:
        placed = Placed(placed_by_evolution(cell, readings, names, seed, QUICK_RUNS if quick else RUNS))
    if np.isnan(placed.cell.errors(readings)[readings.read]).mean() > 0.5:
        raise InputError(
            f"no placement of {_frames(names)} explains the readings: with the best one found, most beams look away "
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
    quick: bool,
) -> Placed:
    """Returns the placement where unknown points are touched: frames by all other rows, then points by contacts.

    Raises:
        InputError: the base is unknown too, and all rows are contacts of unknown points.
    """
    frames = [name for name in names if name.rpartition(".")[0] not in points]
    others = np.flatnonzero(~rows_at(cell, readings, points))
    warnings: tuple[str, ...] = ()
    if len(others) and frames:
        found = find_frames(cell, readings.chosen(others), frozenset(frames), seed, stated_std, quick=quick)
        cell, warnings, frames = found.cell, found.warnings, []
    if any(name.startswith("base.") for name in frames):
        raise InputError(
            f"`base` and the points {listed(points)} are unknown, and every reading is a contact of these points: "
            "nothing ties the base to the world; leave `base` out, which then is the world, or state the positions of "
            "three points"
        )
    mounts = tuple(name for name in cell.mounts if f"{name}.x" in frames)
    return Placed(settled(placed_by_contacts(cell, readings, points, mounts), readings, names)[0], warnings)


def _placed_by_equations(
    cell: Cell, readings: Readings, names: tuple[str, ...], stated_std: Mapping[str, float]
) -> Placed | None:
    """Returns the placement that the readings' equations lead to; None where they have none."""
    candidates = candidates_of(cell, readings, names)
    if candidates is None:
        return None
    candidates = [each for each in candidates if is_near(each.cell, cell, stated_std)] or candidates
    best = candidates[0]
    if best.ratio > BAD and (slip := slip_that_explains(cell, readings, names, best, stated_std)) is not None:
        raise InputError(
            f"no placement of {_frames(names)} explains the readings as they are. {slip[0]}: residuals fall from "
            f"{best.ratio:.2g}x to {slip[1]:.2g}x the stated noise"
        )
    alike = [each.cell for each in candidates if each.ratio <= ALIKE * best.ratio]
    if len(alike) == 1:
        return Placed(settled(best.cell, readings, names)[0])
    if not same_but_for_the_base(alike):
        if best.ratio > BAD and best.ratio * readings.usual_std > GROSS_SHARE * cell.arm.reach:
            raise InputError(
                f"no placement of {_frames(names)} explains the readings: the best one leaves residuals of "
                f"{best.ratio:.2g}x the stated noise with the geometry free; check the joint columns, their units and "
                "signs, and which target each row names"
            )
        raise InputError(alike_in_words(alike, names, (best.ratio, candidates[1].ratio)))
    chosen, *others = nearest_to(cell.base, alike)
    return Placed(settled(chosen, readings, names)[0], (mirrored_in_words(chosen, others),))


def _placed_quickly(
    cell: Cell, readings: Readings, names: tuple[str, ...], stated_std: Mapping[str, float]
) -> Placed | None:
    found = rough_candidate(cell, readings, names, stated_std)
    return None if found is None else Placed(settled(found[0], readings, names)[0])


def _frames(names: tuple[str, ...]) -> str:
    return listed(list(dict.fromkeys(f"`{name.rpartition('.')[0] or name}`" for name in names)))
