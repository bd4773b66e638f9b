"""What no reading can tell: moving base and planes together, spinning the beam, scaling everything.

The ranks are those of the design: a six-axis arm has 4 R + 6 = 30 independent parameters (paper, eq. 13).
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boresight.arm import Arm, catalogue
from boresight.geometry import Frame, Plane
from boresight.sensing import Cell, LaserRanger, Position
from random_cells import random_arm, random_cell, random_frame, random_joints, random_targets

seeds = st.integers(0, 2**32 - 1)
PAPER_PLANE = Plane.of((0.0, 1.0, 4.6), -0.69)
FLOOR = Plane.of((0.0, 0.0, 1.0), -0.15)
CLEAR_RANK = 1e-9
"""Singular values this far below the largest are rounding."""


def seen(cell: Cell, joints: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Returns which rows meet their plane steeply enough for rounding to stay small."""
    normals = np.array([plane.normal for plane in cell.targets.values()])[target]
    steep = np.abs(np.sum(normals * cell.poses(joints)[:, :3, 2], axis=1)) > 0.1
    return steep & ~np.isnan(cell.predict(joints, target)[:, 0])


def rank(cell: Cell, names: list[str], rows: int = 600, seed: int = 1) -> int:
    """Returns how many combinations of the named parameters the readings of random configurations depend on."""
    rng = np.random.default_rng(seed)
    joints, target = random_joints(rng, cell.arm, rows), random_targets(rng, cell, rows)
    if cell.sensor.aims_at is not None:
        rows_seen = seen(cell, joints, target)
        joints, target = joints[rows_seen], target[rows_seen]
    _, jacobian = cell.linearise(joints, target)
    columns = jacobian[:, :, [cell.index[name] for name in names]].reshape(-1, len(names))
    size = np.linalg.norm(columns, axis=0)
    scale = np.where(size > CLEAR_RANK * size.max(), size, size.max())
    values = np.linalg.svd(columns / scale, compute_uv=False)
    return int(np.sum(values > CLEAR_RANK * values[0]))


def link_parameters(arm: Arm) -> list[str]:
    """Returns four numbers a joint: beta in place of d where axes are parallel."""
    return [
        f"{joint.name}.{number}"
        for joint in arm.joints
        for number in ("theta", "beta" if joint.alpha == 0.0 else "d", "a", "alpha")
    ]


def moved_world(plane: Plane, T_new_old: np.ndarray) -> Plane:
    """Returns the plane as seen from another world frame."""
    x, y, z = (float(component) for component in T_new_old[:3, :3] @ np.array(plane.normal))
    return Plane.of((x, y, z), float(plane.offset - np.array([x, y, z]) @ T_new_old[:3, 3]))


@given(seeds)
def test_moving_base_and_planes_together_changes_no_range(seed):
    rng = np.random.default_rng(seed)
    cell = random_cell(rng)
    joints, target = random_joints(rng, cell.arm, 6), random_targets(rng, cell, 6)
    T_new_old = random_frame(rng).matrix
    targets = {name: moved_world(plane, T_new_old) for name, plane in cell.targets.items()}
    moved = Cell(cell.arm, cell.sensor, Frame.of(T_new_old @ cell.base.matrix), cell.mount, targets)
    rows = seen(cell, joints, target)
    ranges = cell.predict(joints, target)
    np.testing.assert_allclose(moved.predict(joints, target)[rows], ranges[rows], rtol=1e-11, atol=1e-12)


@given(seeds, st.floats(-3.0, 3.0))
def test_spinning_the_sensor_about_its_beam_changes_no_range(seed, spin):
    rng = np.random.default_rng(seed)
    cell = random_cell(rng)
    joints, target = random_joints(rng, cell.arm, 6), random_targets(rng, cell, 6)
    spun = cell.corrected({"mount.yaw": spin})
    rows = seen(cell, joints, target)
    ranges = cell.predict(joints, target)
    np.testing.assert_allclose(spun.predict(joints, target)[rows], ranges[rows], rtol=1e-12, atol=1e-12)


@given(seeds, st.sampled_from([1e-3, 0.5, 1e3]))
def test_lengths_in_another_unit_give_readings_in_that_unit(seed, unit):
    rng = np.random.default_rng(seed)
    cell = random_cell(rng)
    joints, target = random_joints(rng, cell.arm, 6), random_targets(rng, cell, 6)
    lengths = {name: cell.values[name] * (unit - 1.0) for name, q in quantities(cell).items() if q == "length"}
    slides = np.array([unit if joint.type == "prismatic" else 1.0 for joint in cell.arm.joints])
    rows = seen(cell, joints, target)
    ranges, scaled = cell.predict(joints, target), cell.corrected(lengths).predict(joints * slides, target)
    np.testing.assert_allclose(scaled[rows], unit * ranges[rows], rtol=1e-11)


