"""The mean of what a sensor read while an arm stood still, and how certain it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

OUTLYING = 6.0
"""Readings this many robust standard deviations from their phase's median are no part of its mean."""

_PRIOR_FREEDOM = 8.0
"""A phase's own scatter counts as this many readings less than all it would: with ten readings a standard deviation
is uncertain by a quarter, and weighting rows by such noise loses accuracy; drawn to the scatter of all phases it
does not."""

_PARTS = 4
"""A phase is divided into so many parts to see whether neighbouring readings are alike."""


@dataclass(frozen=True)
class Averages:
    """Means of phases.

    Attributes:
        means: (phases, channels) [m].
        std: (phases, channels) standard deviation of each mean [m].
        scatter: (channels,) median standard deviation of one reading [m].
        likeness: factor by which likeness of neighbouring readings widens `std`: 1 where noise is white.
    """

    means: Float[np.ndarray, "phases channels"]
    std: Float[np.ndarray, "phases channels"]
    scatter: Float[np.ndarray, " channels"]
    likeness: float


def usual(values: Float[np.ndarray, "readings channels"], quantum: Float[np.ndarray, " channels"]) -> Bool[np.ndarray, " readings"]:
    """Returns which readings of a phase are not gross errors.

    Args:
        values: of the phase.
        quantum: the sensor's smallest step, below which no scatter is believed.
    """
    off = np.abs(values - np.median(values, axis=0))
    scale = np.maximum(1.4826 * np.median(off, axis=0), quantum)
    return np.asarray((off <= OUTLYING * scale).all(axis=1) | (len(values) < 5))


def step_of(values: Float[np.ndarray, "readings channels"]) -> Float[np.ndarray, " channels"]:
    """Returns the smallest step between any two readings of each channel: what the sensor rounds to, or less."""
    steps = []
    for channel in values.T:
        between = np.diff(np.unique(channel))
        steps.append(float(between.min()) if len(between) else 0.0)
    return np.array(steps)


def averages(phases: Sequence[Float[np.ndarray, "readings channels"]], quantum: Float[np.ndarray, " channels"]) -> Averages:
    """Returns the means of phases, at least one of one reading each, and how certain they are.

    The variance of a mean is s²/n, with s² the phase's own variance drawn towards the median phase's, times how much
    more the means of a phase's quarters differ than white noise would have them (over all phases together, at
    least 1), plus what rounding does that noise does not average out: q²/12 exp(-(2 pi s / q)²) of a step q
    (Widrow & Kollár 2008).

    Args:
        phases: the readings of each [m].
        quantum: the sensor's step [m].
    """
    count = np.array([len(values) for values in phases], dtype=float)[:, None]
    means = np.stack([values.mean(axis=0) for values in phases])
    freedom = np.maximum(count - 1.0, 0.0)
    own = np.stack([np.var(v, axis=0, ddof=1) if len(v) > 1 else np.zeros(v.shape[1]) for v in phases])
    several = freedom[:, 0] > 0
    common = np.median(own[several], axis=0) if several.any() else np.zeros(means.shape[1])
    variance = (freedom * own + _PRIOR_FREEDOM * common) / (freedom + _PRIOR_FREEDOM)
    likeness = max(1.0, _likeness(phases))
    step = np.where(quantum > 0.0, quantum, 1.0)
    rounding = np.where(quantum > 0.0, quantum**2 / 12.0 * np.exp(-((2.0 * np.pi) ** 2) * variance / step**2), 0.0)
    return Averages(means, np.sqrt(likeness * variance / count + rounding), np.sqrt(common), np.sqrt(likeness))


def _likeness(phases: Sequence[Float[np.ndarray, "readings channels"]]) -> float:
    """Returns the variance of the means of a phase's parts over what white noise gives; 1 where nothing tells."""
    found = expected = 0.0
    for values in phases:
        size = len(values) // _PARTS
        if size < 2:
            continue
        means = values[: size * _PARTS].reshape(_PARTS, size, -1).mean(axis=1)
        scale = np.var(values, axis=0, ddof=1)
        known = scale > 0.0
        # Each phase counts alike, whatever its scatter.
        found += float(np.sum(np.var(means, axis=0, ddof=1)[known] / scale[known]))
        expected += np.count_nonzero(known) / size
    return found / expected if expected > 0.0 else 1.0
