"""A number over many seeds: its median, and the range of nine seeds in ten."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

SMALLEST = 1e-6
"""Numbers below are shown as nought: their units are chosen so that none means anything there."""


@dataclass(frozen=True, slots=True)
class Spread:
    """Median and range over seeds.

    Attributes:
        median: of all seeds.
        low: the 5 % quantile.
        high: the 95 % quantile.
    """

    median: float
    low: float
    high: float

    @classmethod
    def of(cls, values: Sequence[float] | Float[np.ndarray, "seeds"]) -> Spread:
        """Returns the spread of one number a seed."""
        low, median, high = np.quantile(np.asarray(values, dtype=float), (0.05, 0.5, 0.95))
        return cls(float(median), float(low), float(high))

    def text(self, digits: int = 3, unit: str = "") -> str:
        """Returns `median unit (low to high)`."""
        median = f"{plain(self.median, digits)} {unit}".rstrip()
        return f"{median} ({plain(self.low, digits)} to {plain(self.high, digits)})"


def plain(value: float, digits: int = 3) -> str:
    """Returns a number with some digits that matter, a real minus sign, and never an exponent."""
    if not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    if abs(value) < SMALLEST:
        return "≈ 0"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value)) + 1e-12))
    text = f"{value:,.{min(decimals, 9)}f}"
    return text.replace("-", "−")


def percent(share: float) -> str:
    """Returns a share in per cent; only all is 100 %, only none is 0 %."""
    if share in (0.0, 1.0):
        return f"{100 * share:.0f} %"
    return f"{min(max(100 * share, 0.1), 99.9):.{0 if 0.01 <= share <= 0.99 else 1}f} %"
