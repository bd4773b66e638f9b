"""Unseen directions in plain words: what cannot be told, why, and what would mend it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.inference.identifiability import Identifiability
from boresight.inference.movements import Movements
from boresight.inference.reasons import group_reason, mend, opening
from boresight.inference.symmetries import KINDS, LEADING, Symmetry, symmetries_of
from boresight.units import Quantity

_SMALL_UNIT: dict[Quantity, str] = {"length": " mm", "angle": " mrad", "number": "e-3"}


@dataclass(frozen=True, slots=True)
class UnseenDirection:
    """A combination of free parameters that changes no reading.

    Attributes:
        parameters: those with a part worth naming, the largest first.
        words: one sentence without its full stop: what cannot be told, and why.
        mend: one sentence without its full stop: what would help.
        directions: how many dimensions of the null space the sentence speaks of.
    """

    parameters: tuple[str, ...]
    words: str
    mend: str
    directions: int = 1


def unseen_in_words(
    found: Identifiability, scale: Float[np.ndarray, "parameters"], moves: Movements | None = None
) -> list[UnseenDirection]:
    """Returns what cannot be seen and why, a sentence each.

    Parameters that change no reading by themselves come together in one sentence for each reason. A parameter
    whose part in a direction is below 5 % is left out, and the words say to within what.

    Args:
        found: what the data see.
        scale: the size by which each parameter was scaled.
        moves: how the parameters move sensor and targets; without it, no reason can be given.
    """
    if moves is None:
        symmetries = [Symmetry(row, "other") for row in found.unseen]
    else:
        symmetries = symmetries_of(found.unseen, scale, moves)
    said = []
    if moves is not None and moves.too_few:
        unexplained = [symmetry for symmetry in symmetries if symmetry.kind == "other"]
        symmetries = [symmetry for symmetry in symmetries if symmetry.kind != "other"]
        said += _too_few(found, unexplained, moves.values) if unexplained else []
    for kind in KINDS:
        alone = sorted((s for s in symmetries if s.kind == kind and len(_leading(s)) == 1), key=_leading)
        if alone:
            names = tuple(found.names[_leading(s)[0]] for s in alone)
            words = f"{_within(names, alone)} {'does' if len(names) == 1 else 'do'} not change any reading"
            words += group_reason(kind, names, alone, scale, moves)
            said.append(UnseenDirection(names, words, mend(kind, names, moves, alone=True), len(names)))
        for symmetry in symmetries:
            if symmetry.kind == kind and len(_leading(symmetry)) > 1:
                said.append(_together(found.names, symmetry, scale, moves))
    return said


def _too_few(found: Identifiability, symmetries: list[Symmetry], values: int) -> list[UnseenDirection]:
    """Returns one sentence for all directions that are unseen only for want of readings."""
    largest = np.max([np.abs(symmetry.direction) for symmetry in symmetries], axis=0)
    names = tuple(found.names[i] for i in np.flatnonzero(largest > LEADING))
    count = len(symmetries)
    many = "one combination" if count == 1 else f"{count} combinations"
    words = f"{many} of {listed(names)} cannot be told: there are {values} values for {len(found.names)} parameters"
    return [UnseenDirection(names, words, "take more readings, or free fewer parameters", count)]


def listed(names: tuple[str, ...] | list[str], most: int = 8) -> str:
    """Returns names as people list them: "a, b and c"."""
    shown = [*names[:most], f"{len(names) - most} more"] if len(names) > most else list(names)
    return shown[0] if len(shown) == 1 else f"{', '.join(shown[:-1])} and {shown[-1]}"


def _leading(symmetry: Symmetry) -> list[int]:
    """Returns the parameters worth naming, the largest part first; equal parts in their own order."""
    parts = np.abs(symmetry.direction)
    return sorted(np.flatnonzero(parts > LEADING * parts.max()), key=lambda i: (-round(float(parts[i]), 6), i))


def _left_out(symmetry: Symmetry) -> float:
    """Returns the largest part that is not worth naming."""
    parts = np.abs(symmetry.direction) / np.abs(symmetry.direction).max()
    return float(np.max(parts[parts <= LEADING], initial=0.0))


def _within(names: tuple[str, ...], symmetries: list[Symmetry]) -> str:
    """Returns names, each with the share it is true to within where something was left out."""
    shares = [_left_out(symmetry) for symmetry in symmetries]
    return listed([n if not s else f"{n} (to within {_percent(s)})" for n, s in zip(names, shares, strict=True)])


def _percent(share: float) -> str:
    return f"{max(np.ceil(share * 1e3) / 10.0, 0.1):g} %"


def _together(
    all_names: tuple[str, ...], symmetry: Symmetry, scale: Float[np.ndarray, "parameters"], moves: Movements | None
) -> UnseenDirection:
    places = _leading(symmetry)
    names = tuple(all_names[i] for i in places)
    apart = f"{listed(names)} cannot be told apart"
    if share := _left_out(symmetry):
        apart += f" (to within {_percent(share)})"
    reason = opening(symmetry, moves)
    if symmetry.kind == "still":
        same = "both move the sensor alike" if len(names) == 2 else "each moves the sensor as the others together do"
        words = f"{apart}: {same}, in every configuration"
    elif reason:
        words = f"{reason}: {apart}"
    else:
        words = f"{apart}: {_moving(names, (symmetry.direction * scale)[places], places, moves)} changes no reading"
    return UnseenDirection(names, words, mend(symmetry.kind, names, moves, symmetry.motion))


def _moving(
    names: tuple[str, ...], amounts: Float[np.ndarray, "named"], places: list[int], moves: Movements | None
) -> str:
    """Returns a direction as moves of its parameters: "moving a by 1 mm and b by -0.2 mrad together"."""
    units = [_SMALL_UNIT[moves.quantities[i]] if moves else "" for i in places]
    steps = [f"{n} by {a:.3g}{u}" for n, a, u in zip(names, amounts / amounts[0], units, strict=True)]
    more = f" (and {len(steps) - 4} more)" if len(steps) > 4 else ""
    return f"moving {listed(steps[:4])}{more} together"
