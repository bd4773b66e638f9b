"""How much of the held-out error a calibration leaves, by the bootstrap over configurations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.calibration.gross import GROSS_RATIO, GROSS_SHARE
from boresight.calibration.holdout import HeldOut

RESAMPLES = 2000
CONFIDENCE = 0.95
GROUPS = 10_000
"""Groups that many configurations are resampled in: 2,000 times a million would take a minute for the same interval."""

FEWEST = 6
"""That n configurations all improve by luck has probability 2^-n, either way 2^(1-n): below 5 % from six on. The
bootstrap cannot say so: two that happen to improve make an interval that is certain of it."""


@dataclass(frozen=True, slots=True)
class Improvement:
    """How much of the held-out error is left.

    Attributes:
        ratio: RMS after over RMS before.
        low, high: 95 % confidence interval of the ratio, by the bootstrap over configurations.
        configurations: how many there were whose readings both models predict.
    """

    ratio: float
    low: float
    high: float
    configurations: int


def improvement(held_out: HeldOut, seed: int) -> Improvement:
    """Returns what is left of the held-out error, with its confidence interval (Efron & Tibshirani 1993).

    Args:
        held_out: error sizes before and after, row by row; rows of one configuration are resampled together.
        seed: of the resampling.
    """
    both = np.isfinite(held_out.before) & np.isfinite(held_out.after)
    before, after = held_out.before[both] ** 2, held_out.after[both] ** 2
    if not len(before):
        return Improvement(np.nan, np.nan, np.nan, 0)
    whole, random = _ratio(before, after), np.random.Generator(np.random.Philox(seed))
    if held_out.configuration is not None:
        own = np.unique(held_out.configuration[both], return_inverse=True)[1].ravel()
        before, after = np.bincount(own, before), np.bincount(own, after)
    count = len(before)
    before, after = _grouped(random, before, after)
    ratios = np.array([_ratio(before[rows], after[rows]) for rows in _resamples(random, len(before))])
    low, high = np.quantile(ratios, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    return Improvement(whole, float(low), float(high), count)


def _ratio(before: Float[np.ndarray, "rows"], after: Float[np.ndarray, "rows"]) -> float:
    return float(np.sqrt(np.sum(after) / max(float(np.sum(before)), 1e-300)))


def _grouped(
    random: np.random.Generator, before: Float[np.ndarray, "rows"], after: Float[np.ndarray, "rows"]
) -> tuple[Float[np.ndarray, "groups"], Float[np.ndarray, "groups"]]:
    """Returns the squares of many configurations summed in groups dealt at random, which vary as their own sums do."""
    if len(before) <= 2 * GROUPS:
        return before, after
    group = random.permutation(len(before)) % GROUPS
    return np.bincount(group, before), np.bincount(group, after)


def _resamples(random: np.random.Generator, count: int) -> Iterator[np.ndarray]:
    for _ in range(RESAMPLES):
        yield random.integers(0, count, count)


def held_out_grossly_off(held_out: HeldOut, reach: float) -> bool:
    """Returns whether errors on held-out rows are grossly above what is expected of them, beside an arm's reach [m]."""
    seen = np.isfinite(held_out.after)
    if held_out.expected is None or not seen.any():
        return False
    size = float(np.sqrt(np.mean(held_out.after[seen] ** 2)))
    expected = float(np.sqrt(np.mean(held_out.expected[seen])))
    return size > GROSS_RATIO * expected and size > GROSS_SHARE * reach
