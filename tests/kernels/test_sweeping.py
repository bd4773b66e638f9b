"""The compiled cost against the NumPy reference, over everything a cell can be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from boresight.arm import Arm
from boresight.kernels.lanes import padded, tile
from boresight.kernels.programs import MISSED, in_precision, workspace
from boresight.kernels.sweeping import sweep
from boresight.sensing.compiled import compile_program, compile_rows
from random_cells import (
    CONVENTIONS,
    SENSORS,
    compiled_names,
    mixed_cell,
    near_readings,
    random_arm,
    random_cell,
    random_corrections,
    random_frame,
)

LANES = tile(np.float64)
RELATIVE, RELATIVE_SINGLE = 1e-12, 1e-3
"""A range of metres is known to a micrometre in single precision, and residuals here are of centimetres."""


def compiled_costs(cell, readings, weight, free, prior_weight, members, real=np.float64):
    """Returns the costs of (free, members) corrections, padded to whole tiles with copies of the first."""
    count = members.shape[1]
    lanes = np.repeat(members[:, :1], padded(count, real), axis=1).astype(real)
    lanes[:, :count] = members
    costs = np.full(padded(count, real), np.nan)
    program = in_precision(compile_program(cell, free, prior_weight), real)
    sweep(program, in_precision(compile_rows(cell, readings, weight), real), workspace(program), lanes, costs)
    return costs[:count], costs[count:]


def reference_cost(cell, readings, weight, free, prior_weight, member):
    """Returns the cost of one member by `Cell.predict`."""
    corrections = np.zeros(len(cell.parameters))
    corrections[[cell.index[name] for name in free]] = member
    residual = cell.errors(readings, corrections)
    residual = np.where(np.isnan(residual), MISSED, residual)
    squares = np.sum(np.where(readings.read, weight * residual**2, 0.0))
    for row in np.flatnonzero(readings.channels == 6):  # the sum over turns is that over components of the rotation
        pose = cell.poses(readings.joints, corrections, readings.target)[row]
        lever = cell.sensors[cell.aims[readings.target[row]].sensor].lever
        components = lever * (pose[:3, :3] - readings.reference[row])
        squares += np.sum(weight[row, 3:] * (0.5 * np.sum(components**2, axis=0) - residual[row, 3:] ** 2))
    return squares + np.sum(prior_weight * member**2)


def assert_equal_costs(rng, cell, rows, count, free):
    readings = near_readings(rng, cell, rows, 0.05)
    weight = rng.uniform(0.1, 10.0, readings.values.shape)
    prior_weight = rng.uniform(0.0, 100.0, len(free))
    members = np.array([random_corrections(rng, cell)[: len(free)] for _ in range(count)]).T
    costs, spare = compiled_costs(cell, readings, weight, free, prior_weight, members)
    expected = [reference_cost(cell, readings, weight, free, prior_weight, member) for member in members.T]
    np.testing.assert_allclose(costs, expected, rtol=RELATIVE, atol=0)
    assert np.all(spare == costs[0])
    singles, spare = compiled_costs(cell, readings, weight, free, prior_weight, members, np.float32)
    np.testing.assert_allclose(singles, expected, rtol=RELATIVE_SINGLE, atol=0)
    assert np.all(spare == singles[0])


@pytest.mark.parametrize("sensor", SENSORS)
@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("joints", [1, 2, 3, 6, 8])
def test_compiled_cost_equals_numpy_with_every_parameter_free(joints, convention, sensor):
    rng = np.random.default_rng([joints, CONVENTIONS.index(convention), sensor == "position"])
    cell = random_cell(rng, planes=int(rng.integers(1, 4)), sensor=sensor, arm=random_arm(rng, joints, convention))
    free = compiled_names(cell)
    assert_equal_costs(rng, cell, rows=30, count=int(rng.integers(1, 3 * LANES)), free=free)


@pytest.mark.parametrize("seed", range(10))
def test_compiled_cost_equals_numpy_with_some_parameters_free_in_any_order(seed):
    rng = np.random.default_rng([seed, 17])
    cell = random_cell(rng, planes=2)
    names = compiled_names(cell)
    free = [str(name) for name in rng.permutation(names)[: int(rng.integers(1, len(names)))]]
    assert_equal_costs(rng, cell, rows=20, count=int(rng.integers(1, 40)), free=free)


@pytest.mark.parametrize("seed", range(3))
def test_compiled_cost_equals_numpy_with_joints_that_follow_and_frames_at_both_ends(seed):
    rng = np.random.default_rng([seed, 23])
    drawn = random_arm(rng, 5)
    joints = list(drawn.joints)
    for place in (2, 4):
        leader = joints[place - 1].name if place == 2 else joints[0].name
        joints[place] = replace(joints[place], follows=leader, ratio=float(rng.uniform(-2.0, 2.0)))
    arm = Arm("geared", tuple(joints), drawn.convention, random_frame(rng), random_frame(rng))
    cell = random_cell(rng, planes=2, arm=arm)
    free = compiled_names(cell)
    assert_equal_costs(rng, cell, rows=30, count=2 * LANES, free=free)


@pytest.mark.parametrize("seed", range(5))
def test_compiled_cost_equals_numpy_with_every_sensor_on_two_markers(seed):
    rng = np.random.default_rng([seed, 29])
    cell = mixed_cell(rng, random_arm(rng, 6))
    names = compiled_names(cell)
    free = [str(name) for name in rng.permutation(names)[: int(rng.integers(1, len(names)))]]
    assert_equal_costs(rng, cell, rows=60, count=50, free=free)


def test_compiled_cost_equals_numpy_where_corrections_outgrow_the_unit_normal():
    rng = np.random.default_rng(3)
    cell = random_cell(rng, planes=1)
    readings = near_readings(rng, cell, 20, 0.05)
    plane = compiled_names(cell)[-3:]
    members = rng.uniform(-1.5, 1.5, (3, 50))
    weight, prior_weight = np.ones(readings.values.shape), np.zeros(3)
    costs, _ = compiled_costs(cell, readings, weight, plane, prior_weight, members)
    expected = [reference_cost(cell, readings, weight, plane, prior_weight, member) for member in members.T]
    np.testing.assert_allclose(costs, expected, rtol=RELATIVE, atol=0)


def test_missed_beam_never_improves_the_best():
    rng = np.random.default_rng(11)
    cell = random_cell(rng, planes=1, arm=random_arm(rng, 6))
    readings = near_readings(rng, cell, 60, 0.05)
    missed = np.isnan(cell.predict(readings.joints, readings.target)[:, 0])
    assert 0 < missed.sum() < len(missed)
    weight = rng.uniform(0.5, 2.0, readings.values.shape)
    still = np.zeros((1, 1))
    all_missed, _ = compiled_costs(cell, readings.chosen(missed), weight[missed], ["j1.theta"], np.zeros(1), still)
    np.testing.assert_allclose(all_missed, MISSED**2 * weight[missed].sum(), rtol=RELATIVE)
    none_missed, _ = compiled_costs(cell, readings.chosen(~missed), weight[~missed], ["j1.theta"], np.zeros(1), still)
    assert none_missed[0] < MISSED**2 * weight.min()


def test_cost_of_a_member_does_not_depend_on_its_lane_or_neighbours():
    rng = np.random.default_rng(23)
    cell = random_cell(rng)
    readings = near_readings(rng, cell, 25, 0.05)
    free = compiled_names(cell)
    weight, prior_weight = np.ones(readings.values.shape), np.ones(len(free))
    members = np.array([random_corrections(rng, cell) for _ in range(70)]).T
    order = rng.permutation(70)
    straight, _ = compiled_costs(cell, readings, weight, free, prior_weight, members)
    shuffled, _ = compiled_costs(cell, readings, weight, free, prior_weight, members[:, order])
    assert np.array_equal(straight[order], shuffled)
