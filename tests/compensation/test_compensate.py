"""Commands for the calibrated arm: exact where the pose can be reached, honest where it cannot."""

import numpy as np
import pytest

from boresight.arm import Arm, Joint, catalogue
from boresight.compensation import Reached, compensate


def bent(arm, size=1.0, seed=0):
    random = np.random.default_rng(seed)
    widths = {"theta": 0.005, "alpha": 0.005, "d": 0.002, "a": 0.002}
    return arm.corrected({f"{j.name}.{n}": size * random.uniform(-w, w) for j in arm.joints for n, w in widths.items()})


def program(arm, rows, seed=1):
    low, high = np.clip(arm.limits, -np.pi, np.pi).T
    return np.random.default_rng(seed).uniform(0.9 * low, 0.9 * high, (rows, len(low)))


@pytest.mark.parametrize("name", catalogue.names())
def test_the_calibrated_arm_is_at_every_pose_that_is_called_reached(name):
    arm = catalogue.load(name)
    found = compensate(arm, bent(arm), joints=program(arm, 300))
    there = found.reached <= Reached.NEAR_SINGULAR
    assert there.mean() > 0.85
    assert np.abs(found.calibrated.forward_kinematics(found.joints) - found.poses)[there].max() < 2e-8
    assert np.allclose(found.poses, arm.forward_kinematics(found.nominal_joints))


@pytest.mark.parametrize("name", ["space-arm", "canadarm2"])
def test_what_is_said_to_be_missing_is_missing(name):
    arm = catalogue.load(name)
    found = compensate(arm, bent(arm), joints=program(arm, 300))
    off = found.calibrated.forward_kinematics(found.joints)[:, :3, 3] - found.poses[:, :3, 3]
    assert np.allclose(np.linalg.norm(off, axis=1), found.missing[:, 0], atol=1e-9)


def test_limits_are_respected_and_the_joint_in_the_way_is_named():
    arm = catalogue.load("space-arm")
    low, high = arm.limits.T
    q = np.tile(0.3 * high, (1, 1))
    q[0, 1] = high[1]
    real = arm.corrected({"j2.theta": -0.05})
    found = compensate(arm, real, joints=q)
    assert np.all((found.joints >= low) & (found.joints <= high))
    assert found.reached[0] == Reached.AT_A_LIMIT
    assert "j2" in found.limits_hit(0)
    assert found.missing[0, 0] > 1e-4


def test_a_pose_beyond_the_arm_is_not_reached_and_the_arm_stretches_towards_it():
    arm = catalogue.load("puma560")
    pose = np.eye(4)[None].copy()
    pose[0, :3, 3] = [10.0, 0.0, 0.0]
    found = compensate(arm, bent(arm), poses=pose, position_only=True)
    assert found.reached[0] >= Reached.AT_A_LIMIT
    assert 10.0 - arm.reach < found.missing[0, 0] < 10.0 - 0.5 * arm.reach


def test_a_stretched_elbow_is_near_singular():
    arm = Arm("two links", (Joint("j1", a=1.0), Joint("j2", a=1.0)))
    straight = compensate(arm, arm, joints=np.array([[0.2, 0.001], [0.2, 1.2]]), position_only=True)
    # a planar arm never moves along z: its weakest motion is none at all
    assert np.all(straight.weakest < 1e-5)
    arm = catalogue.load("puma560")
    q = np.array([[0.1, -0.4, 0.7, 0.3, 0.0, 0.2], [0.1, -0.4, 0.7, 0.3, 0.9, 0.2]])
    found = compensate(arm, arm, joints=q)
    assert list(found.reached) == [Reached.NEAR_SINGULAR, Reached.YES]


def test_the_weakest_motion_is_the_jacobians_smallest_singular_value():
    arm = catalogue.load("ur10")
    q = program(arm, 40)
    found = compensate(arm, arm, joints=q)
    lever, step = arm.reach / 3.0, 1e-6
    for row in range(len(q)):
        columns = []
        for joint in range(6):
            ahead, behind = q[row].copy(), q[row].copy()
            ahead[joint] += step
            behind[joint] -= step
            T = arm.forward_kinematics(np.stack([ahead, behind]))
            turn = T[0, :3, :3] @ T[1, :3, :3].T
            angle = 0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
            columns.append(np.concatenate([T[0, :3, 3] - T[1, :3, 3], lever * angle]) / (2 * step))
        smallest = np.linalg.svd(np.array(columns))[1][-1]
        assert found.weakest[row] == pytest.approx(smallest, rel=0.2, abs=1e-4)


