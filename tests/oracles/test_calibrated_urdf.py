"""The calibrated URDF of the shipped campaign: pinocchio and MuJoCo move it as the identified model moves."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

import boresight
from published_urdfs import pinocchio_poses

EXAMPLE = Path(__file__).parents[2] / "examples" / "urdf-arm"
EXACT_M = 1e-9


@pytest.fixture(scope="module")
def calibrated(tmp_path_factory):
    """Returns the campaign, its result, and the URDF in the result's folder."""
    folder = tmp_path_factory.mktemp("urdf") / "result"
    campaign = boresight.load_campaign(EXAMPLE / "campaign.yaml")
    result = boresight.calibrate(campaign, boresight.Solver("least-squares"))
    boresight.write_result(result, folder, "test")
    return campaign, result, (folder / "robot-calibrated.urdf").read_bytes()


@pytest.fixture(scope="module")
def joints():
    return np.random.default_rng(0).uniform(-np.pi, np.pi, (200, 6))


def mujoco_poses(urdf: bytes, tip: str, names, joints):
    """Returns `T_world_tip` as MuJoCo has it."""
    spec = mujoco.MjSpec.from_string(urdf.decode())
    spec.compiler.fusestatic = False
    for body in spec.bodies[1:]:
        body.explicitinertial, body.mass, body.inertia = True, 1.0, [1.0, 1.0, 1.0]
    model = spec.compile()
    data, body = mujoco.MjData(model), model.body(tip).id
    places = [model.joint(name).qposadr[0] for name in names]
    poses = np.tile(np.eye(4), (len(joints), 1, 1))
    for pose, row in zip(poses, joints, strict=True):
        data.qpos[places] = row
        mujoco.mj_kinematics(model, data)
        pose[:3, :3], pose[:3, 3] = data.xmat[body].reshape(3, 3), data.xpos[body]
    return poses


def test_pinocchio_moves_it_as_the_identified_model(calibrated, joints):
    campaign, result, urdf = calibrated
    theirs = pinocchio_poses(urdf, campaign.robot_file.chain, joints)
    np.testing.assert_allclose(result.cell.arm.forward_kinematics(joints), theirs, rtol=0, atol=EXACT_M)


def test_mujoco_moves_it_as_the_identified_model(calibrated, joints):
    campaign, result, urdf = calibrated
    theirs = mujoco_poses(urdf, "ranger", campaign.cell.arm.joint_names, joints)
    np.testing.assert_allclose(result.cell.arm.forward_kinematics(joints), theirs, rtol=0, atol=EXACT_M)


def test_nothing_but_numbers_of_origins_on_the_chain_is_new(calibrated):
    _, _, urdf = calibrated
    before = (EXAMPLE / "arm.urdf").read_text()
    changed = {line for line in before.splitlines() if line not in urdf.decode().splitlines()}
    assert 5 <= len(changed) <= 7
    assert all(line.strip().startswith("<origin ") for line in changed)
    kept = {line for line in before.splitlines() if "<origin" not in line}
    assert kept <= set(urdf.decode().splitlines())


def test_the_first_axis_stays_where_the_base_holds_it(calibrated):
    _, result, _ = calibrated
    assert result.cell.arm.root == result.nominal.arm.root
