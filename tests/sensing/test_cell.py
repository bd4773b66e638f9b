import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boresight.arm import Arm, Joint
from boresight.geometry import Frame, Plane, inverse
from boresight.sensing import Cell, LaserRanger, Position
from random_cells import named, random_cell, random_corrections, random_joints, random_targets

seeds = st.integers(0, 2**32 - 1)
sensors = st.sampled_from(["laser_ranger", "position"])


def drawn(seed, sensor="laser_ranger", rows=6):
    rng = np.random.default_rng(seed)
    cell = random_cell(rng, planes=int(rng.integers(1, 4)), sensor=sensor)
    return rng, cell, random_joints(rng, cell.arm, rows), random_targets(rng, cell, rows)


def test_pose_is_base_then_arm_then_mount():
    _, cell, joints, _ = drawn(1)
    expected = cell.base.matrix @ cell.arm.forward_kinematics(joints) @ cell.mount.matrix
    np.testing.assert_allclose(cell.poses(joints), expected, atol=1e-14)


def test_range_of_a_simple_cell_by_hand():
    """A beam 1 m up that looks down at 60 degrees from the vertical, by the mount, sees the floor at 2 m."""
    cell = Cell(
        Arm("mast", (Joint("j1", d=1.0),)),
        LaserRanger(2e-4),
        mount=Frame(rpy=(math.pi - math.pi / 3, 0.0, 0.0)),
        targets={"floor": Plane.of((0.0, 0.0, 1.0), 0.0)},
    )
    turns = np.array([[0.0], [1.0], [2.0]])
    np.testing.assert_allclose(cell.predict(turns, np.zeros(3, dtype=int)), 2.0, rtol=1e-15)


@given(seeds, sensors)
def test_corrected_cell_predicts_what_corrections_do(seed, sensor):
    rng, cell, joints, target = drawn(seed, sensor)
    corrections = random_corrections(rng, cell, 0.05)
    corrected = cell.corrected(named(cell, corrections))
    poses = corrected.poses(joints)
    np.testing.assert_allclose(poses, cell.poses(joints, corrections), rtol=0, atol=1e-13)
    normals = np.array([plane.normal for plane in corrected.targets.values()])[target]
    approach = np.abs(np.sum(normals * poses[:, :3, 2], axis=1))
    ours, theirs = corrected.predict(joints, target), cell.predict(joints, target, corrections)
    if sensor == "laser_ranger":
        steep = approach > 1e-2
        ours, theirs = ours[steep], theirs[steep]
    np.testing.assert_allclose(ours, theirs, rtol=1e-10, atol=1e-12)


@given(seeds)
def test_position_is_where_the_sensor_frame_stands(seed):
    _, cell, joints, target = drawn(seed, "position")
    np.testing.assert_array_equal(cell.predict(joints, target), cell.poses(joints)[:, :3, 3])


@given(seeds, sensors)
def test_predictions_and_derivatives_of_a_batch_equal_a_loop(seed, sensor):
    rng, cell, joints, target = drawn(seed, sensor, rows=4)
    corrections = random_corrections(rng, cell, 0.003)
    values, jacobian = cell.linearise(joints, target, corrections)
    np.testing.assert_array_equal(values, cell.predict(joints, target, corrections))
    for row in range(4):
        one, by = cell.linearise(joints[row : row + 1], target[row : row + 1], corrections)
        np.testing.assert_allclose(one[0], values[row], rtol=1e-12)
        np.testing.assert_allclose(by[0], jacobian[row], rtol=1e-9, atol=1e-12)


def test_range_to_one_plane_does_not_depend_on_the_others():
    _, cell, joints, _ = drawn(8)
    for place, (name, plane) in enumerate(cell.targets.items()):
        alone = Cell(cell.arm, cell.sensor, cell.base, cell.mount, {name: plane})
        ranges = cell.predict(joints, np.full(len(joints), place))
        np.testing.assert_array_equal(alone.predict(joints, np.zeros(len(joints), dtype=int)), ranges)


def test_parameters_have_names_quantities_and_values():
    arm = Arm("one", (Joint("j1", theta=0.1, d=0.2, a=0.3, alpha=0.4, beta=0.5),))
    base, deck = Frame((1.0, 2.0, 3.0), (0.1, 0.2, 0.3)), Plane.of((0.0, 1.0, 4.6), -0.69)
    cell = Cell(arm, LaserRanger(2e-4), base, targets={"deck": deck})
    names = [parameter.name for parameter in cell.parameters]
    assert names[:6] == ["base.x", "base.y", "base.z", "base.yaw", "base.pitch", "base.roll"]
    assert names[6:11] == ["j1.theta", "j1.d", "j1.a", "j1.alpha", "j1.beta"]
    assert names[-5:] == ["deck.normal_x", "deck.normal_z", "deck.offset", "sensor.bias", "sensor.scale"]
    quantity = {parameter.name: parameter.quantity for parameter in cell.parameters}
    assert quantity["base.x"] == quantity["j1.d"] == quantity["deck.offset"] == "length"
    assert quantity["base.yaw"] == quantity["j1.beta"] == "angle"
    assert quantity["deck.normal_x"] == "number"
    assert cell.values["base.roll"] == 0.1
    assert cell.values["base.yaw"] == 0.3
    assert cell.values["j1.alpha"] == 0.4
    assert set(names) <= set(cell.values)


def test_unknown_parameters_are_refused():
    cell = Cell(Arm("one", (Joint("j1"),)), Position(1e-4))
    with pytest.raises(AssertionError, match=r"j2\.theta"):
        cell.corrected({"j2.theta": 0.1})


def test_base_yaw_turns_the_arm_about_its_own_base():
    cell = Cell(Arm("one", (Joint("j1", a=1.0),)), Position(1e-4), Frame((0.0, 0.0, 5.0), (math.pi / 2, 0.0, 0.0)))
    turned = cell.corrected({"base.yaw": math.pi / 2})
    still = np.zeros((1, 1))
    np.testing.assert_allclose(inverse(cell.base.matrix) @ turned.poses(still)[0, :, 3], [0, 1, 0, 1], atol=1e-15)
