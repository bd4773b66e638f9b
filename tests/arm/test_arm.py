import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boresight.arm import Arm, Joint
from random_cells import CONVENTIONS, random_arm, random_joints

seeds = st.integers(0, 2**32 - 1)


def link(joint, q):
    """Equation (1) written out as matrices: Rz(q + theta) Tz(d) Tx(a) Rx(alpha) Ry(beta)."""
    theta = joint.theta + (q if joint.type == "revolute" else 0.0)
    d = joint.d + (q if joint.type == "prismatic" else 0.0)
    c, s = np.cos, np.sin
    Rz = np.array([[c(theta), -s(theta), 0, 0], [s(theta), c(theta), 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    al, be = joint.alpha, joint.beta
    Rx = np.array([[1, 0, 0, 0], [0, c(al), -s(al), 0], [0, s(al), c(al), 0], [0, 0, 0, 1]])
    Ry = np.array([[c(be), 0, s(be), 0], [0, 1, 0, 0], [-s(be), 0, c(be), 0], [0, 0, 0, 1]])
    Tz, Tx = np.eye(4), np.eye(4)
    Tz[2, 3], Tx[0, 3] = d, joint.a
    return Rz, Tz, Tx, Rx, Ry


@pytest.mark.parametrize("convention", CONVENTIONS)
@given(seed=seeds)
def test_tool_pose_is_the_product_of_the_links(convention, seed):
    rng = np.random.default_rng(seed)
    arm = random_arm(rng, convention=convention)
    joints = random_joints(rng, arm, 1)
    expected = np.eye(4)
    for joint, q in zip(arm.joints, joints[0], strict=True):
        factors = link(joint, q)
        for factor in factors if convention == "standard-dh" else reversed(factors):
            expected = expected @ factor
    np.testing.assert_allclose(arm.forward_kinematics(joints)[0], expected, rtol=0, atol=1e-13)


@given(seeds)
def test_poses_of_a_batch_equal_a_loop(seed):
    rng = np.random.default_rng(seed)
    arm = random_arm(rng)
    joints = random_joints(rng, arm, 5)
    batch = arm.forward_kinematics(joints)
    for row in range(5):
        np.testing.assert_array_equal(arm.forward_kinematics(joints[row : row + 1])[0], batch[row])
    assert arm.forward_kinematics(joints[:0]).shape == (0, 4, 4)


@given(seeds)
def test_corrected_arm_equals_corrections_handed_to_its_chain(seed):
    rng = np.random.default_rng(seed)
    arm = random_arm(rng)
    joints = random_joints(rng, arm, 4)
    corrections = rng.uniform(-0.3, 0.3, len(arm.chain.parameters))
    by_name = {name: float(c) for name, c in zip(arm.chain.parameters, corrections, strict=True)}
    expected = arm.chain.poses(joints, corrections)
    np.testing.assert_allclose(arm.corrected(by_name).forward_kinematics(joints), expected, rtol=0, atol=1e-14)
    np.testing.assert_allclose(arm.chain.corrected(by_name).poses(joints), expected, rtol=0, atol=1e-14)
    motion = arm.chain.linearise(joints, corrections)
    np.testing.assert_array_equal(motion.poses, expected)
    np.testing.assert_allclose(motion.twists, arm.corrected(by_name).chain.linearise(joints).twists, atol=1e-14)


def test_corrections_of_other_things_leave_the_arm_alone():
    arm = Arm("one", (Joint("j1", d=0.5),))
    assert arm.corrected({"deck.offset": 1.0, "j2.d": 1.0}) == arm


def test_reach_is_never_exceeded():
    for seed in range(30):
        rng = np.random.default_rng(seed)
        arm = random_arm(rng)
        poses = arm.forward_kinematics(random_joints(rng, arm, 50))
        assert np.max(np.linalg.norm(poses[:, :3, 3], axis=1)) <= arm.reach + 1e-12


def test_prismatic_joint_slides_along_z_and_revolute_turns_about_it():
    slide = Arm("slide", (Joint("j1", "prismatic", d=0.1),)).forward_kinematics(np.array([[0.2]]))[0]
    np.testing.assert_allclose(slide[:3, 3], [0.0, 0.0, 0.3])
    turn = Arm("turn", (Joint("j1", a=1.0),)).forward_kinematics(np.array([[np.pi / 2]]))[0]
    np.testing.assert_allclose(turn[:3, 3], [0.0, 1.0, 0.0], atol=1e-15)


def test_parameters_are_named_joint_by_joint_in_the_order_of_the_convention():
    joints = (Joint("a"), Joint("b"))
    assert Arm("s", joints).chain.parameters[:6] == ("a.theta", "a.d", "a.a", "a.alpha", "a.beta", "b.theta")
    assert Arm("m", joints, "modified-dh").chain.parameters[:5] == ("a.beta", "a.alpha", "a.a", "a.d", "a.theta")
