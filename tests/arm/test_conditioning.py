"""Tables whose nearly parallel axes carry hundreds of metres get lengths of the arm's own size, and move the same."""

import math
from dataclasses import replace

import numpy as np
import pytest

from boresight.arm import Arm, Joint, catalogue
from boresight.arm.common_normals import modified_dh, standard_dh
from boresight.arm.conditioning import well_conditioned
from boresight.arm.screws import screws_of
from factory_arms import FACTORY, factory_arm
from random_cells import CONVENTIONS, random_arm


def without_beta(arm, convention):
    """The same arm as a table whose d runs to its common normals, however far away they are."""
    return (standard_dh if convention == "standard-dh" else modified_dh)(screws_of(arm), 0.0)


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("name", FACTORY)
def test_factory_tables_get_lengths_of_the_arm(name, convention):
    arm = factory_arm(name) if convention == "standard-dh" else without_beta(factory_arm(name), convention)
    found = well_conditioned(arm)
    joints = np.random.default_rng(3).uniform(-math.pi, math.pi, (200, 6))
    np.testing.assert_allclose(found.forward_kinematics(joints), arm.forward_kinematics(joints), rtol=0, atol=2e-12)
    assert found.convention == convention
    assert max(abs(length) for joint in found.joints for length in (joint.d, joint.a)) < 0.62
    assert [joint.name for joint in found.joints] == [joint.name for joint in arm.joints]


def test_angles_come_back_near_those_that_the_arm_stands_at():
    """Of theta between nearly parallel axes only the sum means anything; the links then point as UR's do, along -x."""
    found = well_conditioned(factory_arm("ur10e, 439 m"))
    assert max(abs(joint.theta) for joint in found.joints) < 0.01
    assert found.joints[1].a == pytest.approx(-0.6127, abs=2e-3)


@pytest.mark.parametrize("seed", range(20))
def test_any_arm_of_nearly_parallel_axes(seed):
    rng = np.random.default_rng(seed)
    joints = tuple(
        Joint(f"j{k}", theta=float(rng.uniform(-2, 2)), d=float(rng.uniform(-0.3, 0.3)), a=float(rng.uniform(0.2, 0.5)),
              alpha=float(rng.choice([0.0, math.pi, math.pi / 2]) + rng.normal(0, 1e-3)),
              beta=float(rng.normal(0, 1e-3)))
        for k in range(6)
    )  # fmt: skip
    for convention in CONVENTIONS:
        arm = without_beta(Arm("any", joints), convention)
        found = well_conditioned(arm)
        angles = rng.uniform(-math.pi, math.pi, (50, 6))
        tolerance = 1e-13 * max(1.0, arm.reach)
        np.testing.assert_allclose(found.forward_kinematics(angles), arm.forward_kinematics(angles), atol=tolerance)
        assert found is arm or found.reach < 0.5 * arm.reach
        assert max(abs(length) for joint in found.joints for length in (joint.d, joint.a)) < 13.0


@pytest.mark.parametrize("name", catalogue.names())
def test_arms_of_the_catalogue_stay_as_they_are(name):
    arm = catalogue.load(name)
    assert well_conditioned(arm) is arm


@pytest.mark.parametrize("seed", range(30))
def test_arms_with_lengths_of_their_own_size_stay_as_they_are(seed):
    arm = random_arm(np.random.default_rng(seed))
    assert well_conditioned(arm) is arm


def test_what_turns_joints_further_stays_with_them():
    arm = factory_arm("ur10e, 303 m")
    wavy = replace(
        arm, joints=(arm.joints[0], replace(arm.joints[1], harmonics=(1e-3, 0.0, 0.0, 2e-3)), *arm.joints[2:])
    )
    found = well_conditioned(wavy)
    assert found is not wavy
    joints = np.random.default_rng(3).uniform(-1.0, 1.0, (50, 6))
    np.testing.assert_allclose(found.forward_kinematics(joints), wavy.forward_kinematics(joints), rtol=0, atol=1e-11)
    sagging = replace(arm, joints=(*arm.joints[:1], replace(arm.joints[1], sag=((3, 1e-3),)), *arm.joints[2:]))
    assert well_conditioned(sagging) is sagging
