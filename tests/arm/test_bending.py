"""What turns a joint beside its reading: harmonics and gravity."""

from dataclasses import replace

import numpy as np
import pytest
from arm_twists import numeric_twist

from boresight.arm import Arm, Joint
from random_cells import CONVENTIONS, random_arm, random_joints


def bent_arm(rng, joints=6, convention="standard-dh"):
    """An arm with harmonics and sags, of milliradians, under gravity from a random direction."""
    down = rng.normal(size=3)
    arm = replace(random_arm(rng, joints, convention), gravity=tuple(map(float, down / np.linalg.norm(down))))
    arm = arm.with_harmonics().with_sag()
    names = [name for name in arm.chain.parameters if name.rpartition(".")[2][:3] in ("cos", "sin", "sag")]
    return arm.corrected({name: float(rng.normal(0.0, 2e-3)) for name in names})


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("joints", [1, 4, 7])
def test_twists_of_a_bent_arm_equal_finite_differences_of_the_pose(convention, joints):
    rng = np.random.default_rng([joints, 7])
    arm = bent_arm(rng, joints, convention)
    readings = random_joints(rng, arm, 3)
    corrections = rng.uniform(-0.1, 0.1, len(arm.chain.parameters))
    motion = arm.chain.linearise(readings, corrections)
    for column in range(len(corrections)):
        numeric = numeric_twist(arm.chain, readings, corrections, column)
        np.testing.assert_allclose(motion.twists[:, column], numeric, rtol=1e-6, atol=1e-8)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_a_bent_arm_is_a_rigid_one_whose_joints_turn_further(convention):
    rng = np.random.default_rng(8)
    arm = bent_arm(rng, convention=convention)
    readings = random_joints(rng, arm, 20)
    further = readings + arm.chain.bends(readings)
    assert np.abs(further - readings).max() > 1e-3
    np.testing.assert_allclose(
        arm.forward_kinematics(readings), arm.rigid.forward_kinematics(further), rtol=0, atol=1e-13
    )


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_corrections_and_a_corrected_arm_agree(convention):
    rng = np.random.default_rng(9)
    arm = bent_arm(rng, convention=convention)
    readings = random_joints(rng, arm, 5)
    corrections = rng.uniform(-0.01, 0.01, len(arm.chain.parameters))
    corrected = arm.corrected(dict(zip(arm.chain.parameters, map(float, corrections), strict=True)))
    np.testing.assert_allclose(
        corrected.forward_kinematics(readings), arm.chain.poses(readings, corrections), rtol=0, atol=1e-13
    )


def test_what_is_zero_turns_nothing():
    rng = np.random.default_rng(10)
    arm = random_arm(rng, 6)
    readings = random_joints(rng, arm, 5)
    np.testing.assert_array_equal(
        arm.with_harmonics().with_sag().forward_kinematics(readings), arm.forward_kinematics(readings)
    )


def test_a_joint_sags_by_its_number_when_the_links_end_stands_a_metre_out():
    arm = Arm("level", (Joint("up", alpha=-np.pi / 2), Joint("out", a=1.0), Joint("wrist"))).with_sag()
    arm = arm.corrected({"out.sag2": 1e-3})
    bends = arm.chain.bends(np.array([[0.4, 0.0, 0.3], [0.4, -np.pi / 3, 0.3], [0.4, -np.pi / 2, 0.3]]))
    np.testing.assert_allclose(bends[:, 1], [1e-3, 0.5e-3, 0.0], rtol=0, atol=1e-18)
    assert np.all(bends[:, [0, 2]] == 0.0)
    height = arm.forward_kinematics(np.zeros((1, 3)))[0, 2, 3]
    assert height == pytest.approx(-1e-3, rel=1e-6)


def test_an_upright_axis_has_no_lever():
    arm = random_arm(np.random.default_rng(11), 5, "standard-dh")
    readings = random_joints(np.random.default_rng(12), arm, 10)
    levers = replace(arm, gravity=(0.0, 0.0, -1.0)).with_sag().chain.levers
    np.testing.assert_allclose(levers.moments(readings)[:, 0], 0.0, atol=1e-15)


def test_sag_is_offered_under_links_that_lead_somewhere_from_joints_that_turn():
    arm = Arm(
        "four",
        (Joint("j1", d=0.3), Joint("j2"), Joint("j3", "prismatic", limits=(0.0, 0.4)), Joint("j4")),
    ).with_sag()
    assert [tuple(link for link, _ in joint.sag) for joint in arm.joints] == [(1, 3, 4), (3, 4), (), (4,)]
    assert all(not joint.sag for joint in arm.weightless().joints)


def test_sags_that_are_there_stay():
    arm = Arm("two", (Joint("j1", d=0.3, sag=((1, 2e-4),)), Joint("j2", harmonics=(1e-4, 0.0, 0.0, 0.0))))
    offered = arm.with_sag().with_harmonics()
    assert offered.joints[0].sag == ((1, 2e-4), (2, 0.0))
    assert offered.joints[1].harmonics == (1e-4, 0.0, 0.0, 0.0)
