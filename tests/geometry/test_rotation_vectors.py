"""Rotation vectors and quaternions against each other and against SciPy."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from boresight.geometry import (
    matrix_quaternion,
    quaternion_matrix,
    rotation_vector,
    vector_rotation,
    vector_slope,
)

SIZES = [0.0, 1e-12, 1e-7, 1e-4, 1.1e-4, 1e-2, 1.0, 3.0, np.pi - 1e-6]


def vectors(size, count=20):
    random = np.random.default_rng(int(size * 1e6) + 1)
    directions = random.normal(size=(count, 3))
    return size * directions / np.linalg.norm(directions, axis=1, keepdims=True)


@pytest.mark.parametrize("size", SIZES)
def test_vector_and_rotation_are_scipys(size):
    v = vectors(size)
    np.testing.assert_allclose(vector_rotation(v), Rotation.from_rotvec(v).as_matrix(), atol=1e-14)
    np.testing.assert_allclose(rotation_vector(vector_rotation(v)), v, atol=1e-9 if size > 3 else 1e-14)


@pytest.mark.parametrize("size", SIZES)
def test_quaternions_are_scipys_up_to_sign(size):
    R = vector_rotation(vectors(size))
    q = matrix_quaternion(R)
    assert np.all(q[:, 0] >= 0.0)
    theirs = Rotation.from_matrix(R).as_quat(canonical=True)[:, [3, 0, 1, 2]]
    np.testing.assert_allclose(q, theirs, atol=1e-9)
    for same in (q, -q, 1.005 * q):
        np.testing.assert_allclose(quaternion_matrix(same), R, atol=1e-14)


@pytest.mark.parametrize("size", [1e-9, 1e-4, 1.1e-4, 0.3, 2.5])
def test_slope_is_the_derivative_of_the_vector(size):
    v, step = vectors(size), 1e-6
    R = vector_rotation(v)
    for axis, turn in enumerate(step * np.eye(3)):
        ahead, behind = (rotation_vector(vector_rotation(sign * turn) @ R) for sign in (1.0, -1.0))
        np.testing.assert_allclose(vector_slope(v)[:, :, axis], (ahead - behind) / (2 * step), atol=2e-9)
