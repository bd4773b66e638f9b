"""Compensated commands sent to the true arm, in MuJoCo: its tool goes where it was asked to."""

import json
from pathlib import Path

import mujoco
import numpy as np
import pytest
from independent_arms import mjcf

import boresight
from boresight.compensation import Reached, compensate

EXAMPLES = Path(__file__).parents[2] / "examples"


def true_cell(campaign, truth):
    off = {
        f"{joint.name}.{number}": truth["true"][number][place] - getattr(joint, number)
        for place, joint in enumerate(campaign.cell.arm.joints)
        for number in ("theta", "d", "a", "alpha", "beta")
    }
    return campaign.cell.corrected(off)


def positions(cell, joints):
    """Where MuJoCo has the sensor's frame [m], and how it is turned."""
    model = mujoco.MjModel.from_xml_string(mjcf(cell))
    data = mujoco.MjData(model)
    places, turns = [], []
    for q in joints:
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)
        places.append(data.site_xpos[0].copy())
        turns.append(data.site_xmat[0].reshape(3, 3).copy())
    return np.array(places), np.array(turns)


@pytest.mark.parametrize("name", ["space-arm-one-plane", "space-arm-three-planes", "seven-axis", "gross-outliers"])
def test_the_true_tool_reaches_the_pose_to_within_the_calibrations_own_error(name):
    folder = EXAMPLES / name
    campaign = boresight.load_campaign(folder / "campaign.yaml")
    truth = json.loads((folder / "truth.json").read_text())
    result = boresight.calibrate(campaign)
    nominal, calibrated = campaign.cell.arm, result.cell.arm
    program = campaign.validation.joints
    found = compensate(nominal, calibrated, joints=program)
    there = found.reached <= Reached.NEAR_SINGULAR
    assert there.mean() >= 0.9
    real = true_cell(campaign, truth)
    measured, _ = positions(real, program)
    assert np.abs(measured - np.array(truth["validation_position"])).max() < 1e-6  # the truth is the truth
    wanted = found.poses[there][:, :3, 3]
    before = np.linalg.norm(positions(real, program[there])[0] - wanted, axis=1)
    after = np.linalg.norm(positions(real, found.joints[there])[0] - wanted, axis=1)
    own = calibrated.forward_kinematics(program)[:, :3, 3] - measured
    own_error = np.sqrt(np.mean(np.sum(own**2, axis=1)))
    assert np.sqrt(np.mean(after**2)) < 1.3 * own_error
    assert np.sqrt(np.mean(after**2)) < 0.01 * np.sqrt(np.mean(before**2))
