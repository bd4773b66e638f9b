"""The three ways to search."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import NOISE, rehearsed_campaign, with_gross_error

from boresight.calibration import SOLVERS, Solver, calibrate
from boresight.calibration.problem import Problem
from boresight.calibration.solve import solve
from boresight.errors import InputError


@pytest.fixture(scope="module")
def easy():
    campaign, truth = rehearsed_campaign()
    return campaign, truth, {name: calibrate(campaign, Solver(name)) for name in SOLVERS}


def poses_error(cell, truth, joints):
    return np.abs(cell.poses(joints)[:, :3, 3] - truth.poses(joints)[:, :3, 3]).max()


def test_three_solvers_agree_on_an_easy_campaign(easy):
    campaign, truth, results = easy
    for result in results.values():
        assert result.verdict.accepted
        assert poses_error(result.cell, truth, campaign.readings.joints) < 1e-3
        assert result.calibration.after.rms < 1.2 * NOISE


def test_least_squares_ends_where_evolution_and_least_squares_do(easy):
    _, _, results = easy
    both, alone = results["evolution+least-squares"], results["least-squares"]
    assert np.allclose(both.solution.fit.x, alone.solution.fit.x, atol=1e-6)
    assert both.solution.nominal_suffices is True


def test_each_solver_says_what_ran(easy):
    _, _, results = easy
    stages = {name: [stage.name for stage in result.solution.stages] for name, result in results.items()}
    assert stages == {
        "least-squares": ["least squares from the nominal model"],
        "evolution": ["evolution"],
        "evolution+least-squares": ["evolution", "least squares from evolution's best"],
    }
    assert results["least-squares"].solution.history.shape == (0, 2)
    assert len(results["evolution"].solution.history) > 100


def test_evolution_never_loses_its_best(easy):
    _, _, results = easy
    best = results["evolution"].solution.history[:, 0]
    assert np.all(np.diff(best) <= 0.0)


def test_the_same_seed_gives_the_same_answer_to_the_bit():
    campaign, _ = rehearsed_campaign(rows=40)
    first, again, other = (calibrate(campaign, Solver("evolution", seed=seed)) for seed in (4, 4, 5))
    assert np.array_equal(first.solution.fit.x, again.solution.fit.x)
    assert first.validation == again.validation
    assert not np.array_equal(first.solution.fit.x, other.solution.fit.x)


def test_progress_is_told_while_evolution_runs():
    campaign, _ = rehearsed_campaign(rows=40)
    told = []
    problem = Problem(campaign.cell, campaign.readings, campaign.freedoms)
    solution = solve(problem, Solver("evolution"), lambda generation, cost: told.append((generation, cost)))
    assert told[-1][0] == len(solution.history) - 1
    assert [cost for _, cost in told] == sorted((cost for _, cost in told), reverse=True)


def test_nothing_to_estimate_is_an_error():
    campaign, _ = rehearsed_campaign(rows=10)
    with pytest.raises(InputError, match="every parameter is fixed"):
        calibrate(replace(campaign, freedoms=()))


def test_no_readings_is_an_error():
    campaign, _ = rehearsed_campaign(rows=10)
    with pytest.raises(InputError, match="a calibration needs readings"):
        calibrate(replace(campaign, readings=None))


@pytest.mark.parametrize("error_m", [0.02, -0.05, 0.4])
@pytest.mark.parametrize("row", [0, 41])
def test_one_gross_error_is_found_alone_with_its_size(row, error_m):
    campaign, truth = rehearsed_campaign()
    result = calibrate(with_gross_error(campaign, row, error_m), Solver("least-squares"))
    (outlier,) = result.outliers
    assert outlier.line == campaign.readings.line[row]
    assert outlier.residual_m == pytest.approx(error_m, abs=2e-3)
    assert poses_error(result.cell, truth, campaign.readings.joints) < 1e-3


def test_clean_readings_have_no_outliers(easy):
    _, _, results = easy
    assert all(result.outliers == () for result in results.values())
