"""What is run for every seed: methods, numbers of configurations, and what was assumed."""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass

from boresight.reproduction.experiment import Assumptions
from boresight.reproduction.setting import CANDIDATES, CASES, THEIRS

CHOSEN = "as chosen"
AZIMUTH_FREE = "theta_1 free too"
THREE_PLANES = "three planes"
PRINTED = "errors of (23) as printed, not of the unit normal"
GRAZING = "beams as flat as 78° to the normal (60° chosen)"

ASSUMPTIONS = {
    CHOSEN: Assumptions(),
    "preset errors drawn anew for every seed": Assumptions(preset="drawn"),
    PRINTED: Assumptions(preset="printed"),
    GRAZING: Assumptions(cosine=0.2),
    "scopes of links twice as wide": Assumptions(scope=2.0),
    AZIMUTH_FREE: Assumptions(azimuth=True),
    THREE_PLANES: Assumptions(azimuth=True, walls=True),
}
"""By name."""

OPEN = tuple(name for name in ASSUMPTIONS if name not in (CHOSEN, AZIMUTH_FREE, THREE_PLANES))
"""Assumptions that the paper does not decide."""

NOMINAL = "nominal"
LEAST_SQUARES = "least squares"
MODERN = {"L-SHADE": "LSHADE", "jSO": "jSO"}
"""Modern differential evolution, by minionpy's names."""


@dataclass(frozen=True, slots=True)
class Variant:
    """One identification of a seed.

    Attributes:
        method: a strategy, `NOMINAL`, `LEAST_SQUARES`, or one of `MODERN`.
        rows: number of configurations.
        under: which assumptions.
    """

    method: str
    rows: int
    under: str = CHOSEN


def variants(modern: bool) -> tuple[Variant, ...]:
    """Returns everything that is run for a seed, with or without modern differential evolution."""
    rows = tuple(CASES.values())
    methods = (NOMINAL, *THEIRS, *CANDIDATES[1:], LEAST_SQUARES, *(MODERN if modern else ()))
    return (
        *(Variant(method, count) for method in methods for count in rows),
        *(Variant("trade-off", count) for count in (50, 200)),
        *(Variant(method, count, AZIMUTH_FREE) for method in (NOMINAL, "trade-off") for count in rows),
        *(Variant(method, count, name) for name in OPEN for method in (NOMINAL, "trade-off") for count in rows),
        *(Variant(LEAST_SQUARES, count, THREE_PLANES) for count in rows),
    )


def modern_is_installed() -> bool:
    """Returns whether minionpy can be imported."""
    return importlib.util.find_spec("minionpy") is not None
