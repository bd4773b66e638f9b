"""Rotations: roll-pitch-yaw about fixed axes, skew matrices, and the angle between two orientations.

Roll-pitch-yaw is ROS's and URDF's: R = Rz(yaw) Ry(pitch) Rx(roll).
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def axis_rotation(axis: int, angle_rad: Float[np.ndarray, "*batch"] | float) -> Float[np.ndarray, "*batch 3 3"]:
    """Returns the rotation about coordinate axis 0, 1 or 2 (x, y, z) by an angle [rad]."""
    angle = np.asarray(angle_rad, dtype=float)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    rotation = np.zeros((*angle.shape, 3, 3))
    rotation[..., axis, axis] = 1.0
    rotation[..., i, i] = rotation[..., j, j] = np.cos(angle)
    rotation[..., j, i] = np.sin(angle)
    rotation[..., i, j] = -np.sin(angle)
    return rotation


def rpy_matrix(rpy_rad: Float[np.ndarray, "3"] | tuple[float, float, float]) -> Float[np.ndarray, "3 3"]:
    """Returns R = Rz(yaw) Ry(pitch) Rx(roll) of (roll, pitch, yaw) [rad]."""
    roll, pitch, yaw = (float(angle) for angle in rpy_rad)
    return axis_rotation(2, yaw) @ axis_rotation(1, pitch) @ axis_rotation(0, roll)


def matrix_rpy(rotation: Float[np.ndarray, "3 3"]) -> tuple[float, float, float]:
    """Returns (roll, pitch, yaw) [rad] of a rotation, pitch in [-pi/2, pi/2]; roll is 0 at |pitch| = pi/2."""
    horizontal = float(np.hypot(rotation[0, 0], rotation[1, 0]))
    pitch = float(np.arctan2(-rotation[2, 0], horizontal))
    if horizontal < 1e-12:
        return 0.0, pitch, float(np.arctan2(-rotation[0, 1], rotation[1, 1]))
    yaw = float(np.arctan2(rotation[1, 0], rotation[0, 0]))
    return _roll_after(yaw, rotation), pitch, yaw


def rpy_near(rotation: Float[np.ndarray, "3 3"], rpy_rad: tuple[float, float, float]) -> tuple[float, float, float]:
    """Returns the (roll, pitch, yaw) [rad] of a rotation that are nearest to given ones.

    Every orientation has two such triples, and turns of 2 pi; where pitch is a right angle, the given yaw is kept.
    """
    horizontal = float(np.hypot(rotation[0, 0], rotation[1, 0]))
    yaw = float(np.arctan2(rotation[1, 0], rotation[0, 0])) if horizontal > 1e-13 else float(rpy_rad[2])
    found = []
    for turned in (yaw, yaw + np.pi):
        forward = np.cos(turned) * rotation[0, 0] + np.sin(turned) * rotation[1, 0]
        pitch = float(np.arctan2(-rotation[2, 0], forward))
        angles = np.array([_roll_after(turned, rotation), pitch, turned])
        found.append(angles + 2 * np.pi * np.round((np.asarray(rpy_rad) - angles) / (2 * np.pi)))
    roll, pitch, yaw = min(found, key=lambda angles: float(np.abs(angles - rpy_rad).sum()))
    return float(roll), float(pitch), float(yaw)


def _roll_after(yaw: float, rotation: Float[np.ndarray, "3 3"]) -> float:
    """Returns the roll that belongs to a yaw: near a right angle of pitch, where yaw itself is uncertain, the two
    must make up for each other.
    """
    c, s = np.cos(yaw), np.sin(yaw)
    return float(np.arctan2(s * rotation[0, 2] - c * rotation[1, 2], c * rotation[1, 1] - s * rotation[0, 1]))


def rotation_angle(
    first: Float[np.ndarray, "*batch 3 3"], second: Float[np.ndarray, "*batch 3 3"]
) -> Float[np.ndarray, "*batch"]:
    """Returns the angle [rad] that turns one orientation into the other."""
    relative = np.swapaxes(first, -1, -2) @ second
    sine = 0.5 * np.linalg.norm(
        np.stack(
            [
                relative[..., 2, 1] - relative[..., 1, 2],
                relative[..., 0, 2] - relative[..., 2, 0],
                relative[..., 1, 0] - relative[..., 0, 1],
            ],
            axis=-1,
        ),
        axis=-1,
    )
    cosine = 0.5 * (np.trace(relative, axis1=-2, axis2=-1) - 1.0)
    return np.asarray(np.arctan2(sine, cosine))


def nearest_rotation(matrix: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "3 3"]:
    """Returns the rotation nearest to a matrix in the Frobenius norm (Kabsch 1976; Umeyama 1991)."""
    u, _, vt = np.linalg.svd(matrix)
    flip = np.diag([1.0, 1.0, float(np.sign(np.linalg.det(u @ vt)))])
    return u @ flip @ vt
