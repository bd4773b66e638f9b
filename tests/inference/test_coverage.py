"""Coverage factors against published tables and against draws."""

from __future__ import annotations

import numpy as np
import pytest

from boresight.inference.coverage import ball_radius, effective_freedom, ellipsoid_square, interval_factor

KNOWN = np.array([np.inf])


def test_factors_of_single_values_are_those_of_the_gum():
    """JCGM 100:2008, table G.2, at 95 %."""
    factors = interval_factor(np.array([1.0, 5.0, 10.0, 50.0, np.inf]))
    np.testing.assert_allclose(factors, [12.71, 2.57, 2.23, 2.01, 1.960], atol=5e-3)


def test_ellipsoids_are_those_of_the_tables_of_chi_square_and_f():
    assert ellipsoid_square(KNOWN)[0] == pytest.approx(7.815, abs=1e-3)
    assert ellipsoid_square(np.array([10.0]))[0] == pytest.approx(3.0 * 3.708, abs=5e-3)


def test_ball_about_equal_directions_and_about_one_is_exact():
    covariances = np.array([4.0 * np.eye(3), np.diag([9.0, 0.0, 0.0])])
    expected = [2.0 * np.sqrt(7.815), 3.0 * 1.960]
    np.testing.assert_allclose(ball_radius(covariances, np.repeat(KNOWN, 2)), expected, rtol=1e-3)


def test_ball_of_nothing_is_nothing():
    assert ball_radius(np.zeros((1, 3, 3)), KNOWN)[0] == 0.0


@pytest.mark.parametrize("variances", [(1.0, 1.0, 0.1), (1.0, 0.3, 0.01), (1.0, 0.05, 0.05)])
@pytest.mark.parametrize("freedom", [4.0, 12.0, np.inf])
def test_ball_holds_95_percent_of_draws(variances, freedom):
    rng = np.random.default_rng(5)
    drawn = rng.normal(size=(200_000, 3)) * np.sqrt(variances)
    if np.isfinite(freedom):
        drawn /= np.sqrt(rng.chisquare(freedom, 200_000) / freedom)[:, None]
    radius = ball_radius(np.diag(variances)[None], np.array([freedom]))[0]
    assert np.mean(np.linalg.norm(drawn, axis=1) < radius) == pytest.approx(0.95, abs=0.012)


def test_degrees_of_freedom_of_a_combined_variance():
    """Welch and Satterthwaite with a known part: nu / share squared (JCGM 100, equation G.2b)."""
    combined = effective_freedom(np.array([2.0, 2.0]), np.array([2.0, 1.0]), 6.0)
    np.testing.assert_allclose(combined, [6.0, 24.0])
    assert np.isinf(effective_freedom(np.ones(1), np.ones(1), np.inf)).all()
