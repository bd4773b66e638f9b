"""The compiled model against the NumPy one, over everything a cell can be."""

import numpy as np
import pytest

from boresight.sensing.linear import CompiledModel, ReferenceModel, model_of, slopes_of
from random_cells import SENSORS, compiled_names, mixed_cell, near_readings, random_arm, random_cell


def some(rng, cell):
    names = compiled_names(cell)
    rng.shuffle(names)
    return names[: rng.integers(1, len(names) + 1)]


@pytest.mark.parametrize("sensor", ["laser_ranger", "position", "plane_contact"])
@pytest.mark.parametrize("seed", range(12))
def test_compiled_errors_and_derivatives_equal_numpys(sensor, seed):
    rng = np.random.default_rng([seed, list(SENSORS).index(sensor)])
    cell = random_cell(rng, planes=3, sensor=sensor)
    free = some(rng, cell)
    readings = near_readings(rng, cell, 60, 0.02)
    x = rng.normal(size=len(free)) * 0.01
    compiled, reference = CompiledModel(cell, readings, free), ReferenceModel(cell, readings, free)
    assert isinstance(model_of(cell, readings, free), CompiledModel)
    errors, expected = compiled.errors(x), reference.errors(x)
    assert np.array_equal(np.isnan(errors), np.isnan(expected))
    hit = np.isfinite(expected)
    np.testing.assert_allclose(errors[hit], expected[hit], rtol=1e-9, atol=1e-11)
    slopes, numpys = slopes_of(compiled, x, readings), slopes_of(reference, x, readings)
    size = 1.0 + np.abs(numpys).max(axis=2, keepdims=True)
    assert np.abs((slopes - numpys) / size).max() < 1e-9


def test_cells_that_cannot_be_compiled_are_left_to_numpy():
    rng = np.random.default_rng(4)
    mixed = mixed_cell(rng, random_arm(rng, 6))
    bent = random_cell(rng, sensor="laser_ranger", arm=random_arm(rng, 6).with_harmonics())
    for cell in (mixed, bent):
        readings = near_readings(rng, cell, 30, 0.02)
        assert isinstance(model_of(cell, readings, some(rng, cell)), ReferenceModel)
