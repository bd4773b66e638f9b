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


FACTORY = {
    # Deltas to nominal D-H from three controllers' calibration.conf, as ur_calibration's own tests have them
    # (Universal_Robots_ROS2_Driver, ur_calibration/test/calibration_test.cpp): d [m], a [m], theta, alpha [rad].
    "ur10": (
        (0.1273, 0, 0, 0.163941, 0.1157, 0.0922),
        (0, -0.612, -0.5723, 0, 0, 0),
        (0.00065609212979853, 1.4442162376284788, 0.854147723854608, -2.2989425877563705, -1.573498686836816e-05,
         1.9072435590711256e-05),
        (4.6311376834935676e-05, -0.00012568315331862312, 0.00186216581161458, 9.918593870679266e-05,
         4.215462720453189e-06, 0),
        (-7.290070070824746e-05, -0.01713897289704999, -0.03707159413492756, 0.054279462160583214,
         1.488984257025741e-07, 1.551499479707493e-05),
        (0.000211987863869334, -0.0072553625957652995, -0.013483226769541364, 0.0013495820227329425,
         -0.001263136163679901, 0),
    ),
    "ur10e, 303 m": (
        (0.1807, 0, 0, 0.17415, 0.11985, 0.11655),
        (0, -0.6127, -0.57155, 0, 0, 0),
        (-0.000144894975118076141, 303.469135666158195, -309.88394307789747, 6.41459904397394975,
         -4.48232900190081995e-05, -0.00087071402790364627),
        (0.000108651068627930392, 0.240324175250532346, 0.00180628180213493472, 2.63076149165684402e-05,
         3.96638632500012715e-06, 0),
        (1.59613525316931737e-07, -0.917209621528830232, 7.12936131346499469, 0.0710299029424392298,
         -1.64258976526054923e-06, 9.17286101034808787e-08),
        (-0.000444781952841921679, -0.00160215112531214153, 0.00631917793331091861, -0.00165055247340828437,
         0.000763682515545038854, 0),
    ),
    "ur10e, 439 m": (
        (0.1807, 0, 0, 0.17415, 0.11985, 0.11655),
        (0, -0.6127, -0.57155, 0, 0, 0),
        (-0.000160188285741325043, 439.140974079900957, -446.027059806332147, 6.88618689642360149,
         -3.86588496858186748e-05, -0.00087908274257374186),
        (2.12234865571205891e-05, 0.632017132627700651, 0.00229833638891230319, -4.61409023720933908e-05,
         -6.39280053471801522e-05, 0),
        (-2.41478068943590252e-07, 1.60233952386694556, -1.68607190752171299, 0.0837331147700118711,
         -1.01260355871157781e-07, 3.91986209186123702e-08),
        (-0.000650246557584166496, 0.00139416666825590402, 0.00693818880325995126, -0.000811641562390219562,
         0.000411120504570705592, 0),
    ),
}  # fmt: skip
ALPHA = (math.pi / 2, 0, 0, math.pi / 2, -math.pi / 2, 0)


def factory_arm(name):
    d, a, *deltas = FACTORY[name]
    nominal = zip(ALPHA, d, a, *deltas, strict=True)
    joints = tuple(
        Joint(f"j{k}", theta=dtheta, d=d + dd, a=float(a + da), alpha=float(alpha + dalpha))
        for k, (alpha, d, a, dd, da, dtheta, dalpha) in enumerate(nominal, start=1)
    )
    return Arm(name, joints)


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