def quantities(cell: Cell) -> dict[str, str]:
    return {parameter.name: parameter.quantity for parameter in cell.parameters}


@pytest.mark.parametrize(("planes", "expected"), [(1, 26), (2, 28), (3, 29)])
def test_known_planes_see_26_28_and_29_of_30_parameters(planes, expected):
    rng = np.random.default_rng(12)
    arm = catalogue.load("space-arm")
    bent = arm.corrected(
        {f"{joint.name}.{n}": float(rng.normal(0, 0.1)) for joint in arm.joints for n in ("a", "alpha")}
    )
    full = random_cell(rng, planes=planes, arm=bent)
    names = [name for name in full.index if not name.startswith("plane")]
    assert rank(full, names) == expected


def test_position_sees_27_of_30_parameters():
    """Three turns of the sensor about its own origin move no position."""
    cell = random_cell(np.random.default_rng(3), sensor="position", arm=catalogue.load("space-arm"))
    assert rank(cell, [name for name in cell.index if not name.startswith("plane")]) == 27


def test_space_arm_and_plane_of_the_paper_show_25_parameters_of_26():
    arm = catalogue.load("space-arm")
    cell = Cell(arm, LaserRanger(2e-4), targets={"deck": PAPER_PLANE})
    names = [*link_parameters(arm), "deck.normal_x", "deck.normal_z"]
    assert len(names) == 26
    assert rank(cell, names) == 25


def test_azimuth_of_arm_and_plane_are_one_parameter():
    arm = catalogue.load("space-arm")
    cell = Cell(arm, LaserRanger(2e-4), targets={"deck": PAPER_PLANE})
    both = ["j1.theta", "deck.normal_x"]
    assert rank(cell, both) == 1


def test_horizontal_plane_hides_theta_1_a_1_and_d_3_of_the_space_arm():
    arm = catalogue.load("space-arm")
    cell = Cell(arm, LaserRanger(2e-4), targets={"deck": FLOOR})
    names = link_parameters(arm)
    hidden = ["j1.theta", "j1.a", "j3.d"]
    assert rank(cell, names) == 21
    assert rank(cell, [name for name in names if name not in hidden]) == 21
    rng = np.random.default_rng(2)
    joints = random_joints(rng, arm, 50)
    target = np.zeros(50, dtype=int)
    rows = seen(cell, joints, target)
    _, jacobian = cell.linearise(joints[rows], target[rows])
    assert np.max(np.abs(jacobian[:, 0, [cell.index["j1.theta"], cell.index["j1.a"]]])) < 1e-15


@given(seeds)
def test_theta_of_a_revolute_joint_is_a_shift_of_its_reading(seed):
    rng = np.random.default_rng(seed)
    arm = random_arm(rng)
    joints = random_joints(rng, arm, 3)
    for column, joint in enumerate(arm.joints):
        shifted = joints.copy()
        shifted[:, column] += 0.1
        number = "theta" if joint.type == "revolute" else "d"
        corrected = arm.corrected({f"{joint.name}.{number}": 0.1})
        np.testing.assert_allclose(corrected.forward_kinematics(joints), arm.forward_kinematics(shifted), atol=1e-13)


def test_position_and_range_to_the_axis_planes_agree():
    """A laser along an axis of the world reads the tracker's coordinate."""
    rng = np.random.default_rng(5)
    arm = random_arm(rng, 4)
    joints = random_joints(rng, arm, 20)
    tracker = Cell(arm, Position(1e-4), Frame((0.0, 0.0, 9.0)))
    heights = tracker.predict(joints, np.zeros(20, dtype=int))[:, 2]
    ranger = Cell(arm, LaserRanger(1e-4), tracker.base, targets={"floor": Plane.of((0.0, 0.0, 1.0), 0.0)})
    down = ranger.poses(joints)[:, 2, 2]
    ranges = ranger.predict(joints, np.zeros(20, dtype=int))[:, 0]
    hits = ~np.isnan(ranges)
    np.testing.assert_allclose(-(ranges * down)[hits], heights[hits], rtol=1e-12)
