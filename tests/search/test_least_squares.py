"""Least squares with an exact Jacobian."""

import numpy as np
import pytest
from scipy import optimize

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


def exponentials(count):
    """Two decays sampled at many times, with noise: their residuals, derivatives and usual sizes."""
    times = np.linspace(0.0, 4.0, count)
    seen = 2.0 * np.exp(-1.3 * times) + 0.5 * np.exp(-0.2 * times) + np.random.default_rng(3).normal(0.0, 0.01, count)

    def residual(x):
        return x[0] * np.exp(-x[1] * times) + x[2] * np.exp(-x[3] * times) - seen

    def jacobian(x):
        first, second = np.exp(-x[1] * times), np.exp(-x[3] * times)
        return np.column_stack([first, -x[0] * times * first, second, -x[2] * times * second])

    return residual, jacobian, np.array([1.5, 1.0, 0.7, 0.1])


@pytest.mark.parametrize("count", [20, 5000])
def test_the_free_optimum_is_minpacks(count):
    residual, jacobian, start = exponentials(count)
    expected = optimize.least_squares(residual, start, jac=jacobian, method="lm", xtol=1e-12, ftol=1e-14, gtol=1e-12)
    free = np.full(4, np.inf)
    found = least_squares(residual, jacobian, start, scale=np.ones(4), lower=-free, upper=free)
    # As near as the rounding of a cost that is flat there lets any search come; how near differs between machines.
    np.testing.assert_allclose(found.best, expected.x, rtol=1e-7)
    assert found.cost == pytest.approx(2.0 * expected.cost, rel=1e-12)
    assert found.evaluations <= expected.nfev + 2


@pytest.mark.parametrize("most", [[1.8, 9.0, 9.0, 9.0], [1.8, 9.0, 0.4, 9.0], [9.0, 1.1, 9.0, 0.15]])
def test_the_optimum_at_bounds_is_scipys(most):
    residual, jacobian, start = exponentials(400)
    lower, upper = np.zeros(4), np.array(most)
    start = np.minimum(start, upper - 0.01)
    expected = optimize.least_squares(
        residual, start, jac=jacobian, bounds=(lower, upper), xtol=1e-15, ftol=1e-15, gtol=1e-15
    )
    found = least_squares(residual, jacobian, start, scale=np.ones(4), lower=lower, upper=upper)
    np.testing.assert_allclose(found.best, expected.x, atol=1e-4)
    assert found.cost <= 2.0 * expected.cost * (1.0 + 1e-12)
    assert np.any(found.best == upper)


def test_what_no_residual_sees_stays_where_it_was():
    found = least_squares(
        lambda x: np.array([x[0] + x[1] - 3.0, 2.0 * (x[0] + x[1]) - 6.0]),
        lambda x: np.array([[1.0, 1.0], [2.0, 2.0]]),
        np.array([1.0, 0.0]),
        **FREE,
    )
    np.testing.assert_allclose(found.best, [2.0, 1.0], atol=1e-12)


def test_a_step_into_nowhere_is_taken_back():
    def residual(x):
        return np.array([np.log(x[0]) if x[0] > 0.0 else np.nan, 0.0])

    found = least_squares(residual, lambda x: np.array([[1.0 / x[0]], [0.0]]), np.array([20.0]), scale=np.ones(1),
                          lower=np.array([-np.inf]), upper=np.array([np.inf]))  # fmt: skip
    np.testing.assert_allclose(found.best, 1.0, atol=1e-9)
