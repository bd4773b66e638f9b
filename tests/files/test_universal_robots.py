"""Universal Robots' two formats: what a driver or controller would make of them moves as the identified arm does."""

import ast
import math
import re

import numpy as np
import pinocchio as pin
import pytest
import yaml_free

from boresight.arm import LINK_NUMBERS, Arm, Joint, catalogue
from boresight.arm.common_normals import standard_dh
from boresight.arm.screws import screws_of
from boresight.errors import InputError
from boresight.files.universal_robots import (
    LINKS,
    calibration_conf,
    is_universal,
    kinematics_yaml,
    universal_blocks,
    universal_chain,
)
from boresight.files.urdf import read_urdf
from factory_arms import FACTORY, factory_arm
from published_urdfs import ARMS, path_of

JOINTS = np.random.default_rng(5).uniform(-math.pi, math.pi, (50, 6))


def ur10_urdf():
    package, path, *_ = ARMS["ur10"]
    return path_of(package, path)


def corrections(arm, seed=1, numbers=("theta", "d", "a", "alpha", "beta"), last=("theta", "d")):
    random = np.random.default_rng(seed)
    return {
        f"{joint.name}.{n}": float(random.uniform(-0.003, 0.003))
        for joint in arm.joints
        for n in (last if joint is arm.joints[-1] else numbers)
    }


def drivers_poses(text):
    """Returns the poses of six joints about z at the transforms of a kinematics file, as pinocchio has them."""
    blocks = yaml_free.kinematics(text)
    model = pin.Model()
    for number, name in enumerate(LINKS):
        x, y, z, roll, pitch, yaw = (blocks[name][key] for key in ("x", "y", "z", "roll", "pitch", "yaw"))
        place = pin.SE3(pin.rpy.rpyToMatrix(roll, pitch, yaw), np.array([x, y, z]))
        model.addJoint(number, pin.JointModelRZ(), place, name)
    data, poses = model.createData(), []
    for row in JOINTS:
        pin.forwardKinematics(model, data, row)
        poses.append(data.oMi[6].homogeneous)
    return np.array(poses)


def controllers_poses(nominal, conf):
    """Returns the poses of nominal D-H numbers with a file's deltas added."""
    deltas = {key: ast.literal_eval(values) for key, values in re.findall(r"^delta_(\w+) = (\[.*\])$", conf, re.M)}
    joints = tuple(
        Joint(j.name, **{n: getattr(j, n) + (deltas[n][k] if n in deltas else 0.0) for n in LINK_NUMBERS})
        for k, j in enumerate(nominal.joints)
    )
    return Arm("controller", joints).forward_kinematics(JOINTS)


