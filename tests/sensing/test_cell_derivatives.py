"""The exact Jacobian against central differences of the prediction, for every kind of parameter."""

import numpy as np
import pytest

from random_cells import CONVENTIONS, random_arm, random_cell, random_corrections, random_joints, random_targets

STEP = 1e-6
RELATIVE = 1e-6


def numeric_jacobian(cell, joints, target, corrections):
    columns = []
    for parameter in range(len(corrections)):
        step = np.zeros_like(corrections)
        step[parameter] = STEP
        ahead = cell.predict(joints, target, corrections + step)
        behind = cell.predict(joints, target, corrections - step)
        columns.append((ahead - behind) / (2 * STEP))
    return np.stack(columns, axis=-1)


@pytest.mark.parametrize("bent", [False, True])
@pytest.mark.parametrize("sensor", ["laser_ranger", "position"])
@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("joints", [1, 3, 6, 8])
def test_jacobian_equals_finite_differences(joints, convention, sensor, bent):
    rng = np.random.default_rng([joints, CONVENTIONS.index(convention), sensor == "position", 5])
    arm = random_arm(rng, joints, convention)
    cell = random_cell(rng, planes=3, sensor=sensor, arm=arm.with_harmonics().with_sag() if bent else arm)
    readings, target = random_joints(rng, cell.arm, 40), random_targets(rng, cell, 40)
    normals = np.array([plane.normal for plane in cell.targets.values()])[target]
    steep = np.abs(np.sum(normals * cell.poses(readings)[:, :3, 2], axis=1)) > 0.3
    readings, target = readings[steep], target[steep]
    corrections = random_corrections(rng, cell, 0.003)
    values, jacobian = cell.linearise(readings, target, corrections)
    seen = ~np.isnan(values[:, 0])
    assert seen.sum() > 3
    numeric = numeric_jacobian(cell, readings, target, corrections)
    for parameter in range(len(corrections)):
        size = max(np.max(np.abs(numeric[seen, :, parameter])), 1e-2)
        error = np.max(np.abs(jacobian[seen, :, parameter] - numeric[seen, :, parameter]))
        assert error < RELATIVE * size, cell.parameters[parameter].name


def test_plane_of_another_row_moves_no_reading():
    rng = np.random.default_rng(9)
    cell = random_cell(rng, planes=3)
    readings, target = random_joints(rng, cell.arm, 30), random_targets(rng, cell, 30)
    _, jacobian = cell.linearise(readings, target)
    for place, name in enumerate(cell.targets):
        columns = [cell.index[p.name] for p in cell.parameters if p.name.startswith(f"{name}.")]
        assert np.all(jacobian[target != place][:, :, columns] == 0.0)
