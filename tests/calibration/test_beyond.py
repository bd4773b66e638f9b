"""What is added to the geometry, when, and when nothing is."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import position_cell, rehearsed_campaign

from boresight.calibration import Solver, calibrate
from boresight.calibration.beyond import _folds, _tried, beyond_in_words, go_beyond
from boresight.calibration.campaign import TERMS, Campaign
from boresight.calibration.freedom import freedoms_of
from boresight.calibration.linear import neighbourhood_of
from boresight.calibration.problem import Problem
from boresight.calibration.robust import fit
from boresight.synthetic import draw_configurations, perturbed, simulated_readings

QUICK = Solver("least-squares")
WIDTHS = {"theta": 1e-3, "alpha": 1e-3, "a": 5e-4}


def wavy_campaign(rows=80, seed=0, height=3e-4, unmodelled=0.0):
    """A tracker before the paper's arm, whose joints turn by waves of these heights [rad] too."""
    cell = position_cell()
    truth = perturbed(cell, {f"{j}.{n}": w for j in cell.arm.joint_names for n, w in WIDTHS.items()}, seed)
    truth = replace(truth, arm=truth.arm.with_harmonics())
    rng = np.random.default_rng(seed)
    waves = [name for name in truth.index if name.rpartition(".")[2][:3] in ("cos", "sin")]
    truth = truth.corrected({name: float(rng.normal(0.0, height)) for name in waves})
    readings = simulated_readings(truth, *draw_configurations((cell, truth), rows, seed), seed)
    worse = rng.normal(0.0, unmodelled, readings.values.shape) if unmodelled else 0.0
    return Campaign("wavy", cell, replace(readings, values=readings.values + worse)), truth


def fitted(campaign):
    freedoms = freedoms_of(campaign, campaign.cell)
    return fit(Problem(campaign.cell, campaign.readings, freedoms), np.zeros(len(freedoms)))


def errors(cell, truth, rows=200):
    joints, _ = draw_configurations((truth,), rows, 99)
    return np.linalg.norm((cell.poses(joints) - truth.poses(joints))[:, :3, 3], axis=1)


def test_nothing_is_tried_where_nothing_is_left_to_explain():
    campaign, _ = wavy_campaign(height=0.0)
    geometry = fitted(campaign)
    assert geometry.problem.model_std == 0.0
    found, beyond = go_beyond(geometry, TERMS, True, 0)
    assert found is geometry
    assert beyond is None
    assert beyond_in_words(beyond) == ()


def test_nothing_is_tried_with_too_few_rows():
    geometry = fitted(wavy_campaign(rows=18, unmodelled=1e-3)[0])
    assert go_beyond(geometry, TERMS, True, 0) == (geometry, None)


def test_harmonics_are_found_and_bring_errors_down_to_the_noise():
    campaign, truth = wavy_campaign()
    geometry = fitted(campaign)
    found, beyond = go_beyond(geometry, TERMS, True, 0)
    assert beyond.chosen == ("harmonics",)
    before, after = (errors(each.problem.fitted(each.x), truth) for each in (geometry, found))
    assert np.sqrt(np.mean(after**2)) < 0.25 * np.sqrt(np.mean(before**2))
    assert np.sqrt(np.mean(after**2)) < campaign.cell.sensor.noise_std
    assert found.problem.model_std == 0.0
    assert beyond.used.rms_m < 0.5 * beyond.alone.rms_m


@pytest.mark.long
def test_an_arm_without_them_is_hardly_ever_given_gravity_or_harmonics():
    added = 0
    for seed in range(12):
        campaign, _ = wavy_campaign(rows=60, seed=seed, height=0.0, unmodelled=2.5e-4)
        geometry = fitted(campaign)
        assert geometry.problem.model_std > 2e-4
        trials, chosen = _tried(neighbourhood_of(geometry, TERMS, True), TERMS, seed)
        assert len(trials) == 4
        added += bool(chosen)
    assert added <= 2  # of 12; more have a chance of 2 % if each has 5 %


def test_harmonics_in_a_narrow_range_do_not_run_away():
    campaign, truth = wavy_campaign(rows=40, height=2e-4)
    joints = campaign.cell.arm.limits.mean(axis=1) + 0.25 * (
        campaign.readings.joints - campaign.cell.arm.limits.mean(1)
    )
    campaign = replace(campaign, readings=simulated_readings(truth, joints, campaign.readings.target, 0))
    geometry = fitted(campaign)
    found, _ = go_beyond(geometry, TERMS, True, 0)
    before, after = (errors(each.problem.fitted(each.x), truth) for each in (geometry, found))
    assert after.max() < 1.1 * before.max()


def test_what_the_campaign_does_not_want_is_not_tried():
    geometry = fitted(wavy_campaign()[0])
    assert go_beyond(geometry, (), True, 0) == (geometry, None)
    _, tried = go_beyond(geometry, ("harmonics",), True, 0)
    assert [trial.terms for trial in tried.trials] == [(), ("harmonics",)]


@pytest.mark.parametrize(
    ("asked", "terms"),
    [
        ({}, TERMS),
        ({"weightless": True}, ("harmonics",)),
        ({"freedoms": ()}, ()),
        ({"freedoms": (), "beyond": ("gravity",)}, ("gravity",)),
        ({"beyond": TERMS, "weightless": True}, ("harmonics",)),
    ],
)
def test_which_terms_a_campaign_may_be_given(asked, terms):
    assert Campaign("asked", position_cell(), **asked).terms == terms


def test_priors_that_the_campaign_states_are_not_learned():
    campaign, _ = rehearsed_campaign()
    wrong = replace(campaign.readings, std=campaign.readings.std / 20.0)
    result = calibrate(replace(campaign, readings=wrong, beyond=TERMS), QUICK)
    assert result.beyond is not None
    assert not {"angles", "lengths"} & set(result.beyond.learned)


def test_rows_of_one_configuration_are_left_out_together():
    joints = np.random.default_rng(1).uniform(-1.0, 1.0, (30, 4))
    fold = _folds(np.concatenate([joints, joints[::-1]]), 0, 0)
    np.testing.assert_array_equal(fold[:30], fold[:29:-1])
    assert len(set(fold.tolist())) == 10


def test_the_neighbourhood_predicts_small_steps_of_everything():
    campaign, _ = wavy_campaign(rows=40)
    geometry = fitted(campaign)
    near = neighbourhood_of(geometry, TERMS, True)
    step = np.random.default_rng(2).normal(0.0, 1e-6, len(near.names))
    corrections = np.zeros(len(near.cell.parameters))
    corrections[[near.cell.index[name] for name in near.names]] = near.at + step
    readings = geometry.problem.readings.chosen(geometry.kept)
    left = (readings.values - near.cell.predict(readings.joints, readings.target, corrections)) / near.std
    np.testing.assert_allclose(near.left - near.jacobian @ step, left, rtol=0, atol=1e-6)


def test_the_result_says_what_each_addition_bought():
    result = calibrate(wavy_campaign()[0], QUICK)
    note = next(note for note in result.notes if note.startswith("Beyond geometry"))
    assert "Harmonics used." in note
    assert "gravity and harmonics" in note
    names = [estimate.name for estimate in result.estimates]
    assert "j2.cos1" in names
    assert not any(".sag" in name for name in names)
    assert result.verdict.accepted
