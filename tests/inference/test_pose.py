"""Uncertainty of the tool's pose, carried from the parameters'."""

from pathlib import Path

import numpy as np
import pytest

import boresight
from boresight.inference import pose_uncertainty, spread_configurations, uncalibrated_in_words

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def result():
    return boresight.calibrate(boresight.load_campaign(EXAMPLES / "space-arm-one-plane" / "campaign.yaml"))


def test_it_is_what_sampled_parameters_do_to_the_tool(result):
    random = np.random.default_rng(0)
    joints = spread_configurations(result.cell, 20)
    told = pose_uncertainty(result.cell, result.free_names, result.covariance, joints)
    here = result.cell.poses(joints)[:, :3, 3]
    samples = random.multivariate_normal(np.zeros(len(result.free_names)), result.covariance, 3000)
    there = np.array(
        [
            result.cell.corrected(dict(zip(result.free_names, map(float, x), strict=True))).poses(joints)[:, :3, 3]
            for x in samples
        ]
    )
    sampled = np.sqrt(np.mean(np.sum((there - here) ** 2, axis=2), axis=0))
    assert np.allclose(sampled, told.position_std, rtol=0.06)
    inside = np.mean([told.holds(each - here) for each in there])
    assert inside == pytest.approx(0.95, abs=0.01)


def test_the_truth_lies_where_it_is_predicted(result):
    import json

    truth = json.loads((EXAMPLES / "space-arm-one-plane" / "truth.json").read_text())
    off = result.cell.poses(result.at_rows.joints)[:, :3, 3] - np.array(truth["validation_position"])
    assert np.mean(result.at_rows.holds(off)) > 0.8


def test_nothing_free_is_nothing_uncertain(result):
    told = pose_uncertainty(result.cell, (), np.empty((0, 0)), spread_configurations(result.cell, 5))
    assert np.all(told.position_std == 0.0)


def test_planes_do_not_move_the_tool(result):
    told = pose_uncertainty(result.cell, ("deck.offset",), np.eye(1), spread_configurations(result.cell, 5))
    assert np.all(told.position_std == 0.0)


def test_configurations_are_spread_within_the_limits(result):
    joints = spread_configurations(result.cell, 400)
    limits = result.cell.arm.limits
    assert np.all(joints >= limits[:, 0])
    assert np.all(joints <= limits[:, 1])
    unit = (joints - limits[:, 0]) / (limits[:, 1] - limits[:, 0])
    assert np.allclose(unit.mean(axis=0), 0.5, atol=0.03)
    assert np.array_equal(joints, spread_configurations(result.cell, 400))


def test_directions_that_no_reading_sees_are_named():
    flat = boresight.calibrate(boresight.load_campaign(EXAMPLES / "flat-plane" / "campaign.yaml"))
    said = uncalibrated_in_words(flat.in_workspace)
    assert "position along x and y" in said
    assert "orientation about z" in said
    assert f"Accepted in part. {said}" in flat.verdict.reasons
    assert flat.verdict.accepted_for == "partial"
