"""Triangles in place of tall Jacobians, against NumPy's factorisations of the whole."""

import numpy as np
import pytest

from boresight.search import Triangle, reduced

RNG = np.random.default_rng(7)


def blocks(jacobian, residual, size):
    whole = np.column_stack([jacobian, residual])
    return [np.ascontiguousarray(whole[start : start + size].T) for start in range(0, len(whole), size)]


@pytest.mark.parametrize("rows", [1, 5, 127, 128, 129, 1000])
@pytest.mark.parametrize("size", [1, 100, 128, 300])
def test_blocks_have_the_singular_values_gradient_and_square_of_the_whole(rows, size):
    jacobian, residual = RNG.normal(size=(rows, 7)) * np.logspace(-3, 3, 7), RNG.normal(size=rows)
    found = reduced(blocks(jacobian, residual, size), 7)
    expected = np.zeros(7)
    expected[: min(rows, 7)] = np.linalg.svd(jacobian, compute_uv=False)
    np.testing.assert_allclose(np.linalg.svd(found.slopes, compute_uv=False), expected, rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(found.gradient, jacobian.T @ residual, rtol=1e-10, atol=1e-10)
    assert found.square == pytest.approx(residual @ residual, rel=1e-13)
    assert np.array_equal(found.slopes, np.triu(found.slopes))


def test_the_condition_number_is_not_squared():
    left, _ = np.linalg.qr(RNG.normal(size=(3000, 5)))
    right, _ = np.linalg.qr(RNG.normal(size=(5, 5)))
    sizes = np.array([1.0, 1e-3, 1e-6, 1e-9, 1e-11])
    found = reduced(blocks((left * sizes) @ right, np.zeros(3000), 500), 5)
    np.testing.assert_allclose(np.linalg.svd(found.slopes, compute_uv=False), sizes, rtol=1e-4)


def test_the_linear_solution_is_that_of_the_whole():
    jacobian, residual = RNG.normal(size=(500, 4)), RNG.normal(size=500)
    found = Triangle.of(jacobian, residual)
    step = np.linalg.solve(found.slopes, found.residual)
    np.testing.assert_allclose(step, np.linalg.lstsq(jacobian, residual, rcond=None)[0], rtol=1e-11)


def test_no_rows_leave_nothing():
    found = reduced([], 3)
    assert found.square == 0.0
    assert not found.slopes.any()


def test_columns_of_zeros_stay_zero():
    jacobian = RNG.normal(size=(300, 3)) * [1.0, 0.0, 1.0]
    found = Triangle.of(jacobian, RNG.normal(size=300))
    assert not found.slopes[:, 1].any()
    np.testing.assert_allclose(found.slopes.T @ found.slopes, jacobian.T @ jacobian, atol=1e-10)


def test_scaled_triangles_belong_to_scaled_parameters():
    jacobian, residual, scale = RNG.normal(size=(50, 3)), RNG.normal(size=50), np.array([1e-3, 1.0, 20.0])
    scaled, again = Triangle.of(jacobian, residual).scaled(scale), Triangle.of(jacobian * scale, residual)
    np.testing.assert_allclose(scaled.gradient, again.gradient, rtol=1e-10)
