"""The mean of what a sensor read while an arm stood still, and how certain it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

OUTLYING = 6.0
"""Readings this many robust standard deviations from their phase's median are no part of its mean."""

_FEW = 5
"""Of fewer readings nobody can say which is the wrong one."""

_MOST_FREEDOM = 1000.0
"""Phases whose scatters differ no more than chance would have it share one scatter, as good as known."""

_PARTS = 4
"""A phase is divided into so many parts to see whether neighbouring readings are alike."""


@dataclass(frozen=True)
class Averages:
    """Means of phases.

    Attributes:
        means: (phases, channels) [m].
        std: (phases, channels) standard deviation of each mean [m].
        scatter: (channels,) standard deviation of one reading in the median phase [m].
        likeness: factor by which likeness of neighbouring readings widens `std`: 1 where noise is white.
    """

    means: Float[np.ndarray, "phases channels"]
    std: Float[np.ndarray, "phases channels"]
    scatter: Float[np.ndarray, " channels"]
    likeness: float


def usual(
    phases: Sequence[Float[np.ndarray, "readings channels"]], quantum: Float[np.ndarray, " channels"]
) -> list[Bool[np.ndarray, " readings"]]:
    """Returns which readings of each phase are not gross errors.

    A phase's own spread counts where it is larger than that of the median phase: of ten readings, the spread alone
    is so uncertain that it would cast out good ones.

    Args:
        phases: the readings of each [m], at least one.
        quantum: the sensor's smallest step [m], below which no spread is believed.
    """
    off = [np.abs(values - np.median(values, axis=0)) for values in phases]
    spread = 1.4826 * np.stack([np.median(each, axis=0) for each in off])
    scale = np.maximum(np.maximum(spread, np.median(spread, axis=0)), quantum)
    return [(each <= OUTLYING * s).all(axis=1) | (len(each) < _FEW) for each, s in zip(off, scale, strict=True)]


def step_of(values: Float[np.ndarray, "readings channels"]) -> Float[np.ndarray, " channels"]:
    """Returns the smallest step between any two readings of each channel: what the sensor rounds to, or less."""
    steps = []
    for channel in values.T:
        between = np.diff(np.unique(channel))
        steps.append(float(between.min()) if len(between) else 0.0)
    return np.array(steps)


def averages(
    phases: Sequence[Float[np.ndarray, "readings channels"]], quantum: Float[np.ndarray, " channels"]
) -> Averages:
    """Returns the means of phases, at least one of one reading each, and how certain they are.

    The variance of a mean is s²/n, with s² the phase's own variance drawn towards the median phase's as far as
    phases are alike, times how much more the means of a phase's quarters differ than white noise would have them
    (over all phases together, at least 1), plus what rounding does that noise does not average out:
    q²/12 exp(-(2 pi s / q)²) of a step q (Widrow & Kollár 2008).

    Args:
        phases: the readings of each [m].
        quantum: the sensor's step [m].
    """
    count = np.array([len(values) for values in phases], dtype=float)[:, None]
    means = np.stack([values.mean(axis=0) for values in phases])
    freedom = np.maximum(count - 1.0, 0.0)
    own = np.stack([np.var(v, axis=0, ddof=1) if len(v) > 1 else np.zeros(v.shape[1]) for v in phases])
    several = freedom[:, 0] > 0
    # The median of a chi-square of f degrees of freedom is f (1 - 2/9f)³ (Wilson & Hilferty 1931).
    middle = (1.0 - 2.0 / (9.0 * float(np.median(freedom[several])))) ** 3 if several.any() else 1.0
    common = np.median(own[several], axis=0) / middle if several.any() else np.zeros(means.shape[1])
    prior = _common_freedom(own, freedom)
    variance = (freedom * own + prior * common) / (freedom + prior)
    likeness = max(1.0, _likeness(phases))
    step = np.where(quantum > 0.0, quantum, 1.0)
    rounding = np.where(quantum > 0.0, quantum**2 / 12.0 * np.exp(-((2.0 * np.pi) ** 2) * variance / step**2), 0.0)
    return Averages(means, np.sqrt(likeness * variance / count + rounding), np.sqrt(common), np.sqrt(likeness))


def _common_freedom(
    own: Float[np.ndarray, "phases channels"], freedom: Float[np.ndarray, "phases 1"]
) -> Float[np.ndarray, " channels"]:
    """Returns how many degrees of freedom the scatter of all phases is worth to one of them.

    The standard deviation of ten readings is uncertain by a quarter, and rows weighted by such numbers lose what
    weights should gain. The logarithms of the phases' variances scatter by trigamma(f / 2) if all are one, and what
    they scatter beyond that tells how much phases differ (empirical Bayes: Smyth 2004, eq. 8).
    """
    found = np.full(own.shape[1], _MOST_FREEDOM)
    for channel, variances in enumerate(own.T):
        known = variances > 0.0
        if known.sum() > 2:
            beyond = np.var(np.log(variances[known]), ddof=1) - np.mean(_trigamma(freedom[known, 0] / 2.0))
            # x of 1/x + 1/2x² = beyond, the first two terms of trigamma
            half = (1.0 + np.sqrt(1.0 + 2.0 * beyond)) / (2.0 * beyond) if beyond > 0.0 else np.inf
            found[channel] = min(_MOST_FREEDOM, 2.0 * half)
    return found


def _trigamma(x: Float[np.ndarray, " phases"]) -> Float[np.ndarray, " phases"]:
    """Returns trigamma by its asymptotic series, within 3 % from x = 1 on and 8 % at x = 1/2."""
    return 1.0 / x + 1.0 / (2.0 * x**2) + 1.0 / (6.0 * x**3)


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
