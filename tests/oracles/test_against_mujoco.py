"""Poses and ranges of random cells against MuJoCo's kinematics and ray casting."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from independent_arms import mjcf

from boresight.sensing import LaserRanger
from random_cells import CONVENTIONS, random_arm, random_cell, random_joints

TOLERANCE_M = 1e-9
CELLS, ROWS = 3, 40
GRAZING = 1e-2
"""Sine of the angle between beam and plane under which neither side's rounding is small in the range."""


class Mujoco:
    """A cell in MuJoCo."""

    def __init__(self, cell):
        self.model = mujoco.MjModel.from_xml_string(mjcf(cell))
        self.data = mujoco.MjData(self.model)

    def move(self, joints):
        self.data.qpos[:] = joints
        mujoco.mj_forward(self.model, self.data)

    @property
    def pose(self):
        T = np.eye(4)
        T[:3, :3] = self.data.site("sensor").xmat.reshape(3, 3)
        T[:3, 3] = self.data.site("sensor").xpos
        return T

    def range_to(self, plane: int) -> float:
        groups = np.zeros(6, dtype=np.uint8)
        groups[plane] = 1
        hit, normal = np.zeros(1, dtype=np.int32), np.zeros(3)
        pose = self.pose
        return mujoco.mj_ray(self.model, self.data, pose[:3, 3], pose[:3, 2], groups, 1, -1, hit, normal)

    @property
    def nearest_range(self) -> float:
        return float(self.data.sensordata[0])


def compare(cell, joints) -> tuple[int, int]:
    """Returns how many beams met their plane and how many looked away, once both sides agree on all of them."""
    oracle = Mujoco(cell)
    poses, planes = cell.poses(joints), range(len(cell.targets))
    ranges = np.column_stack([cell.predict(joints, np.full(len(joints), plane))[:, 0] for plane in planes])
    normals = np.array([plane.normal for plane in cell.targets.values()])
    steep = np.abs(poses[:, :3, 2] @ normals.T) > GRAZING
    for row, configuration in enumerate(joints):
        oracle.move(configuration)
        np.testing.assert_allclose(oracle.pose, poses[row], rtol=0, atol=TOLERANCE_M)
        for plane in np.flatnonzero(steep[row]):
            expected = oracle.range_to(int(plane))
            missed = np.isnan(ranges[row, plane])
            assert (expected == -1.0) == missed
            assert missed or abs(ranges[row, plane] - expected) < TOLERANCE_M
        if steep[row].all():
            nearest = np.nanmin(np.append(ranges[row], np.inf))
            assert abs(oracle.nearest_range - (nearest if np.isfinite(nearest) else -1.0)) < TOLERANCE_M
    return int(np.isfinite(ranges).sum()), int(np.isnan(ranges).sum())


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("joints", range(1, 9))
def test_poses_and_ranges_equal_mujoco(convention, joints):
    rng = np.random.default_rng([joints, CONVENTIONS.index(convention)])
    hits = misses = 0
    for _ in range(CELLS):
        cell = replace(random_cell(rng, arm=random_arm(rng, joints, convention)), sensor=LaserRanger(2e-4))
        hit, missed = compare(cell, random_joints(rng, cell.arm, ROWS))
        hits, misses = hits + hit, misses + missed
    assert hits
    assert misses
