"""Rotations as vectors: the axis times the angle, and how such a vector changes when the rotation does."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from boresight.geometry.quaternions import matrix_quaternion

_SMALL = 1e-4
"""Below this angle [rad] series are exact to the last bit where quotients are not."""


def rotation_vector(rotation: Float[np.ndarray, "*batch 3 3"]) -> Float[np.ndarray, "*batch 3"]:
    """Returns the vectors [rad] along the axes of rotations, as long as their angles, which are at most pi."""
    quaternion = matrix_quaternion(rotation)
    sine = np.linalg.norm(quaternion[..., 1:], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, quaternion[..., :1])
    return quaternion[..., 1:] * np.where(sine > _SMALL, angle / np.maximum(sine, 1e-300), 2.0 + sine**2 / 3.0)


def vector_rotation(vector: Float[np.ndarray, "*batch 3"]) -> Float[np.ndarray, "*batch 3 3"]:
    """Returns the rotations about vectors by their lengths [rad] (Rodrigues)."""
    angle = np.linalg.norm(vector, axis=-1)[..., None, None]
    K = _cross_matrix(vector)
    return np.eye(3) + np.sinc(angle / np.pi) * K + 0.5 * np.sinc(0.5 * angle / np.pi) ** 2 * (K @ K)


def vector_slope(vector: Float[np.ndarray, "*batch 3"]) -> Float[np.ndarray, "*batch 3 3"]:
    """Returns d(rotation vector) by a small turn that follows the rotation: the inverse of SO(3)'s left Jacobian."""
    angle = np.linalg.norm(vector, axis=-1)[..., None, None]
    K = _cross_matrix(vector)
    half = 0.5 * np.maximum(angle, _SMALL)
    second = np.where(angle > _SMALL, (1.0 - half / np.tan(half)) / (4.0 * half**2), 1.0 / 12.0)
    return np.eye(3) - 0.5 * K + second * (K @ K)


def _cross_matrix(vector: Float[np.ndarray, "*batch 3"]) -> Float[np.ndarray, "*batch 3 3"]:
    K = np.zeros((*vector.shape, 3))
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        K[..., k, j], K[..., j, k] = vector[..., i], -vector[..., i]
    return K