def test_poses_alone_find_a_configuration_of_their_own():
    arm = catalogue.load("iiwa14")
    found = compensate(arm, bent(arm), poses=arm.forward_kinematics(program(arm, 50)))
    assert found.count(Reached.YES) + found.count(Reached.NEAR_SINGULAR) >= 48


def test_an_arm_that_is_as_it_was_gets_the_commands_it_had():
    arm = catalogue.load("panda")
    q = program(arm, 100)
    found = compensate(arm, arm, joints=q)
    assert np.array_equal(found.joints, q)
    assert np.allclose(found.controller_poses, found.poses)


def test_the_nominal_controller_turns_its_poses_into_these_commands():
    arm = catalogue.load("space-arm")
    found = compensate(arm, bent(arm), joints=program(arm, 50))
    back = compensate(arm, arm, joints=found.joints + 0.01, poses=found.controller_poses)
    there = (found.reached == Reached.YES) & (back.reached == Reached.YES)
    assert there.sum() > 35
    assert np.abs(back.joints - found.joints)[there].max() < 1e-6


def test_a_slide_is_moved_as_well():
    arm = Arm("scara", (Joint("j1", a=0.4), Joint("j2", a=0.3), Joint("z", "prismatic", limits=(0.0, 0.3))))
    real = arm.corrected({"j1.a": 0.002, "z.d": 0.004})
    found = compensate(arm, real, joints=np.array([[0.3, 1.0, 0.1]]), position_only=True)
    assert found.joints[0, 2] == pytest.approx(0.096, abs=1e-9)
    assert found.missing[0, 0] < 1e-9


def test_something_must_be_asked_for():
    arm = catalogue.load("ur10")
    with pytest.raises(ValueError, match="joints, poses or both"):
        compensate(arm, arm)


def test_a_joint_that_follows_another_moves_with_it():
    arm = Arm(
        "palletiser",
        (
            Joint("j1", d=0.4, alpha=-np.pi / 2),
            Joint("j2", a=0.5),
            Joint("j3", a=0.5),
            Joint("level", follows="j2", ratio=-1.0),
            Joint("j4", a=0.1, alpha=0.4),
        ),
    )
    real = arm.corrected({"j2.a": 0.003, "j3.theta": 0.004, "j1.theta": -0.002})
    found = compensate(arm, real, joints=np.array([[0.3, -0.8, 1.1, 0.2], [0.1, -0.5, 0.9, -0.4]]), position_only=True)
    assert np.all(found.reached == Reached.YES)
    off = real.forward_kinematics(found.joints)[:, :3, 3] - found.poses[:, :3, 3]
    assert np.abs(off).max() < 1e-9


def test_an_arm_that_bends_is_put_there_too():
    arm = catalogue.load("iiwa14")
    terms = {"joint_a2.cos1": 3e-4, "joint_a4.sin2": -2e-4, "joint_a2.sag5": 4e-4, "joint_a4.sag7": 3e-4}
    real = bent(arm).with_harmonics().with_sag().corrected(terms)
    assert np.abs(real.bends(program(arm, 20))).max() > 1e-4
    found = compensate(arm, real, joints=program(arm, 100))
    there = found.reached <= Reached.NEAR_SINGULAR
    assert there.mean() > 0.9
    assert np.abs(real.forward_kinematics(found.joints) - found.poses)[there].max() < 2e-8


def test_a_joint_without_limits_may_turn_on():
    arm = catalogue.load("puma560")
    free = Arm("free", tuple(Joint(**{**vars_of(joint), "limits": (-np.inf, np.inf)}) for joint in arm.joints))
    found = compensate(free, bent(free), joints=program(arm, 20) + 2 * np.pi)
    assert (found.reached <= Reached.NEAR_SINGULAR).mean() > 0.8
    assert np.abs(found.moved[found.reached == Reached.YES]).max() < np.pi


def vars_of(joint):
    return {name: getattr(joint, name) for name in ("name", "type", "theta", "d", "a", "alpha", "beta")}
