"""Residuals and their Jacobian."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import DECK, measured, position_cell, ranger_cell, rehearsed_campaign

from boresight.calibration.campaign import Freedom
from boresight.calibration.problem import MISSED_M, Problem
from boresight.geometry import Frame


def problem_of(kind, seed=0):
    frames = {"base": Frame((0.1, -0.2, 0.05), (0.3, -0.2, 0.5)), "mount": Frame((0.02, 0.01, 0.03), (0.1, 0.2, -0.3))}
    cell = ranger_cell(planes=3, **frames) if kind == "ranger" else position_cell(**frames)
    names = [p.name for p in cell.parameters]
    freedoms = tuple(Freedom(name, 0.02, None if i % 3 else 0.01) for i, name in enumerate(names))
    return Problem(cell, measured(cell, rows=25, seed=seed), freedoms, model_std=1e-4)


@pytest.mark.parametrize("kind", ["ranger", "position"])
@pytest.mark.parametrize("seed", [0, 1])
def test_the_jacobian_is_the_residuals_derivative_priors_and_all(kind, seed):
    problem = problem_of(kind, seed)
    x = np.random.default_rng(seed).uniform(-2e-3, 2e-3, len(problem.names))
    step = 1e-6
    numeric = np.column_stack(
        [(problem.residual(x + step * e) - problem.residual(x - step * e)) / (2 * step) for e in np.eye(len(x))]
    )
    analytic = problem.jacobian(x)
    assert np.abs(analytic - numeric).max() < 1e-6 * np.abs(analytic).max()


def test_residuals_are_errors_over_their_std_and_then_corrections_over_their_priors():
    problem = problem_of("ranger")
    x = np.full(len(problem.names), 1e-3)
    residual = problem.residual(x)
    assert residual.shape == (25 + len(x),)
    assert np.allclose(residual[:25], problem.errors(x)[:, 0] / np.hypot(problem.readings.std[:, 0], 1e-4))
    assert np.allclose(residual[25:], x / problem.prior_std)


def test_where_nothing_is_believed_the_prior_has_no_say():
    problem = problem_of("ranger")
    free = ~np.isfinite(problem.prior_std)
    assert free.any()
    assert np.all(problem.residual(np.ones(len(free)))[25:][free] == 0.0)


def test_a_missed_beam_has_a_constant_residual_and_no_slope():
    campaign, _ = rehearsed_campaign(planes=1, rows=20)
    away = replace(DECK, offset=-50.0)
    problem = Problem(replace(campaign.cell, targets={"deck": away}), campaign.readings, campaign.freedoms)
    x = np.zeros(len(problem.names))
    missed = ~np.isfinite(problem.errors(x)[:, 0])
    assert missed.any()
    for at in (x, x + 1e-3):
        assert np.allclose(problem.residual(at)[:20][missed] * problem.std[missed, 0], MISSED_M)
        assert np.all(problem.sensitivity(at)[missed] == 0.0)


def test_the_compiled_cost_is_the_sum_of_squares():
    campaign, _ = rehearsed_campaign()
    problem = Problem(campaign.cell, campaign.readings, campaign.freedoms)
    members = np.random.default_rng(0).uniform(-0.005, 0.005, (6, len(problem.names)))
    squares = [np.sum(problem.residual(x) ** 2) * problem.usual_std**2 for x in members]
    assert np.allclose(problem.cost(members), squares, rtol=1e-7)


def test_some_rows_are_the_same_problem_on_fewer_readings():
    problem = problem_of("position")
    rows = np.array([3, 1, 7])
    x = np.full(len(problem.names), 1e-3)
    assert np.array_equal(problem.on(rows).errors(x), problem.errors(x)[rows])


def test_the_fitted_cell_predicts_what_the_problem_does():
    problem = problem_of("ranger")
    x = np.random.default_rng(5).uniform(-2e-3, 2e-3, len(problem.names))
    fitted = problem.fitted(x)
    rows = problem.readings
    assert np.allclose(fitted.predict(rows.joints, rows.target) - rows.values, problem.errors(x), atol=1e-12)


@pytest.mark.parametrize("kind", ["ranger", "position"])
def test_the_compiled_cost_knows_how_far_a_bent_arm_bends(kind):
    problem = problem_of(kind)
    arm = problem.cell.arm.with_harmonics().with_sag()
    further = [n for n in arm.chain.parameters if n.rpartition(".")[2][:3] in ("cos", "sin", "sag")]
    arm = arm.corrected(dict.fromkeys(further, 1e-3))
    bent = replace(problem, cell=replace(problem.cell, arm=arm))
    nominal = np.zeros(len(problem.names))
    squares = np.nansum((bent.errors(nominal) * bent.usual_std / bent.std) ** 2)
    assert squares > 1e2 * np.nansum((problem.errors(nominal) * problem.usual_std / problem.std) ** 2)
    assert bent.cost(nominal[None])[0] == pytest.approx(squares, rel=1e-9)


def test_what_is_learned_holds_in_place_of_what_was_believed():
    problem = problem_of("position")
    learned = replace(problem, freedoms=tuple(replace(f, learned_std=1e-4) for f in problem.freedoms))
    assert np.all(learned.prior_std == 1e-4)
    assert np.array_equal(learned.believed_std, problem.prior_std)
