"""The compiled model against the NumPy one, over everything a cell can be."""

import pytest

from boresight.sensing import Readings
from boresight.sensing.linear import CompiledModel
from random_cells import random_cell, random_joints, random_targets


def some(rng, cell):
    names = [parameter.name for parameter in cell.parameters]
    rng.shuffle(names)
    return names[: rng.integers(1, len(names) + 1)]


@pytest.mark.parametrize("sensor", ["laser_ranger", "position"])
@pytest.mark.parametrize("seed", range(12))
def test_compiled_readings_and_derivatives_equal_numpys(sensor, seed):
    rng = np.random.default_rng([seed, sensor == "position"])
    cell = random_cell(rng, planes=3, sensor=sensor)
    free = some(rng, cell)
    columns = [cell.index[name] for name in free]
    joints, target = random_joints(rng, cell.arm, 60), random_targets(rng, cell, 60)
    x = rng.normal(size=len(free)) * 0.01
    corrections = np.zeros(len(cell.parameters))
    corrections[columns] = x
    values, jacobian = cell.linearise(joints, target, corrections)
    readings = Readings(joints, np.zeros_like(values), np.ones_like(values), target, np.arange(60))
    model = CompiledModel(cell, readings, free)
    compiled, slopes = model.linearise(x)
    assert np.array_equal(np.isnan(compiled), np.isnan(values))
    hit = np.isfinite(values)
    np.testing.assert_allclose(compiled[hit], values[hit], rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(model.predict(x)[hit], values[hit], rtol=1e-10, atol=1e-12)
    size = 1.0 + np.abs(jacobian).max(axis=2, keepdims=True)
    assert np.abs((slopes - np.nan_to_num(jacobian)[:, :, columns]) / size)[hit].max(initial=0.0) < 1e-10
    assert not slopes[~hit].any()
