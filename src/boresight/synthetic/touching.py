"""Configurations in which a tip touches its plane or point."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from boresight.sensing import Cell

_STEPS = 12
_STEP = 1e-6
_CLOSE = 1e-12
"""A tip this close [m] to where it should be is there."""

_LEAST = 1e-9
"""Square of a lever [m²] below which a joint moves the tip too little to be of use."""


def touching(
    cell: Cell,
    joints: Float[np.ndarray, "rows joints"],
    place: int,
    off: Float[np.ndarray, "rows channels"] | float = 0.0,
) -> Float[np.ndarray, "rows joints"]:
    """Returns configurations near the given ones in which the tip is so far off its plane or point, else NaN.

    Newton's method along the shortest way in joint space.

    Args:
        cell: the cell.
        joints: where to begin [rad or m].
        place: index of the aim, a contact's.
        off: signed distance [m] from the plane, or vector [m] from the point.
    """
    joints = np.array(joints, dtype=float)
    target = np.full(len(joints), place)
    channels = len(cell.sensors[cell.aims[place].sensor].channels)

    def left(at: np.ndarray) -> np.ndarray:
        return cell.predict(at, target)[:, :channels] - off

    for _ in range(_STEPS):
        now = left(joints)
        slopes = np.stack([(left(joints + step) - now) / _STEP for step in _STEP * np.eye(joints.shape[1])], axis=2)
        square = slopes @ np.swapaxes(slopes, 1, 2) + _LEAST * np.eye(channels)
        joints -= (np.swapaxes(slopes, 1, 2) @ np.linalg.solve(square, now[:, :, None]))[:, :, 0]
    joints[np.abs(left(joints)).max(axis=1, initial=0.0) > _CLOSE] = np.nan
    return joints
