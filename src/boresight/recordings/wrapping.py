"""Readings of a turning joint that start again after a full turn, made continuous and put back."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

TURN = 2.0 * np.pi

_FARTHEST = 1.0
"""A wrapped joint moves less than this [rad] from one sample to the next, beside the turn; a rail moves less than
a turn less this [m]."""

_SLACK = 0.01
"""Readings of a joint that wraps cover a turn, and this much [rad] of noise at its ends."""


def turns_of(readings: Float[np.ndarray, " samples"]) -> Float[np.ndarray, " samples"]:
    """Returns how many turns to add to each sample [rad] to make them continuous; zeros for readings that never wrap.

    Steps of nearly a turn count, and only of readings that all lie within one turn, such as (-pi, pi] or [0, 2 pi).

    Args:
        readings: [rad] in order of time.
    """
    if len(readings) < 2 or np.ptp(readings) > TURN + _SLACK:
        return np.zeros(len(readings))
    steps = np.diff(readings)
    wraps = np.where(np.abs(steps) > TURN - _FARTHEST, -np.sign(steps), 0.0)
    return np.concatenate([[0.0], np.cumsum(wraps)])


def put_back(
    angles: Float[np.ndarray, " angles"], readings: Float[np.ndarray, " samples"]
) -> Float[np.ndarray, " angles"]:
    """Returns angles [rad] of a joint that wraps where its own readings are.

    Args:
        angles: of the joint made continuous.
        readings: as the joint reported them, all within one turn.
    """
    lowest = (readings.min() + readings.max()) / 2.0 - TURN / 2.0
    return lowest + np.mod(angles - lowest, TURN)
