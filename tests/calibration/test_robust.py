"""Gross errors: found, left out, and without a say; clean rows lose nothing."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rehearsed import rehearsed_campaign

import boresight
from boresight.calibration.problem import Problem
from boresight.calibration.robust import fit, refine, threshold
from boresight.calibration.solve import Solver

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def campaign():
    return boresight.load_campaign(EXAMPLES / "space-arm-one-plane" / "campaign.yaml")


def test_few_clean_rows_are_all_believed():
    """35 rows for 23 parameters, nominal errors of full size: weighing before fitting ended far away here."""
    campaign, truth = rehearsed_campaign(planes=1, rows=35, seed=29, size=1.0)
    problem = Problem(campaign.cell, campaign.readings, campaign.freedoms)
    true = np.array([truth.values[name] - campaign.cell.values[name] for name in problem.names])
    robust = fit(problem, np.zeros(len(problem.names)))
    assert robust.kept.all()
    assert robust.problem.model_std == 0.0
    assert np.allclose(robust.x, refine(problem, true).best, atol=1e-7)


@pytest.mark.parametrize("seed", range(4))
def test_gross_errors_among_few_readings_are_found(seed):
    campaign, _ = rehearsed_campaign(planes=3, rows=35, seed=seed, size=1.0)
    dirty, planted = spoiled(campaign, 0.08, seed)
    robust = fit(Problem(dirty.cell, dirty.readings, dirty.freedoms), np.zeros(len(dirty.freedoms)))
    assert set(np.flatnonzero(~robust.kept)) == planted
    assert robust.problem.model_std == 0.0


def test_gross_errors_that_few_readings_cannot_tell_are_rejected_with_the_cause_first():
    campaign, _ = rehearsed_campaign(planes=1, rows=30, seed=0, size=1.0)
    result = boresight.calibrate(spoiled(campaign, 0.4, 0)[0], Solver("least-squares"))
    assert not result.verdict.accepted
    assert "something else is wrong" in result.verdict.reasons[0]


def spoiled(campaign, share, seed):
    """The campaign with gross errors of 20 to 400 mm in a share of its rows, and which rows."""
    random = np.random.default_rng(seed)
    values = campaign.readings.values.copy()
    rows = random.choice(len(values), int(share * len(values)), replace=False)
    values[rows, 0] += random.choice([-1, 1], len(rows)) * random.uniform(0.02, 0.4, len(rows))
    return replace(campaign, readings=replace(campaign.readings, values=values)), set(rows.tolist())


def test_clean_rows_are_all_kept_and_fitted_as_least_squares_does(campaign):
    problem = Problem(campaign.cell, campaign.readings, boresight.calibrate(campaign).solution.fit.problem.freedoms)
    start = np.zeros(len(problem.names))
    robust = fit(problem, start)
    assert robust.kept.all()
    assert robust.problem.model_std == 0.0
    assert np.allclose(robust.x, refine(problem, start).best, atol=1e-9)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("share", [0.01, 0.08, 0.25])
def test_gross_errors_are_found_and_change_little(campaign, share, seed):
    clean = boresight.calibrate(campaign)
    dirty, planted = spoiled(campaign, share, seed)
    result = boresight.calibrate(dirty)
    lines = {int(campaign.readings.line[row]) for row in planted}
    assert {outlier.line for outlier in result.outliers} == lines
    poses = [each.cell.poses(campaign.validation.joints)[:, :3, 3] for each in (clean, result)]
    assert np.sqrt(np.mean(np.sum((poses[0] - poses[1]) ** 2, axis=1))) < 1e-4


def test_many_gross_errors_come_with_a_warning(campaign):
    assert not boresight.calibrate(spoiled(campaign, 0.08, 0)[0]).warnings
    assert any(
        "do not fit with the others" in said for said in boresight.calibrate(spoiled(campaign, 0.2, 0)[0]).warnings
    )


def test_an_outlier_says_by_how_much_it_is_off(campaign):
    values = campaign.readings.values.copy()
    values[7, 0] += 0.123
    result = boresight.calibrate(replace(campaign, readings=replace(campaign.readings, values=values)))
    (outlier,) = result.outliers
    assert outlier.line == campaign.readings.line[7]
    assert outlier.residual_m == pytest.approx(0.123, abs=5e-4)
    assert outlier.ratio > 1000


def test_errors_of_the_model_are_no_outliers():
    """A real arm bends: its residuals are many times the tracker's noise, and nearly every row is kept."""
    result = boresight.calibrate(
        boresight.load_campaign(EXAMPLES / "ur10-laser-tracker" / "campaign.yaml"), Solver("least-squares")
    )
    assert len(result.outliers) <= 0.01 * len(result.readings)
    assert result.model_std == pytest.approx(0.28e-3, rel=0.1)


def test_evolution_alone_finds_gross_errors_too(campaign):
    dirty, planted = spoiled(campaign, 0.08, 1)
    result = boresight.calibrate(dirty, Solver("evolution"))
    assert {outlier.line for outlier in result.outliers} == {int(campaign.readings.line[row]) for row in planted}


def test_chance_alone_exceeds_the_threshold_once_in_a_million():
    random = np.random.default_rng(0)
    for channels in (1, 3):
        sizes = np.sqrt(np.mean(random.normal(size=(2_000_000, channels)) ** 2, axis=1))
        assert np.count_nonzero(sizes > threshold(channels)) <= 12
        assert np.count_nonzero(sizes > 0.8 * threshold(channels)) > 20
