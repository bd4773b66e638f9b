"""Chains of joints: corrections become origins, and only those that have to change do."""

import math

import numpy as np
import pytest

from boresight.arm import LINK_NUMBERS
from boresight.arm.serial import SerialChain, SerialJoint, chain_of, corrected_chain
from boresight.geometry import Frame
from random_cells import random_arm, random_frame

QUARTER = math.pi / 2

CHAIN = SerialChain(
    "bent",
    "base",
    "tool",
    (
        SerialJoint("plinth", "fixed", Frame((0.0, 0.1, 0.2), (0.1, 0.0, 0.0))),
        SerialJoint("a", "revolute", Frame((0.0, 0.0, 0.3)), (0.0, 0.0, -1.0)),
        SerialJoint("b", "revolute", Frame((0.1, 0.0, 0.2), (0.0, QUARTER, 0.0)), (0.0, 1.0, 0.0)),
        SerialJoint("spacer", "fixed", Frame((0.0, 0.0, 0.05), (0.0, 0.0, 0.4))),
        SerialJoint("c", "prismatic", Frame((0.0, 0.0, 0.4)), (0.6, 0.0, 0.8), (0.0, 0.3)),
        SerialJoint("d", "revolute", Frame((0.2, 0.0, 0.0)), (1.0, 0.0, 0.0), follows="b", ratio=-1.5, offset=0.7),
        SerialJoint("e", "revolute", Frame((0.0, 0.0, 0.3), (0.3, 0.0, 0.0)), (0.0, 1.0, 0.0)),
        SerialJoint("flange", "fixed", Frame((0.0, 0.1, 0.0))),
        SerialJoint("mount", "fixed", Frame((0.05, 0.0, 0.0), (0.5, 0.0, 0.0))),
    ),
)


def readings(count=10):
    return np.random.default_rng(4).uniform(-2.0, 2.0, (count, 4))


def step_by_step(chain, row):
    """Multiplies up origins and motions by Rodrigues' formula, knowing nothing of links."""
    names = [joint.name for joint in chain.moving if joint.follows is None]
    value, T = dict(zip(names, row, strict=True)), np.eye(4)
    for joint in chain.joints:
        T = T @ joint.origin.matrix
        if joint.type == "fixed":
            continue
        q = joint.ratio * value[joint.follows] + joint.offset if joint.follows else value[joint.name]
        motion, (x, y, z) = np.eye(4), joint.axis
        if joint.type == "prismatic":
            motion[:3, 3] = q * np.array(joint.axis)
        else:
            K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            motion[:3, :3] += np.sin(q) * K + (1 - np.cos(q)) * K @ K
        T = T @ motion
    return T


def test_a_chain_moves_as_its_joints_say():
    expected = [step_by_step(CHAIN, row) for row in readings()]
    np.testing.assert_allclose(CHAIN.screws.forward_kinematics(readings()), expected, rtol=0, atol=1e-14)
    np.testing.assert_allclose(CHAIN.arm.forward_kinematics(readings()), expected, rtol=0, atol=1e-14)


@pytest.mark.parametrize("seed", range(10))
def test_any_corrections_become_origins_that_move_the_same(seed):
    random = np.random.default_rng(seed)
    arm = CHAIN.arm
    corrections = {
        f"{joint.name}.{n}": float(random.uniform(-0.02, 0.02))
        for joint in arm.joints
        for n in LINK_NUMBERS
        if random.random() < 0.5
    }
    identified = arm.corrected(corrections)
    new = corrected_chain(CHAIN, arm, identified)
    expected = [step_by_step(new, row) for row in readings()]
    np.testing.assert_allclose(identified.forward_kinematics(readings()), expected, rtol=0, atol=1e-13)
    for was, now in zip(CHAIN.joints, new.joints, strict=True):
        assert now.placed(was.origin) == was
        # small corrections, small changes: no frame runs off along its axis
        assert np.abs(np.subtract(now.origin.xyz, was.origin.xyz)).max() < 0.1
        if was.type == "fixed" and was.name != "mount":
            assert now is was


@pytest.mark.parametrize(
    ("parameter", "joint"),
    [
        ("a.theta", "a"), ("a.d", "a"), ("a.alpha", "b"), ("a.a", "b"), ("b.theta", "b"), ("b.beta", "c"),
        ("c.d", "c"), ("d.theta", "d"), ("d.alpha", "e"), ("e.theta", "e"), ("e.d", "e"), ("e.alpha", "mount"),
    ],
)  # fmt: skip
def test_a_parameter_changes_one_origin(parameter, joint):
    arm = CHAIN.arm
    new = corrected_chain(CHAIN, arm, arm.corrected({parameter: 0.01}))
    assert [now.name for was, now in zip(CHAIN.joints, new.joints, strict=True) if now is not was] == [joint]


def test_a_zero_offset_turns_its_own_joint_about_its_own_axis():
    arm = CHAIN.arm
    (_, a, *_), (_, was, *_) = corrected_chain(CHAIN, arm, arm.corrected({"a.theta": 0.01})).joints, CHAIN.joints
    assert a.origin.xyz == was.origin.xyz
    assert a.origin.rpy == pytest.approx((0.0, 0.0, -0.01), abs=1e-15)


def test_no_correction_changes_nothing():
    assert corrected_chain(CHAIN, CHAIN.arm, CHAIN.arm).joints == CHAIN.joints


def test_a_right_angle_of_pitch_is_left_exactly():
    """Where roll and yaw turn about one line they are uncertain, and must make up for each other."""
    arm = CHAIN.arm
    for size in (1e-3, 1e-6, 1e-9, 1e-12):
        identified = arm.corrected({"a.alpha": size, "a.beta": -size, "b.theta": size})
        new = corrected_chain(CHAIN, arm, identified)
        expected = [step_by_step(new, row) for row in readings()]
        np.testing.assert_allclose(identified.forward_kinematics(readings()), expected, rtol=0, atol=1e-13)


def test_the_tips_correction_needs_a_joint_to_hold_it():
    chain = SerialChain("bare", "base", "flange", CHAIN.joints[:-2])
    arm = chain.arm
    assert not chain.ends_with_a_fixed_joint
    corrected_chain(chain, arm, arm.corrected({"e.theta": 0.01, "e.d": 0.01}))
    with pytest.raises(AssertionError, match="no joint behind the last moving one"):
        corrected_chain(chain, arm, arm.corrected({"e.alpha": 0.01}))


@pytest.mark.parametrize("seed", range(5))
def test_a_table_becomes_a_chain_that_moves_the_same(seed):
    random = np.random.default_rng(seed)
    drawn = random_arm(random, 5, "standard-dh")
    arm = type(drawn)(drawn.name, drawn.joints, "standard-dh", random_frame(random), random_frame(random))
    chain = chain_of(arm)
    q = random.uniform(-2.0, 2.0, (5, 5))
    expected = [step_by_step(chain, row) for row in q]
    np.testing.assert_allclose(arm.forward_kinematics(q), expected, rtol=0, atol=1e-14)
