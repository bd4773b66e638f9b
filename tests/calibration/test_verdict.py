"""What is held out, and what is concluded from it."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import measured, rehearsed_campaign

from boresight.calibration import Solver, calibrate
from boresight.calibration.campaign import Freedom
from boresight.calibration.holdout import HeldOut, by_cross_validation, summarise
from boresight.calibration.improvement import FEWEST, improvement
from boresight.calibration.problem import Problem
from boresight.calibration.robust import fit
from boresight.calibration.verdict import Evidence, judge

QUICK = Solver("least-squares")


def fitted(campaign):
    problem = Problem(campaign.cell, campaign.readings, campaign.freedoms)
    return fit(problem, np.zeros(len(problem.names)))


def held_out(before, after):
    return HeldOut("validation rows", np.asarray(before, float), np.asarray(after, float))


@pytest.mark.parametrize("rows", [30, 31, 33])
def test_cross_validation_predicts_every_row_once(rows):
    campaign, _ = rehearsed_campaign(rows=rows)
    found = by_cross_validation(fitted(campaign), seed=0)
    assert len(found.after) == rows
    assert np.all(np.isfinite(found.after))
    assert found.method == "5-fold cross-validation"
    assert found.residuals.count == rows


def test_held_out_errors_are_larger_than_fitted_ones():
    campaign, _ = rehearsed_campaign(rows=40)
    final = fitted(campaign)
    found = by_cross_validation(final, seed=0)
    assert found.residuals.after.rms > np.sqrt(np.mean(final.problem.errors(final.x) ** 2))


def test_the_folds_depend_on_the_seed_alone():
    campaign, _ = rehearsed_campaign(rows=30)
    final = fitted(campaign)
    first, again, other = (by_cross_validation(final, seed).after for seed in (0, 0, 1))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


def test_the_verdict_does_not_hang_on_the_order_of_rows():
    campaign, _ = rehearsed_campaign(rows=40)
    order = np.random.default_rng(0).permutation(40)
    shuffled = replace(campaign, readings=campaign.readings.chosen(order))
    one, two = calibrate(campaign, QUICK), calibrate(shuffled, QUICK)
    assert one.verdict.accepted
    assert two.verdict.accepted
    assert np.allclose(one.solution.fit.x, two.solution.fit.x, atol=1e-7)
    assert two.validation.after.rms == pytest.approx(one.validation.after.rms, rel=0.5)


def test_errors_are_summarised_over_rows_that_both_models_predict():
    nan = float("nan")
    found = summarise("rows", np.array([3.0, nan, 4.0, 1.0]), np.array([1.0, 1.0, nan, 2.0]))
    assert (found.count, found.missed) == (2, 1)
    assert found.before.rms == pytest.approx(np.sqrt(5.0))
    assert found.after.max == 2.0


def test_what_is_left_lies_within_its_interval():
    rng = np.random.default_rng(0)
    found = improvement(held_out(rng.uniform(1, 2, 50), rng.uniform(0.1, 0.2, 50)), seed=0)
    assert found.low < found.ratio < found.high < 0.2


def test_errors_that_did_not_change_are_no_improvement():
    found = improvement(held_out(np.ones(20), np.ones(20)), seed=0)
    assert (found.low, found.ratio, found.high) == (1.0, 1.0, 1.0)


@pytest.fixture(scope="module")
def judged():
    """The verdict on held-out errors, everything else being well."""
    campaign = rehearsed_campaign()[0]
    fit, accuracy = fitted(campaign), calibrate(campaign, QUICK).accuracy
    return lambda before, after: judge(Evidence(held_out(before, after), fit, accuracy))


def test_a_certain_fall_is_accepted_with_its_interval(judged):
    verdict = judged(np.full(20, 0.01), np.full(20, 0.001))
    assert verdict.accepted
    assert verdict.reasons[0] == (
        "Held-out error fell from 10.0 mm to 1.00 mm RMS on validation rows: "
        "what is left is 10.0% to 10.0% of it, with 95 % confidence."
    )
    assert verdict.reasons[1].startswith("Accepted for absolute accuracy")


def test_a_fall_that_may_be_luck_is_rejected(judged):
    before = np.full(20, 0.01)
    after = np.where(np.arange(20) < 10, 0.001, 0.014)
    verdict = judged(before, after)
    assert not verdict.accepted
    assert "No significant improvement" in verdict.reasons[0]


@pytest.mark.parametrize("rows", range(1, FEWEST))
def test_a_handful_of_rows_that_improve_prove_nothing(judged, rows):
    verdict = judged(np.full(rows, 0.01), np.full(rows, 0.001))
    assert not verdict.accepted
    assert "cannot prove an improvement" in verdict.reasons[0]
    assert f"but {rows} held-out configuration" in verdict.reasons[0]


def test_no_row_that_can_be_predicted_is_rejected(judged):
    verdict = judged([np.nan] * 9, [np.nan] * 9)
    assert not verdict.accepted
    assert verdict.reasons[0].startswith("No held-out row could be predicted")


def test_a_parameter_at_its_bound_rejects_and_is_named():
    campaign, truth = rehearsed_campaign()
    wrong = truth.values["j3.a"] - campaign.cell.values["j3.a"]
    tight = tuple(Freedom(f.parameter, abs(wrong) / 3, 1.0) if f.parameter == "j3.a" else f for f in campaign.freedoms)
    verdict = calibrate(replace(campaign, freedoms=tight), QUICK).verdict
    assert not verdict.accepted
    assert any("j3.a" in reason and "widen `within`" in reason for reason in verdict.reasons)


def test_noise_alone_teaches_nothing():
    campaign, _ = rehearsed_campaign(rows=40)
    nominal = replace(campaign, readings=measured(campaign.cell, rows=40))
    assert not calibrate(nominal, QUICK).verdict.accepted


def test_validation_rows_judge_where_they_are_given():
    campaign, truth = rehearsed_campaign()
    rows = measured(campaign.cell, truth, rows=25, seed=77)
    result = calibrate(replace(campaign, validation=rows), QUICK)
    assert (result.validation.method, result.validation.count) == ("validation rows", 25)
    assert result.verdict.accepted
