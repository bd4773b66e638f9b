import math

import numpy as np

from boresight.geometry import Frame, inverse, rpy_matrix
from random_cells import random_frame


def test_transform_maps_child_coordinates_to_parent_coordinates():
    """The child stands 1 m along the parent's x and is turned by 90 degrees about z."""
    T_a_b = Frame((1.0, 0.0, 0.0), (0.0, 0.0, math.pi / 2)).matrix
    p_b = np.array([2.0, 0.0, 0.0, 1.0])
    p_a = T_a_b @ p_b
    np.testing.assert_allclose(p_a, [1.0, 2.0, 0.0, 1.0], atol=1e-15)
    np.testing.assert_allclose(inverse(T_a_b) @ p_a, p_b, atol=1e-15)


def test_frame_of_a_matrix_is_that_frame():
    rng = np.random.default_rng(1)
    for _ in range(30):
        frame = random_frame(rng)
        np.testing.assert_allclose(Frame.of(frame.matrix).matrix, frame.matrix, atol=1e-15)


def test_inverse_of_a_batch_undoes_it():
    rng = np.random.default_rng(2)
    T = np.array([random_frame(rng).matrix for _ in range(6)]).reshape(2, 3, 4, 4)
    np.testing.assert_allclose(inverse(T) @ T, np.broadcast_to(np.eye(4), T.shape), atol=1e-15)


def test_moved_frame_is_shifted_in_the_parent_and_turned_about_itself():
    rng = np.random.default_rng(3)
    for pitch in (0.3, math.pi / 2, -math.pi / 2, math.pi / 2 - 1e-7):
        frame = Frame((0.1, 0.2, 0.3), (0.4, pitch, -0.5))
        shift, turn = tuple(rng.uniform(-0.1, 0.1, 3)), tuple(rng.uniform(-0.1, 0.1, 3))
        moved = frame.moved(shift, turn).matrix
        np.testing.assert_allclose(moved[:3, 3], np.array(frame.xyz) + shift, atol=1e-15)
        np.testing.assert_allclose(moved[:3, :3], frame.matrix[:3, :3] @ rpy_matrix(turn), atol=1e-12)


def test_frame_moved_by_nothing_stays():
    frame = Frame((0.1, 0.2, 0.3), (0.4, 0.5, 0.6))
    np.testing.assert_allclose(frame.moved((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)).matrix, frame.matrix, atol=1e-15)
