"""Between D-H, modified D-H, chains of joints and products of exponentials: the arm moves the same."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boresight.arm import LINK_NUMBERS, Arm, Joint, catalogue
from boresight.arm.common_normals import axis_frame, modified_dh, standard_dh
from boresight.arm.screws import Screw, Screws, screws_of
from boresight.arm.serial import chain_of
from boresight.geometry import Frame
from factory_arms import ALPHA, FACTORY, factory_arm
from random_cells import CONVENTIONS, random_arm, random_frame, random_joints

EXACT = 1e-12


def same(one, other, joints):
    ours, theirs = one.forward_kinematics(joints), other.forward_kinematics(joints)
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=EXACT)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("convention", CONVENTIONS)
def test_every_form_of_a_random_arm_moves_the_same(seed, convention):
    rng = np.random.default_rng(seed)
    drawn = random_arm(rng, convention=convention)
    arm = Arm(drawn.name, drawn.joints, convention, random_frame(rng), random_frame(rng))
    joints = random_joints(rng, arm, 20)
    screws = screws_of(arm)
    same(screws, arm, joints)
    for converted in (standard_dh(screws), modified_dh(screws)):
        same(converted, arm, joints)
        same(screws_of(converted), arm, joints)
    same(chain_of(standard_dh(screws)).screws, arm, joints)
    same(chain_of(standard_dh(screws)).arm, arm, joints)


@pytest.mark.parametrize("name", [name for name in catalogue.names() if name != "canadarm2"])
def test_an_arm_of_the_catalogue_comes_back_from_its_axes_with_its_own_lengths(name):
    # canadarm2's table divides an offset among parallel axes, which axes alone cannot tell
    arm = catalogue.load(name)
    back = (standard_dh if arm.convention == "standard-dh" else modified_dh)(screws_of(arm))
    rng = np.random.default_rng(1)
    same(back, arm, random_joints(rng, arm, 20))
    ours = sorted(abs(getattr(joint, n)) for joint in arm.joints for n in ("d", "a"))
    theirs = sorted(abs(getattr(joint, n)) for joint in back.joints for n in ("d", "a"))
    np.testing.assert_allclose(theirs, ours, rtol=0, atol=1e-9)


def test_ur10_comes_back_from_its_axes_number_by_number():
    arm = catalogue.load("ur10")
    back = standard_dh(screws_of(arm))
    for ours, theirs in zip(arm.joints, back.joints, strict=True):
        assert theirs.numbers == pytest.approx(ours.numbers, abs=1e-12)
    assert (back.root, back.tip) == (Frame(), Frame())


def test_followers_follow_in_every_form():
    joints = (
        Joint("lift", "prismatic", alpha=0.3, limits=(0.0, 0.5)),
        Joint("j2", theta=0.2, a=0.3, alpha=1.2),
        Joint("j3", d=0.1, a=0.2, alpha=-1.0, follows="j2", ratio=-2.0),
        Joint("j4", "prismatic", a=0.1, alpha=0.5, follows="j2", ratio=0.05),
    )
    arm = Arm("geared", joints)
    assert arm.joint_names == ("lift", "j2")
    assert arm.limits.shape == (2, 2)
    readings = np.random.default_rng(2).uniform(-1.0, 1.0, (10, 2))
    alone = Arm("free", tuple(Joint(j.name, j.type, **j.numbers) for j in joints))
    all_four = np.column_stack([readings, -2.0 * readings[:, 1], 0.05 * readings[:, 1]])
    np.testing.assert_allclose(arm.forward_kinematics(readings), alone.forward_kinematics(all_four), atol=1e-15)
    for converted in (screws_of(arm), modified_dh(screws_of(arm)), chain_of(arm).arm):
        same(converted, arm, readings)


TILTS = st.one_of(
    st.floats(-math.pi, math.pi), st.builds(lambda e, s: s * 10.0**e, st.floats(-17, -1), st.sampled_from([-1, 1]))
)


@given(st.lists(st.tuples(TILTS, TILTS, st.floats(-0.5, 0.5), st.floats(-0.5, 0.5)), min_size=2, max_size=7))
def test_nearly_parallel_axes_never_explode(steps):
    """Each axis turned from the one before by any two small or large angles, and shifted: numbers stay of its size."""
    T, screws = np.eye(4), []
    for number, (roll, pitch, x, y) in enumerate(steps):
        T = T @ Frame((x, y, 0.1), (roll, pitch, 0.0)).matrix
        axis, point = (tuple(float(v) for v in column) for column in (T[:3, 2], T[:3, 3]))
        screws.append(Screw(f"j{number}", "revolute", axis, point, (-1.0, 1.0)))
    arm = Screws("any", tuple(screws), T @ Frame((0.05, 0.0, 0.1), (0.3, 0.0, 0.0)).matrix)
    joints = np.random.default_rng(0).uniform(-2.0, 2.0, (5, len(screws)))
    for converted in (standard_dh(arm), modified_dh(arm)):
        np.testing.assert_allclose(
            converted.forward_kinematics(joints), arm.forward_kinematics(joints), rtol=0, atol=2e-12
        )
        # Between axes 5 degrees apart a normal lies at most 11.5 times their distance away.
        assert max(abs(getattr(j, n)) for j in converted.joints for n in ("d", "a")) < 13.0 * len(steps)


@given(st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1)).filter(lambda v: np.linalg.norm(v) > 1e-3))
def test_an_axis_frame_has_its_z_along_the_axis(direction):
    axis = np.array(direction) / np.linalg.norm(direction)
    R = axis_frame(axis)
    np.testing.assert_allclose(R[:, 2], axis, atol=1e-15)
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-14)


@pytest.mark.parametrize("name", FACTORY)
def test_factory_numbers_of_hundreds_of_metres_become_lengths_of_the_arm(name):
    arm = factory_arm(name)
    joints = np.random.default_rng(3).uniform(-math.pi, math.pi, (1000, 6))
    for converted in (standard_dh(screws_of(arm)), modified_dh(screws_of(arm))):
        same(converted, arm, joints)
        assert max(abs(getattr(j, n)) for j in converted.joints for n in ("d", "a")) < 0.62
        assert max(abs(j.beta) for j in converted.joints) < 0.015
    hayati = standard_dh(screws_of(arm))
    assert hayati.joints[1].d == hayati.joints[2].d == 0.0
    # within a degree and a few millimetres of nominal, as an arm is that was built
    for joint, alpha, d, a in zip(hayati.joints, ALPHA, *FACTORY[name][:2], strict=True):
        assert (joint.alpha, joint.d, joint.a) == pytest.approx((alpha, d, a), abs=0.015)


@pytest.mark.parametrize("name", FACTORY)
def test_d_h_without_beta_has_the_factorys_own_numbers_again(name):
    arm = factory_arm(name)
    back = standard_dh(screws_of(arm), 0.0, arm)
    for ours, theirs in zip(arm.joints, back.joints, strict=True):
        for number in LINK_NUMBERS:
            difference = getattr(theirs, number) - getattr(ours, number)
            if number == "theta":
                difference = math.remainder(difference, 2 * math.pi)
            assert abs(difference) < 1e-9, (ours.name, number)
