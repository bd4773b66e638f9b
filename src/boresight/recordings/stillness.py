"""When an arm stood still."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from boresight.recordings.rules import Rules
from boresight.recordings.signal import Signal
from boresight.recordings.trajectory import Trajectory

WINDOW = 0.1
"""Speed is the difference of the means over this long [s] before and after a sample."""

_NOISE_FACTOR = 6.0
"""Noise alone looks this many standard deviations fast once in a billion samples."""

_QUIETEST = 25.0
"""Percentile of the stretches of a signal whose scatter is taken for its noise: most of the others may be in motion."""

_QUIET_SHARE = 0.75
"""Of pure noise, that percentile is this much of the standard deviation, by simulation."""


def still_phases(trajectory: Trajectory, rules: Rules) -> Float[np.ndarray, "phases 2"]:
    """Returns from when to when [s] no joint moved, trimmed and long enough, in order.

    Args:
        trajectory: of all joints.
        rules: what counts as still.
    """
    start, end = trajectory.span
    phases = np.array([[start, end]]) if start < end else np.empty((0, 2))
    for signal, gap in zip(trajectory.signals, trajectory.longest_gap, strict=True):
        phases = _overlaps(phases, _still(signal, gap, rules.still_speed))
    phases = phases + np.array([rules.settle, -WINDOW])
    return phases[phases[:, 1] - phases[:, 0] >= rules.still_time]


def speeds(signal: Signal) -> tuple[Float[np.ndarray, " samples"], Float[np.ndarray, " samples"]]:
    """Returns the speed at each sample of a joint [1/s], and the standard deviation that its noise gives it.

    Means of `WINDOW` before and after a sample are compared, of at least two samples each.
    """
    time, values = signal.time, signal.values[:, 0] - signal.values[:, 0].mean()
    time = time - time[0]
    here, count = np.arange(len(time)), len(time)
    first = np.minimum(np.searchsorted(time, time - WINDOW), np.maximum(here - 1, 0))
    last = np.maximum(np.searchsorted(time, time + WINDOW, side="right"), np.minimum(here + 2, count))
    before, after = here - first + 1, last - here
    sums_t, sums_v = (np.concatenate([[0.0], np.cumsum(x)]) for x in (time, values))
    t_before, v_before = ((s[here + 1] - s[first]) / before for s in (sums_t, sums_v))
    t_after, v_after = ((s[last] - s[here]) / after for s in (sums_t, sums_v))
    apart = np.maximum(t_after - t_before, 1e-6)
    return (v_after - v_before) / apart, _noise(values) * np.sqrt(1.0 / before + 1.0 / after) / apart


def _noise(values: Float[np.ndarray, " samples"]) -> float:
    """Returns the standard deviation of a joint's samples about its motion.

    Second differences take out steady motion and have six times the variance of the samples; the quietest
    stretches of ten are those without acceleration.
    """
    if len(values) < 12:
        return 0.0
    second = np.diff(values, 2)
    stretches = second[: len(second) // 10 * 10].reshape(-1, 10)
    return float(np.percentile(np.sqrt(np.mean(stretches**2, axis=1) / 6.0), _QUIETEST)) / _QUIET_SHARE


def _still(signal: Signal, gap: float, still_speed: float) -> Float[np.ndarray, "phases 2"]:
    """Returns from when to when [s] one joint stood still."""
    if len(signal) < 3:
        return np.empty((0, 2))
    speed, uncertain = speeds(signal)
    still = np.abs(speed) <= np.maximum(still_speed, _NOISE_FACTOR * uncertain)
    return _runs(signal.time, still, np.diff(signal.time) <= gap)


def _runs(
    time: Float[np.ndarray, " samples"], still: Bool[np.ndarray, " samples"], joined: Bool[np.ndarray, " distances"]
) -> Float[np.ndarray, "runs 2"]:
    """Returns beginning and end of the runs of still samples that no gap parts."""
    together = still[1:] & still[:-1] & joined
    edges = np.diff(np.concatenate([[0], together.astype(np.int8), [0]]))
    return np.stack([time[np.flatnonzero(edges == 1)], time[np.flatnonzero(edges == -1)]], axis=1)


def _overlaps(a: Float[np.ndarray, "m 2"], b: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "both 2"]:
    """Returns the times that are in a phase of one list and in one of the other; both are in order."""
    found, i, k = [], 0, 0
    while i < len(a) and k < len(b):
        start, end = max(a[i, 0], b[k, 0]), min(a[i, 1], b[k, 1])
        if start < end:
            found.append((start, end))
        if a[i, 1] < b[k, 1]:
            i += 1
        else:
            k += 1
    return np.array(found).reshape(-1, 2)
