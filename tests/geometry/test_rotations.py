import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from boresight.geometry import matrix_rpy, rotation_angle, rpy_matrix, rpy_near
from boresight.geometry.rotations import axis_rotation, nearest_rotation

angles = st.floats(-math.pi, math.pi)
pitches = st.one_of(
    st.floats(-math.pi / 2, math.pi / 2),
    st.builds(
        lambda sign, exponent: sign * (math.pi / 2 - 10.0**exponent),
        st.sampled_from([-1.0, 1.0]),
        st.floats(-16.0, -1.0),
    ),
)


def is_rotation(R):
    return np.allclose(R @ R.T, np.eye(3), atol=1e-14) and np.linalg.det(R) > 0


@given(angles, pitches, angles)
@example(0.3, math.pi / 2, -2.0)
@example(0.3, -math.pi / 2, -2.0)
@example(3.0, math.pi / 2 - 1e-12, -2.0)
@example(3.0, math.pi / 2 - 1e-9, -2.0)
def test_rpy_of_a_rotation_gives_that_rotation_back(roll, pitch, yaw):
    R = rpy_matrix((roll, pitch, yaw))
    again = matrix_rpy(R)
    assert -math.pi / 2 <= again[1] <= math.pi / 2
    np.testing.assert_allclose(rpy_matrix(again), R, rtol=0, atol=2e-12)


@given(angles, st.floats(-1.5, 1.5), angles)
def test_rpy_is_given_back_away_from_the_singularity(roll, pitch, yaw):
    again = np.array(matrix_rpy(rpy_matrix((roll, pitch, yaw)))) - [roll, pitch, yaw]
    turns = again / (2 * math.pi)
    np.testing.assert_allclose(again, np.round(turns) * 2 * math.pi, atol=1e-13)


def test_rpy_turns_about_fixed_axes_roll_first():
    roll, pitch, yaw = 0.3, -0.4, 0.5
    expected = axis_rotation(2, yaw) @ axis_rotation(1, pitch) @ axis_rotation(0, roll)
    np.testing.assert_array_equal(rpy_matrix((roll, pitch, yaw)), expected)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_positive_turn_takes_the_next_axis_to_the_one_after(axis):
    quarter = axis_rotation(axis, math.pi / 2)
    np.testing.assert_allclose(quarter @ np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3], atol=1e-16)


def test_axis_rotation_of_a_batch_equals_a_loop():
    batch = np.random.default_rng(0).uniform(-9, 9, (4, 5))
    together = axis_rotation(1, batch)
    assert together.shape == (4, 5, 3, 3)
    assert is_rotation(together[3, 4])
    for place in np.ndindex(4, 5):
        np.testing.assert_array_equal(together[place], axis_rotation(1, batch[place]))


@given(angles, angles, angles, st.sampled_from([0.0, 1e-12, 1e-8, 1e-3, 1.0, 3.0, math.pi - 1e-8, math.pi]))
def test_rotation_angle_is_the_angle_turned_by_at_every_size(roll, pitch, yaw, angle):
    first = rpy_matrix((roll, pitch, yaw))
    second = first @ rpy_matrix((0.1, 0.2, 0.3)) @ axis_rotation(2, angle) @ rpy_matrix((0.1, 0.2, 0.3)).T
    found = rotation_angle(first, second)
    assert abs(found - angle) < 4e-15
    assert abs(rotation_angle(second, first) - found) < 4e-15


def test_nearest_rotation_of_a_rotation_with_noise_is_near_it_and_proper():
    rng = np.random.default_rng(2)
    for _ in range(50):
        R = rpy_matrix(tuple(rng.uniform(-3, 3, 3)))
        near = nearest_rotation(R + rng.normal(0, 1e-6, (3, 3)))
        assert is_rotation(near)
        assert rotation_angle(R, near) < 1e-5
    assert is_rotation(nearest_rotation(-np.eye(3)))


@given(angles, pitches, angles, st.tuples(*[st.floats(-10.0, 10.0)] * 3))
@example(0.3, math.pi / 2, -2.0, (0.0, math.pi / 2, 0.0))
@example(1e-9, math.pi / 2 - 1e-9, 1e-9, (0.0, math.pi / 2, 0.0))
def test_rpy_near_any_angles_give_the_rotation_back(roll, pitch, yaw, near):
    R = rpy_matrix((roll, pitch, yaw))
    np.testing.assert_allclose(rpy_matrix(rpy_near(R, near)), R, rtol=0, atol=2e-13)


@given(st.tuples(angles, angles, angles), st.tuples(*[st.floats(-1e-3, 1e-3)] * 3))
def test_rpy_near_angles_are_near_them_away_from_the_singularity(rpy, change):
    if abs(math.cos(rpy[1])) < 0.1:
        return
    asked = tuple(a + b for a, b in zip(rpy, change, strict=True))
    found = rpy_near(rpy_matrix(asked), rpy)
    np.testing.assert_allclose(found, asked, rtol=0, atol=1e-12)


def test_rpy_at_a_right_angle_keeps_the_yaw_that_is_given():
    R = rpy_matrix((0.3, math.pi / 2, 0.1))
    assert rpy_near(R, (0.3, math.pi / 2, 0.1)) == pytest.approx((0.3, math.pi / 2, 0.1), abs=1e-12)
    assert rpy_near(R, (0.5, math.pi / 2, 0.3)) == pytest.approx((0.5, math.pi / 2, 0.3), abs=1e-12)
