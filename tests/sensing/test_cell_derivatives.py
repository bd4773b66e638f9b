"""The exact Jacobian against central differences of the prediction, for every kind of parameter."""

import numpy as np
import pytest

from boresight.sensing import Aim, Cell, Distances
from random_cells import (
    CONVENTIONS,
    SENSORS,
    mixed_cell,
    near_readings,
    random_arm,
    random_cell,
    random_corrections,
    random_frame,
    random_joints,
    random_point,
    random_targets,
)

STEP = 1e-6
RELATIVE = 1e-6


def numeric_jacobian(cell, readings, corrections):
    columns = []
    for parameter in range(len(corrections)):
        step = np.zeros_like(corrections)
        step[parameter] = STEP
        ahead = cell.errors(readings, corrections + step)
        behind = cell.errors(readings, corrections - step)
        columns.append((ahead - behind) / (2 * STEP))
    return np.stack(columns, axis=-1)


def assert_jacobian_is_numeric(rng, cell):
    readings = near_readings(rng, cell, 40, 0.02)
    corrections = random_corrections(rng, cell, 0.003)
    seen = ~np.isnan(cell.errors(readings, corrections)).any(axis=1)
    assert seen.sum() > 3
    numeric, jacobian = numeric_jacobian(cell, readings, corrections), cell.slopes(readings, corrections)
    for parameter in range(len(corrections)):
        size = max(np.max(np.abs(numeric[seen, :, parameter])), 1e-2)
        error = np.max(np.abs(jacobian[seen, :, parameter] - numeric[seen, :, parameter]))
        assert error < RELATIVE * size, cell.parameters[parameter].name


@pytest.mark.parametrize("bent", [False, True])
@pytest.mark.parametrize("sensor", SENSORS)
@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("joints", [1, 3, 6, 8])
def test_jacobian_equals_finite_differences(joints, convention, sensor, bent):
    rng = np.random.default_rng([joints, CONVENTIONS.index(convention), sensor == "position", 5])
    arm = random_arm(rng, joints, convention)
    arm = arm.with_harmonics().with_sag() if bent else arm
    assert_jacobian_is_numeric(rng, random_cell(rng, planes=3, sensor=sensor, arm=arm))


@pytest.mark.parametrize("seed", range(3))
def test_jacobian_equals_finite_differences_with_every_sensor_on_two_markers(seed):
    rng = np.random.default_rng(seed)
    assert_jacobian_is_numeric(rng, mixed_cell(rng, random_arm(rng, 6)))


def test_jacobian_of_distances_equals_finite_differences():
    rng = np.random.default_rng(8)
    cell = Cell(random_arm(rng, 6), Distances(1e-4), random_frame(rng), random_frame(rng))
    assert_jacobian_is_numeric(rng, cell)


def test_session_has_an_offset_of_its_own():
    rng = np.random.default_rng(3)
    arm = random_arm(rng, 6)
    cell = Cell(
        arm,
        SENSORS["draw_wire"],
        mount=random_frame(rng),
        targets={"anchor": random_point(rng)},
        listed_aims=(Aim("sensor", "mount", "anchor", "monday"), Aim("sensor", "mount", "anchor", "tuesday")),
        offsets={"sensor.bias[monday]": 0.0, "sensor.bias[tuesday]": 0.25},
    )
    assert_jacobian_is_numeric(rng, cell)
    joints = random_joints(rng, arm, 5)
    monday, tuesday = (cell.predict(joints, np.full(5, place)) for place in (0, 1))
    np.testing.assert_allclose(tuesday - monday, 0.25, atol=1e-15)
    moved = cell.corrected({"sensor.bias[monday]": 0.1})
    np.testing.assert_allclose(moved.predict(joints, np.zeros(5, dtype=int)), monday + 0.1, atol=1e-15)


def test_plane_of_another_row_moves_no_reading():
    rng = np.random.default_rng(9)
    cell = random_cell(rng, planes=3)
    readings, target = random_joints(rng, cell.arm, 30), random_targets(rng, cell, 30)
    _, jacobian = cell.linearise(readings, target)
    for place, name in enumerate(cell.targets):
        columns = [cell.index[p.name] for p in cell.parameters if p.name.startswith(f"{name}.")]
        assert np.all(jacobian[target != place][:, :, columns] == 0.0)
