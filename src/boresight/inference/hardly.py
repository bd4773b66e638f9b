"""Directions that are seen, but so faintly that the prior still speaks louder."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.inference.identifiability import UNSEEN, Identifiability
from boresight.inference.posterior import SHRUNK
from boresight.inference.symmetries import LEADING
from boresight.inference.words import listed
from boresight.units import Quantity

_SHOWN: dict[Quantity, tuple[float, str]] = {"length": (1e3, " mm"), "angle": (1e3, " mrad"), "number": (1e3, "e-3")}


@dataclass(frozen=True, slots=True)
class HardlySeen:
    """A combination of parameters of which the data take less than nine tenths of the prior variance.

    Attributes:
        parameters: those with a part worth naming, the largest first.
        kept: share of the prior variance that the data leave.
        amplification: how far [m, rad or 1] readings wrong by one standard deviation in all move the first one.
        words: one sentence without its full stop.
        mend: one sentence without its full stop.
    """

    parameters: tuple[str, ...]
    kept: float
    amplification: float
    words: str
    mend: str


def hardly_seen(
    found: Identifiability,
    jacobian: Float[np.ndarray, "residuals parameters"],
    scale: Float[np.ndarray, "parameters"],
    quantities: tuple[Quantity, ...],
) -> tuple[HardlySeen, ...]:
    """Returns the faint directions, the faintest first.

    Args:
        found: what the data see.
        jacobian: derivative of the readings, each divided by its standard deviation.
        scale: prior standard deviation, or a typical size, of each parameter.
        quantities: what each parameter measures.
    """
    if not found.rank:
        return ()
    _, sizes, directions = np.linalg.svd(np.linalg.qr(jacobian * scale, mode="r"))
    faint = [k for k in range(min(found.rank, len(sizes))) if 1.0 / (1.0 + sizes[k] ** 2) > SHRUNK]
    faint = [k for k in faint if sizes[k] > UNSEEN * sizes[0]]
    return tuple(_said(found.names, sizes[k], directions[k], scale, quantities) for k in reversed(faint))


def _said(
    names: tuple[str, ...],
    size: float,
    direction: Float[np.ndarray, "parameters"],
    scale: Float[np.ndarray, "parameters"],
    quantities: tuple[Quantity, ...],
) -> HardlySeen:
    parts = np.abs(direction)
    # Faint directions have tails; a part below a quarter of the largest would not help anyone to see why.
    places = sorted(np.flatnonzero(parts > max(LEADING, 0.25) * parts.max()), key=lambda i: -parts[i])
    named = tuple(names[i] for i in places)
    kept = float(1.0 / (1.0 + size**2))
    moved = float(parts[places[0]] * scale[places[0]] / size)
    factor, unit = _SHOWN[quantities[places[0]]]
    verb = "is hardly seen" if len(named) == 1 else "together are hardly seen"
    words = (
        f"{listed(named, 5)} {verb}: noise of one standard deviation "
        f"moves {named[0]} by {moved * factor:.3g}{unit}, and {kept:.0%} of the prior variance is left"
    )
    times = (1.0 / SHRUNK - 1.0) / size**2
    more = f"about {times:.2g} times as many readings" if times < 100 else "other configurations or another plane"
    verb = "tell" if times < 100 else "would be needed to tell"
    return HardlySeen(named, kept, moved, words, f"{more} {verb} them from their priors; or fix one of them")
