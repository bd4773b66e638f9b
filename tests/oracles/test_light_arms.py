"""Gravity on arms that give way, in MuJoCo: found, and taken out of the error down to the tracker's own."""

import json
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from light_arms import Weights, light_campaign, settled, weighed_model

import boresight
from boresight.arm import catalogue
from boresight.calibration import Solver, calibrate
from boresight.geometry import Frame
from boresight.sensing import Cell, Position

QUICK = Solver("least-squares")


def held_out_mm(cell, campaign):
    rows = campaign.validation
    off = np.linalg.norm(cell.predict(rows.joints, rows.target) - rows.values, axis=1)
    return 1e3 * float(np.sqrt(np.mean(off**2)))


def test_moments_of_unit_weights_equal_mujocos():
    """A kilogram at one link's end after the other, under 1 m/s², from a direction of no meaning."""
    cell = Cell(catalogue.load("puma560"), Position(1e-4))
    down = np.array([0.48, -0.6, -0.64])
    arm = replace(cell.arm, gravity=tuple(map(float, down))).with_sag()
    joints = np.random.default_rng(3).uniform(-2.0, 2.0, (4, 6))
    moments = arm.chain.levers.moments(joints)
    stiffness = np.full(6, 1e6)
    for link in range(5):
        centres = np.zeros((6, 3))
        centres[link] = (cell.arm.joints[link].a, 0.0, cell.arm.joints[link].d)
        masses = np.where(np.arange(6) == link, 1.0, 1e-9)
        turned = settled_turns(cell, Weights(masses, centres, stiffness, down), joints) * stiffness
        np.testing.assert_allclose(moments[:, :, link], turned, rtol=0, atol=5e-6)


def settled_turns(cell, weights, joints):
    """How far each joint gives way in MuJoCo [rad]: from the torques that hold the arm where it was commanded to be."""
    model = weighed_model(cell, weights)
    model.body_inertia[:] = 1e-9
    data, turns = mujoco.MjData(model), []
    for row in joints:
        data.qpos[:] = row
        mujoco.mj_forward(model, data)
        turns.append(-data.qfrc_bias / weights.stiffness)
    return np.array(turns)


@pytest.fixture(scope="module")
def light():
    """An iiwa and a tracker, neither of whose places is known, and the result."""
    campaign = light_campaign("iiwa14", rows=60, weight=0.165, seed=1)
    return campaign, calibrate(campaign, QUICK)


@pytest.mark.long
def test_gravity_is_found_on_a_light_arm_and_errors_fall_to_the_trackers(light):
    campaign, result = light
    geometry = calibrate(replace(campaign, beyond=()), QUICK)
    assert result.beyond.chosen == ("gravity",)
    assert held_out_mm(geometry.cell, campaign) == pytest.approx(0.26, abs=0.02)
    noise = 1e3 * np.sqrt(3.0) * campaign.cell.sensor.noise_std
    assert held_out_mm(result.cell, campaign) < 1.15 * noise
    assert result.model_std == 0.0
    assert result.verdict.accepted


@pytest.mark.long
def test_the_written_robot_bends_as_the_identified_one(light, tmp_path):
    campaign, result = light
    folder = boresight.write_result(result, tmp_path / "result", boresight.__version__)
    again = boresight.load_robot(folder / "robot-calibrated.yaml")
    joints = campaign.validation.joints
    assert any(joint.sag for joint in again.joints)
    off = again.forward_kinematics(joints) - result.cell.arm.forward_kinematics(joints)
    assert np.abs(off).max() <= 1e-12
    document = json.loads((folder / "result.json").read_text())
    assert document["beyond_geometry"]["used"] == ["gravity"]
    assert [trial["terms"] for trial in document["beyond_geometry"]["trials"]][:2] == [[], ["gravity"]]
    assert "geometry + gravity" in (folder / "report.html").read_text()


@pytest.mark.long
def test_an_arm_on_a_wall_needs_to_be_told_where_gravity_points():
    campaign = light_campaign("panda", rows=80, weight=0.3, seed=4, down=(0.0, -0.8, -0.6))
    told, untold = (
        calibrate(replace(campaign, gravity=gravity, beyond=("gravity",)), QUICK).cell
        for gravity in ((0.0, -0.8, -0.6), None)
    )
    assert held_out_mm(told, campaign) < 0.1
    assert held_out_mm(told, campaign) < 0.7 * held_out_mm(untold, campaign)


@pytest.mark.long
def test_a_ranger_finds_gravity_too():
    campaign = light_campaign("puma560", rows=100, weight=0.2, seed=2, ranger=True)
    result = calibrate(campaign, QUICK)
    assert result.beyond.chosen == ("gravity",)
    assert held_out_mm(result.cell, campaign) < 1.3e3 * campaign.cell.sensor.noise_std


def test_nothing_is_tried_on_an_arm_without_weight():
    campaign = light_campaign("ur10", rows=60, held=10, weight=0.0)
    result = calibrate(campaign, QUICK)
    assert result.beyond is None
    assert not any(".sag" in estimate.name or ".cos" in estimate.name for estimate in result.estimates)


def test_where_springs_and_weights_balance_a_level_arm_hangs_lower():
    cell = Cell(catalogue.load("ur10"), Position(1e-4), Frame())
    weights = Weights.drawn(np.random.default_rng(0), cell)
    out = np.zeros((1, 6))
    hanging = settled(cell, weights, out)[0, 2, 3]
    assert -0.05 < hanging - cell.poses(out)[0, 2, 3] < -1e-4
