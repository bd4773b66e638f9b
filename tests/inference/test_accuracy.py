"""Absolute and relative accuracy of the tool, and what a gauge leaves undetermined."""

from dataclasses import replace

import numpy as np
import pytest

from boresight.arm import catalogue
from boresight.geometry import Frame, Plane
from boresight.inference import spread_configurations, tool_accuracy
from boresight.inference.accuracy import Moments
from boresight.sensing import Cell, LaserRanger

CELL = Cell(
    catalogue.load("space-arm"),
    LaserRanger(1e-4),
    targets={"deck": Plane.of((0.0, 1.0, 4.6), -0.69)},
    mount=Frame((0.1, 0.0, 0.05), (0.3, 0.2, 0.1)),
)
JOINTS = spread_configurations(CELL, 200)


def known(*names, std=1e-3, gauge=()):
    """What is known where each named parameter is uncertain by itself."""
    covariance = std**2 * np.eye(len(names))
    rows = np.array([[float(name == each) for name in names] for each in gauge]).reshape(-1, len(names))
    return Moments(names, covariance, 0.0 * covariance, 4.0 * covariance, rows, np.inf, 0.0)


def test_an_error_of_how_the_arm_stands_is_absolute_alone():
    accuracy = tool_accuracy(CELL, known("j1.theta", "base.x", "base.roll"), JOINTS)
    assert accuracy.absolute.median > 1e-3
    assert accuracy.relative.median == pytest.approx(0.0, abs=1e-9)
    assert accuracy.relative.median_turn == pytest.approx(0.0, abs=1e-9)


def test_an_error_of_the_arms_shape_is_in_both():
    accuracy = tool_accuracy(CELL, known("j3.theta", "j2.a"), JOINTS)
    assert 1e-4 < accuracy.relative.median < accuracy.absolute.median


def test_the_ball_holds_95_percent_of_drawn_tools():
    names = ("j2.theta", "j3.a", "j5.alpha")
    accuracy = tool_accuracy(CELL, known(*names), JOINTS[:20])
    random = np.random.default_rng(1)
    here = CELL.poses(JOINTS[:20])[:, :3, 3]
    drawn = [CELL.corrected(dict(zip(names, map(float, x), strict=True))) for x in random.normal(0, 1e-3, (2000, 3))]
    away = np.array([np.linalg.norm(each.poses(JOINTS[:20])[:, :3, 3] - here, axis=1) for each in drawn])
    assert np.mean(away <= accuracy.absolute.pose.position_95) == pytest.approx(0.95, abs=0.01)


def test_what_the_readings_tell_is_the_share_of_the_prior_that_is_left():
    accuracy = tool_accuracy(CELL, known("j3.theta"), JOINTS)
    assert accuracy.absolute.remaining == pytest.approx(0.5)


def test_a_gauge_that_moves_the_tool_leaves_the_absolute_pose_undetermined():
    accuracy = tool_accuracy(CELL, known("j3.theta", "base.x", gauge=("base.x",)), JOINTS)
    assert not accuracy.absolute.determined
    assert np.isinf(accuracy.absolute.median)
    assert np.isfinite(accuracy.absolute.median_turn)
    assert np.isfinite(accuracy.relative.median)


def test_the_spin_about_the_beam_is_left_out_of_the_orientation():
    cell = replace(CELL, mount=Frame())
    accuracy = tool_accuracy(cell, known("j3.theta", "mount.yaw", std=1e-2, gauge=("mount.yaw",)), JOINTS)
    pose = accuracy.absolute.pose
    assert pose.beam_alone
    axes = np.abs(np.einsum("rij,rj->ri", pose.covariance[:, 3:, 3:], cell.poses(JOINTS)[:, :3, 2]))
    assert axes.max() < 1e-12
    assert 1e-3 < accuracy.absolute.median_turn < 2e-2


def test_a_mirrored_base_leaves_nothing_absolute():
    accuracy = tool_accuracy(CELL, known("j3.theta"), JOINTS, mirrored=True)
    assert np.isinf(accuracy.absolute.median)
    assert np.isinf(accuracy.absolute.median_turn)
    assert np.isfinite(accuracy.relative.median)


def test_the_models_own_error_widens_both():
    plain, widened = (tool_accuracy(CELL, replace(known("j3.theta"), model_std=std), JOINTS) for std in (0.0, 2e-3))
    assert widened.absolute.median > plain.absolute.median + 2e-3
    assert widened.relative.median > plain.relative.median + 2e-3