def test_the_nominal_ur10_has_the_numbers_of_its_makers_description():
    """ur_description/config/ur10/default_kinematics.yaml, but for what its angles are short of pi and pi / 2."""
    arm = catalogue.load("ur10")
    blocks, notes = universal_blocks(universal_chain(arm, arm))
    published = {
        "shoulder": ((0, 0, 0.1273), (0, 0, 0)),
        "upper_arm": ((0, 0, 0), (math.pi / 2, 0, 0)),
        "forearm": ((-0.612, 0, 0), (0, 0, 0)),
        "wrist_1": ((-0.5723, 0, 0.163941), (0, 0, 0)),
        "wrist_2": ((0, -0.1157, 0), (math.pi / 2, 0, 0)),
        "wrist_3": ((0, 0.0922, 0), (math.pi / 2, math.pi, math.pi)),
    }
    assert notes == ()
    for name, (xyz, rpy) in published.items():
        assert blocks[name].xyz == pytest.approx(xyz, abs=1e-12)
        theirs = pin.rpy.rpyToMatrix(*map(float, rpy))
        np.testing.assert_allclose(blocks[name].matrix[:3, :3], theirs, rtol=0, atol=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_a_driver_moves_as_the_identified_arm(seed):
    arm = catalogue.load("ur10")
    identified = arm.corrected(corrections(arm, seed))
    blocks, notes = universal_blocks(universal_chain(arm, identified))
    text = kinematics_yaml(blocks, "a comment", notes)
    np.testing.assert_allclose(drivers_poses(text), identified.forward_kinematics(JOINTS), rtol=0, atol=1e-12)
    assert notes == ()
    assert re.search(r"^  hash: calib_\d+$", text, re.M)
    assert "fixed axes, R = Rz(yaw) Ry(pitch)" in text


def test_the_base_link_of_ros_is_turned_into_the_base_of_ur():
    """The same arm from its URDF, whose base link is half a turn round and whose axes lie along y."""
    package, path, _, _ = ARMS["ur10"]
    arm = read_urdf(path_of(package, path), base="base_link", tip="tool0").chain.arm
    table = catalogue.load("ur10")
    assert is_universal(arm)
    np.testing.assert_allclose(
        drivers_poses(kinematics_yaml(universal_blocks(universal_chain(arm, arm))[0], "")),
        table.forward_kinematics(JOINTS),
        rtol=0,
        atol=1e-9,  # the URDF's pi has twelve digits
    )
    wrong = {"shoulder_lift_joint.theta": 0.01, "elbow_joint.a": 0.002, "wrist_1_joint.alpha": 0.003}
    ours = arm.corrected(wrong)
    moved = drivers_poses(kinematics_yaml(universal_blocks(universal_chain(arm, ours))[0], ""))
    T = moved @ np.linalg.inv(ours.forward_kinematics(JOINTS))
    np.testing.assert_allclose(T, np.broadcast_to(T[0], T.shape), rtol=0, atol=1e-9)
    np.testing.assert_allclose(T[0], np.diag([-1.0, -1.0, 1.0, 1.0]), rtol=0, atol=1e-9)


def test_what_lies_behind_the_last_joint_is_said():
    arm = catalogue.load("ur10")
    _, (note,) = universal_blocks(universal_chain(arm, arm.corrected({"wrist_3_joint.a": 0.001})))
    assert note == (
        "This format ends at the last joint. Behind it the tool stands at xyz 0.001 0 0 (m), rpy 0 0 0 (rad): add that "
        "to the tool's own transform."
    )


@pytest.mark.parametrize("seed", range(5))
def test_a_controller_moves_as_the_identified_arm(seed):
    """Beta and nearly parallel axes included: without beta, d runs to hundreds of metres and cancels."""
    arm = catalogue.load("ur10")
    identified = arm.corrected(corrections(arm, seed, last=("theta", "d", "a", "alpha")))
    conf = calibration_conf(universal_chain(arm, identified), "a comment")
    moved = controllers_poses(arm, conf)
    np.testing.assert_allclose(moved, identified.forward_kinematics(JOINTS), rtol=0, atol=1e-9)
    assert "delta_beta" not in conf


@pytest.mark.parametrize("name", FACTORY)
def test_a_factory_calibration_survives_the_way_through_beta(name):
    factory = factory_arm(name)
    nominal = factory_arm(name, nominal=True)
    hayati = standard_dh(screws_of(factory))
    np.testing.assert_allclose(
        controllers_poses(nominal, calibration_conf(universal_chain(nominal, hayati_like(nominal, hayati)), "")),
        factory.forward_kinematics(JOINTS),
        rtol=0,
        atol=1e-9,
    )


def hayati_like(nominal, hayati):
    """The same numbers on the nominal root and tip, which they only miss by rounding."""
    assert np.abs(hayati.root.matrix - np.eye(4)).max() < 1e-12
    assert np.abs(hayati.tip.matrix - np.eye(4)).max() < 1e-9
    return Arm(nominal.name, hayati.joints)


def test_parallel_axes_that_stay_so_have_no_large_deltas():
    arm = catalogue.load("ur10")
    wrong = {"elbow_joint.a": 0.001, "shoulder_lift_joint.theta": 0.002, "wrist_2_joint.alpha": 0.001}
    conf = calibration_conf(universal_chain(arm, arm.corrected(wrong)), "")
    assert "cancel" not in conf
    assert "delta_a = [ 0.0, 0.0, 0.00" in conf


def test_axes_too_nearly_parallel_for_a_table_without_beta_are_refused():
    arm = catalogue.load("ur10")
    with pytest.raises(InputError, match=r"within 1e-09 rad of parallel, and their common normal is too far away"):
        calibration_conf(universal_chain(arm, arm.corrected({"elbow_joint.beta": 1e-9})), "")


def test_a_tool_that_no_table_leads_to_is_refused():
    arm = catalogue.load("ur10")
    with pytest.raises(InputError, match=r"cannot hold this arm: its poses would be off by 0\.00"):
        calibration_conf(universal_chain(arm, arm.corrected({"wrist_3_joint.beta": 0.003})), "")


def test_seven_axes_are_refused():
    arm = catalogue.load("panda")
    with pytest.raises(InputError, match=r"panda: this format is of six revolute joints; export to urdf, dh or json"):
        universal_chain(arm, arm)
