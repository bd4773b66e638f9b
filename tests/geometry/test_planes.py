import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from boresight.geometry import Plane
from random_cells import random_plane

component = st.floats(-10.0, 10.0)
small = st.floats(-0.05, 0.05)


def planes():
    def build(x, y, z, offset):
        assume(math.hypot(x, y, z) > 1e-3)
        return Plane.of((x, y, z), offset)

    return st.builds(build, component, component, component, component)


def test_plane_of_the_paper():
    plane = Plane.of((0.0, 1.0, 4.6), -0.69)
    np.testing.assert_allclose(plane.normal, (0.0, 0.21243, 0.97718), atol=5e-6)
    assert abs(plane.offset - -0.14658) < 5e-6
    assert plane.dropped == 1
    assert plane.free_components == (0, 2)


@given(planes())
def test_normal_is_a_unit_vector_and_points_up(plane):
    assert abs(math.hypot(*plane.normal) - 1.0) < 1e-15
    assert plane.normal[2] > -1e-12


@given(planes(), st.sampled_from([2.0, -1.0, -1e3, 1e-3]))
def test_plane_does_not_depend_on_the_multiple_it_was_given_in(plane, factor):
    x, y, z = plane.normal
    again = Plane.of((factor * x, factor * y, factor * z), factor * plane.offset)
    np.testing.assert_allclose(again.normal, plane.normal, atol=1e-15)
    assert again.offset == pytest.approx(plane.offset, rel=1e-14)


@pytest.mark.parametrize(
    ("normal", "dropped"),
    [((0, 1, 4.6), 1), ((0, 0, 1), 2), ((1, 0, 0), 0), ((0, 1, 0), 1), ((0.8, 0.05, 0.6), 0), ((0.6, -0.05, 0.8), 2)],
)
def test_dropped_component_is_never_one_that_is_nearly_zero(normal, dropped):
    plane = Plane.of(tuple(map(float, normal)), 0.5)
    assert plane.dropped == dropped
    assert abs(plane.normal[dropped]) >= 0.1


@pytest.mark.parametrize(
    ("normal", "offset"),
    [((0.0, 0.0, 0.0), 1.0), ((math.nan, 0.0, 1.0), 1.0), ((math.inf, 0.0, 1.0), 1.0), ((0.0, 0.0, 1.0), math.nan)],
)
def test_plane_without_direction_is_refused(normal, offset):
    with pytest.raises(ValueError, match="must be finite and not zero"):
        Plane.of(normal, offset)


@given(planes(), st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), small)
def test_moved_normal_stays_a_unit_vector_however_far_it_moves(plane, first, second, offset):
    moved = plane.moved((first, second), offset)
    assert abs(math.hypot(*moved.normal) - 1.0) < 1e-14
    assert moved.offset == plane.offset + offset
    assert moved.dropped == plane.dropped


@given(planes(), small, small, small)
def test_moved_components_move_by_what_was_asked_while_the_dropped_one_keeps_its_sign(plane, first, second, offset):
    moved = plane.moved((first, second), offset)
    i, j = plane.free_components
    assume((plane.normal[i] + first) ** 2 + (plane.normal[j] + second) ** 2 < 1.0)
    assert moved.normal[i] == plane.normal[i] + first
    assert moved.normal[j] == plane.normal[j] + second
    assert math.copysign(1.0, moved.normal[plane.dropped]) == math.copysign(1.0, plane.normal[plane.dropped])


def test_derivative_equals_finite_differences():
    rng, step = np.random.default_rng(4), 1e-6
    for _ in range(50):
        plane = random_plane(rng)
        for column in range(3):
            ahead, behind = np.zeros(3), np.zeros(3)
            ahead[column], behind[column] = step, -step
            p, m = (plane.moved((c[0], c[1]), c[2]) for c in (ahead, behind))
            numeric = (np.array([*p.normal, p.offset]) - np.array([*m.normal, m.offset])) / (2 * step)
            np.testing.assert_allclose(plane.derivative[:, column], numeric, rtol=1e-6, atol=1e-7)


def test_derivative_is_finite_where_the_dropped_component_has_gone_to_zero():
    moved = Plane.of((0.0, 0.22, 0.9755), 0.5).moved((0.0, 0.05), 0.0)
    assert moved.normal[1] == 0.0
    assert np.all(np.isfinite(moved.derivative))


def test_height_is_positive_on_the_side_of_the_normal():
    plane = Plane.of((0.0, 0.0, 2.0), -1.0)
    heights = plane.height(np.array([[0.0, 0.0, 0.5], [3.0, 4.0, 1.5], [0.0, 0.0, -0.5]]))
    np.testing.assert_allclose(heights, [0.0, 1.0, -1.0])
