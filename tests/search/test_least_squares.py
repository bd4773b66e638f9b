"""Least squares with an exact Jacobian."""

import numpy as np

from boresight.search import Outcome, least_squares

FREE = {"scale": np.ones(2), "lower": np.full(2, -np.inf), "upper": np.full(2, np.inf)}


def rosenbrock(x):
    return np.array([10.0 * (x[1] - x[0] ** 2), 1.0 - x[0]])


def slope(x):
    return np.array([[-20.0 * x[0], 10.0], [-1.0, 0.0]])


def test_rosenbrock_is_solved():
    found = least_squares(rosenbrock, slope, np.array([-1.2, 1.0]), **FREE)
    assert np.allclose(found.best, 1.0, atol=1e-9)
    assert found.outcome is Outcome.CONVERGED


def test_the_scale_changes_no_answer():
    scaled = least_squares(rosenbrock, slope, np.array([-1.2, 1.0]), **(FREE | {"scale": np.array([1e-3, 1e2])}))
    assert np.allclose(scaled.best, 1.0, atol=1e-8)


def test_bounds_hold():
    found = least_squares(
        rosenbrock, slope, np.zeros(2), scale=np.ones(2), lower=np.full(2, -0.5), upper=np.full(2, 0.5)
    )
    assert np.all(np.abs(found.best) <= 0.5)
    assert found.best[0] > 0.49


def test_a_start_on_the_bound_is_brought_inside():
    found = least_squares(
        rosenbrock, slope, np.array([5.0, 5.0]), scale=np.ones(2), lower=np.full(2, -5.0), upper=np.full(2, 5.0)
    )
    assert np.allclose(found.best, 1.0, atol=1e-6)


def test_running_out_of_evaluations_is_an_outcome():
    found = least_squares(rosenbrock, slope, np.array([-1.2, 1.0]), **FREE, evaluations=2)
    assert found.outcome is Outcome.EVALUATIONS
