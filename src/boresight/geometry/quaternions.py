"""Unit quaternions (w, x, y, z) as files have them; q and -q are one orientation."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def quaternion_matrix(quaternion: Float[np.ndarray, "*batch 4"]) -> Float[np.ndarray, "*batch 3 3"]:
    """Returns the rotations of quaternions of any length but zero."""
    w, x, y, z = np.moveaxis(quaternion / np.linalg.norm(quaternion, axis=-1, keepdims=True), -1, 0)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def matrix_quaternion(rotation: Float[np.ndarray, "*batch 3 3"]) -> Float[np.ndarray, "*batch 4"]:
    """Returns the unit quaternions of rotations, w not below 0.

    They are the eigenvectors of the largest eigenvalue of Bar-Itzhack's matrix (2000), which no orientation upsets.
    """
    R = rotation
    K = np.empty((*R.shape[:-2], 4, 4))
    K[..., 0, 0] = R[..., 0, 0] + R[..., 1, 1] + R[..., 2, 2]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        K[..., 0, i + 1] = K[..., i + 1, 0] = R[..., k, j] - R[..., j, k]
        K[..., i + 1, i + 1] = R[..., i, i] - R[..., j, j] - R[..., k, k]
        K[..., j + 1, k + 1] = K[..., k + 1, j + 1] = R[..., j, k] + R[..., k, j]
    quaternion = np.linalg.eigh(K)[1][..., -1]
    return np.where(quaternion[..., :1] < 0.0, -quaternion, quaternion)
