"""Problems whose rows are taken block by block, against the same with all rows at once."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import measured, position_cell, ranger_cell
from scipy import optimize

from boresight.calibration.campaign import Freedom
from boresight.calibration.problem import Problem
from boresight.calibration.robust import refine
from boresight.inference import identify_directions, posterior_covariance
from boresight.sensing import linear

ROWS = 2 * linear.BLOCK + 77


@pytest.fixture(params=["ranger", "position", "bent"])
def problem(request, monkeypatch):
    """A weighed problem of several blocks, the last one not full; of each kind of model."""
    cell = position_cell() if request.param == "position" else ranger_cell(planes=3)
    if request.param == "bent":
        cell = replace(cell, arm=cell.arm.with_harmonics())
        monkeypatch.setattr(linear, "_ROWS", 100)
    rows = 350 if request.param == "bent" else ROWS
    names = [p.name for p in cell.parameters if p.name.startswith("j")][:: 1 if request.param != "bent" else 2]
    freedoms = tuple(Freedom(name, 0.02, 0.01) for name in names)
    rng = np.random.default_rng(2)
    readings = measured(cell, rows=rows, seed=1)
    readings = replace(readings, values=readings.values + rng.normal(0.0, 1e-3, readings.values.shape))
    weight = rng.integers(0, 3, rows) / 2.0
    return Problem(cell, readings, freedoms, 1e-4, weight)


@pytest.fixture
def x(problem):
    return np.random.default_rng(0).uniform(-2e-3, 2e-3, len(problem.names))


def test_the_square_is_that_of_all_residuals(problem, x):
    assert problem.square(x) == pytest.approx(np.sum(problem.residual(x) ** 2), rel=1e-12)


def test_the_triangle_is_that_of_the_whole_jacobian(problem, x):
    found, jacobian, residual = problem.triangle(x), problem.jacobian(x), problem.residual(x)
    jacobian = jacobian * problem.scale
    found = found.scaled(problem.scale)
    expected = jacobian.T @ jacobian
    np.testing.assert_allclose(found.slopes.T @ found.slopes, expected, atol=1e-12 * expected.max())
    expected = jacobian.T @ residual
    np.testing.assert_allclose(found.gradient, expected, atol=1e-10 * np.abs(expected).max())


def test_what_is_seen_has_the_singular_values_and_directions_of_the_whole(problem, x):
    whole = identify_directions(problem.names, problem.sensitivity(x), problem.scale)
    found = identify_directions(problem.names, problem.seen(x), problem.scale)
    assert found.rank == whole.rank
    size = whole.singular_values[0]
    np.testing.assert_allclose(found.singular_values, whole.singular_values, atol=1e-11 * size)
    blind = problem.sensitivity(x) * problem.scale @ found.unseen.T
    assert np.abs(blind).max(initial=0.0) < 1e-5 * size


def test_the_covariance_is_that_of_the_whole(problem, x):
    expected = posterior_covariance(problem.sensitivity(x), problem.prior_std)
    std = np.sqrt(np.diag(expected))
    assert np.abs((problem.covariance(x) - expected) / np.outer(std, std)).max() < 1e-7


def test_leverages_are_those_of_the_hat_matrix(problem, x):
    slopes = linear.slopes_of(problem.model, x, problem.readings) / problem.std[:, :, None]
    expected = np.einsum("rci,ij,rcj->rc", slopes, problem.covariance(x), slopes)
    np.testing.assert_allclose(problem.leverage(x), expected, rtol=1e-7)


def test_the_optimum_is_minpacks_on_the_whole(problem):
    start, scale = np.zeros(len(problem.names)), problem.scale
    expected = optimize.least_squares(
        lambda z: problem.residual(z * scale),
        start,
        jac=lambda z: problem.jacobian(z * scale) * scale,
        method="lm",
        xtol=1e-12,
        ftol=1e-14,
        gtol=1e-12,
    )
    found = refine(replace(problem, freedoms=tuple(replace(f, within=None) for f in problem.freedoms)), start)
    std = np.sqrt(np.diag(problem.covariance(found.best)))
    assert found.cost == pytest.approx(2.0 * expected.cost, rel=1e-9)
    assert np.abs((found.best - expected.x * scale) / std).max() < 1e-4


def test_other_weights_are_not_mistaken_for_what_was_seen_before(problem, x):
    problem.seen(x)
    other = problem.weighed(np.ones(len(problem.readings)), 0.0)
    expected = np.linalg.svd(other.sensitivity(x), compute_uv=False)
    np.testing.assert_allclose(np.linalg.svd(other.seen(x), compute_uv=False), expected, atol=1e-10 * expected[0])
    assert not np.array_equal(problem.seen(x), problem.seen(x + 1e-3))
