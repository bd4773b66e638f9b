"""A few rows that stand for many: what a search needs to begin with, and questions that more rows do not answer better.

Rows are often taken in cycles, of targets, of configurations, of repeats. So each aim gives its share, spread over the
file, and one row is drawn from each of equal stretches of it rather than every so manieth taken.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Int

from boresight.sensing import Readings

FEW = 10_000
"""Rows that stand for more: they decide 25 parameters to a hundredth of the error of one reading."""

FEWEST = 200
"""Rows that every aim keeps, or all where it has no more."""


def thinned(readings: Readings, few: int = FEW, fewest: int = FEWEST) -> Int[np.ndarray, "some"]:
    """Returns about so many rows, in their order and the same ones every time; all where there are not many.

    Args:
        readings: all rows.
        few: how many; where they are more than twice as many, they are thinned.
        fewest: rows that every aim keeps, or all where it has no more.
    """
    count = len(readings)
    if count <= 2 * few:
        return np.arange(count)
    random = np.random.Generator(np.random.Philox(0))
    chosen = []
    for aim in np.unique(readings.target):
        rows = np.flatnonzero(readings.target == aim)
        ends = np.linspace(0, len(rows), min(max(few * len(rows) // count, fewest), len(rows)) + 1).astype(int)
        chosen.append(rows[random.integers(ends[:-1], ends[1:])])
    return np.sort(np.concatenate(chosen))
