"""Configurations in which a tip touches its plane."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from boresight.sensing import Cell

_STEPS = 12
_STEP = 1e-6
_CLOSE = 1e-12
"""A tip this close [m] to where it should be is there."""


def touching(
    cell: Cell,
    joints: Float[np.ndarray, "rows joints"],
    place: int,
    height: Float[np.ndarray, "rows"] | float = 0.0,
) -> Float[np.ndarray, "rows joints"]:
    """Returns configurations near the given ones in which the tip is at a height above its plane, else NaN.

    Newton's method along the shortest way in joint space.

    Args:
        cell: the cell.
        joints: where to begin [rad or m].
        place: index of the aim, a plane contact's.
        height: signed distance [m] from the plane.
    """
    joints = np.array(joints, dtype=float)
    target = np.full(len(joints), place)

    def heights(at: np.ndarray) -> np.ndarray:
        return cell.predict(at, target)[:, 0] - height

    for _ in range(_STEPS):
        above = heights(joints)
        slope = np.stack([(heights(joints + step) - above) / _STEP for step in _STEP * np.eye(joints.shape[1])], axis=1)
        joints -= (above / np.maximum(np.sum(slope**2, axis=1), 1e-6))[:, None] * slope
    joints[np.abs(heights(joints)) > _CLOSE] = np.nan
    return joints
