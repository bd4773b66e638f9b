"""A palletiser whose level joint mimics its lift, from URDF to calibrated URDF, which moves as the truth does."""

from pathlib import Path

import numpy as np
import pytest

from boresight.calibration import Campaign, Solver, calibrate, simulate
from boresight.files.sources import Source
from boresight.files.splicing import calibrated_urdf
from boresight.files.urdf import robot_file_of
from boresight.sensing import Cell, Position
from published_urdfs import pinocchio_poses

NOISE_M = 1e-4


def joint(name, kind, parent, child, origin, axis="", more=""):
    """Returns a joint's text."""
    axis = (
        f'<axis xyz="{axis}"/><limit lower="{0 if kind == "prismatic" else -1}" upper="0.5" effort="1" velocity="1"/>'
    )
    return (
        f'<joint name="{name}" type="{kind}"><origin {origin}/><parent link="{parent}"/><child link="{child}"/>'
        f"{axis if kind != 'fixed' else ''}{more}</joint>"
    )


URDF = (
    '<robot name="palletiser">'
    + "".join(f'<link name="{link}"/>' for link in ("base", "a", "b", "c", "d", "e", "tool"))
    + joint("turn", "revolute", "base", "a", 'xyz="0 0 0.4"', "0 0 1")
    + joint("lift", "revolute", "a", "b", 'xyz="0.1 0 0"', "0 1 0")
    + joint(
        "level", "revolute", "b", "c", 'xyz="0 0 0.6"', "0 1 0", '<mimic joint="lift" multiplier="-1" offset="0.3"/>'
    )
    + joint("reach", "prismatic", "c", "d", 'xyz="0.3 0 0"', "1 0 0")
    + joint("wrist", "revolute", "d", "e", 'xyz="0.1 0 0" rpy="0.4 0 0"', "0 0 1")
    + joint("end", "fixed", "e", "tool", 'xyz="0.1 0.05 -0.1" rpy="0.3 0 0"')
    + "</robot>"
)


@pytest.mark.parametrize("seed", [0, 1])
def test_a_palletiser_is_found_and_its_urdf_moves_as_the_truth(seed):
    robot = robot_file_of(Source(Path("arm.urdf"), "arm.urdf", URDF.encode()))
    arm = robot.chain.arm
    assert arm.joint_names == ("turn", "lift", "reach", "wrist")
    campaign = Campaign("palletiser", Cell(arm, Position(NOISE_M)), robot_file=robot)
    rehearsal = simulate(campaign, rows=100, validation_rows=30, seed=seed)
    measured = Campaign("palletiser", campaign.cell, rehearsal.readings, rehearsal.validation, robot_file=robot)
    result = calibrate(measured, Solver("least-squares"))
    assert result.verdict.accepted
    assert result.validation.before.rms > 3e-3
    # the truth moves every candidate, the fit only the independent ones: they agree to second order
    assert result.calibration.after.rms < 1.1 * NOISE_M * np.sqrt(3)
    joints = rehearsal.validation.joints
    urdf = calibrated_urdf(robot, result.nominal.arm, result.cell.arm)
    theirs = pinocchio_poses(urdf, robot.chain, joints)
    np.testing.assert_allclose(result.cell.arm.forward_kinematics(joints), theirs, rtol=0, atol=1e-12)
    off = theirs[:, :3, 3] - rehearsal.truth.poses(joints)[:, :3, 3]
    assert np.sqrt(np.mean(np.sum(off**2, axis=1))) < 1.5e-4
