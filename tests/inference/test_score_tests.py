"""Score tests against what a fit with the effect really gains."""

import numpy as np
import pytest

from boresight.inference.score_tests import fit_robustly, scores


def rows(count=200, parameters=5, seed=0):
    random = np.random.default_rng(seed)
    return random, random.normal(size=(count, parameters)), random.normal(size=count)


def test_without_outliers_the_fit_is_that_of_the_normal_equations():
    _, columns, noise = rows()
    residual = columns @ np.arange(5.0) + 0.5 * noise
    precision = np.full(5, 2.0)
    found = fit_robustly(columns, residual, precision, np.zeros(5))
    expected = np.linalg.solve(columns.T @ columns + np.diag(precision), columns.T @ residual)
    np.testing.assert_allclose(found.step, expected, atol=1e-9)


def test_gross_errors_hardly_move_the_fit():
    random, columns, noise = rows()
    residual = columns @ np.arange(5.0) + 0.5 * noise
    spoiled = residual.copy()
    spoiled[random.choice(200, 20, replace=False)] += 500.0
    clean, robust = (fit_robustly(columns, each, np.zeros(5), np.zeros(5)).step for each in (residual, spoiled))
    plain = np.linalg.lstsq(columns, spoiled, rcond=None)[0]
    assert np.abs(robust - clean).max() < 0.5
    assert np.abs(plain - clean).max() > 5.0


@pytest.mark.parametrize("std", [1e9, 0.3])
def test_a_score_is_what_freeing_the_effect_lowers_the_cost_by(std):
    random, columns, noise = rows()
    effect = random.normal(size=(200, 2)) + 0.5 * columns[:, :2]
    residual = effect @ [0.3, -0.2] + 0.5 * noise
    without = fit_robustly(columns, residual, np.zeros(5), np.zeros(5))
    precision = np.append(np.zeros(5), np.full(2, std**-2))
    freed = fit_robustly(np.hstack([columns, effect]), residual, precision, np.zeros(7))
    told = scores(without, [effect], [np.full(2, std)])[0]
    assert told == pytest.approx(without.cost - freed.cost, rel=1e-6 if std > 1.0 else 0.1)


def test_an_effect_that_parameters_absorb_scores_nothing():
    _, columns, noise = rows()
    fit = fit_robustly(columns, 3.0 * noise, np.zeros(5), np.zeros(5))
    assert scores(fit, [columns[:, [0]] - 2.0 * columns[:, [3]]], [np.ones(1)])[0] == pytest.approx(0.0, abs=1e-9)


def test_scores_of_an_absent_effect_are_chi_square():
    """2,000 draws: their mean is 1 and 95 % lie below 3.84."""
    random, columns, _ = rows(count=60)
    effect = random.normal(size=(60, 1))
    drawn = []
    for _ in range(2000):
        fit = fit_robustly(columns, random.normal(size=60), np.zeros(5), np.zeros(5))
        drawn.append(scores(fit, [effect], [np.full(1, 1e9)])[0])
    assert np.mean(drawn) == pytest.approx(1.0, abs=0.12)
    assert np.mean(np.array(drawn) < 3.841) == pytest.approx(0.95, abs=0.02)
