"""Drawn configurations see their targets; draws hang on their seed alone."""

import numpy as np
import pytest

from boresight.arm import catalogue
from boresight.errors import InputError
from boresight.geometry import Plane
from boresight.sensing import Cell, LaserRanger
from boresight.synthetic import draw_configurations, perturbed, simulated_readings
from boresight.synthetic.readings import GRAZING, NEAREST_M
from random_cells import random_cell

PLANES = {"deck": Plane.of((0.0, 1.0, 4.6), -0.69), "wall": Plane.of((-1.0, 0.15, 0.2), 1.6)}


def cell_of(arm):
    return Cell(catalogue.load(arm), LaserRanger(2e-4), targets=PLANES)


@pytest.mark.parametrize("arm", catalogue.names())
def test_every_beam_meets_its_plane_well_in_front_and_within_limits(arm):
    cell = cell_of(arm)
    joints, target = draw_configurations((cell,), 40, seed=1)
    ranges = cell.predict(joints, target)[:, 0]
    assert np.all(ranges > NEAREST_M)
    for row, place in enumerate(target):
        normal = np.array(list(PLANES.values())[place].normal)
        assert abs(cell.poses(joints[row : row + 1])[0, :3, 2] @ normal) > GRAZING
    low, high = cell.arm.limits.T
    assert np.all((joints >= low) & (joints <= high))


def test_targets_take_turns():
    _, target = draw_configurations((cell_of("space-arm"),), 7, seed=0)
    assert target.tolist() == [0, 1, 0, 1, 0, 1, 0]


def test_parts_of_a_seed_are_different_and_seeds_replay():
    cell = cell_of("space-arm")
    one, two, other = (draw_configurations((cell,), 10, 5, part)[0] for part in (0, 0, 1))
    assert np.array_equal(one, two)
    assert not np.array_equal(one, other)


def test_a_plane_out_of_sight_is_told_with_what_to_check():
    cell = Cell(catalogue.load("space-arm"), LaserRanger(2e-4), targets={"sky": Plane.of((0.0, 0.0, 1.0), 0.0)})
    low = Cell(cell.arm, cell.sensor, targets={"sky": Plane.of((0.0, 0.0, 1.0), 1e9)})
    drawn, _ = draw_configurations((low,), 4, seed=0)  # far away is still in sight
    assert len(drawn) == 4
    contrary = Cell(cell.arm, cell.sensor, targets={"sky": Plane.of((0.0, 0.0, 1.0), -1e9)})
    with pytest.raises(InputError, match="hardly any configuration within the joints' limits sees target 'sky'"):
        draw_configurations((low, contrary), 4, seed=0)


def test_perturbed_cells_are_off_by_no_more_than_their_widths():
    cell = random_cell(np.random.default_rng(0))
    widths = {"j1.theta": 0.01, "plane0.offset": 0.002}
    truth = perturbed(cell, widths, seed=1)
    for name, value in truth.values.items():
        assert abs(value - cell.values[name]) <= widths.get(name, 0.0) + 1e-15


def test_noise_has_the_stated_standard_deviation_and_no_bias():
    cell = cell_of("space-arm")
    joints, target = draw_configurations((cell,), 3000, seed=2)
    errors = (simulated_readings(cell, joints, target, seed=9).values - cell.predict(joints, target))[:, 0]
    assert abs(errors.mean()) < 4 * 2e-4 / np.sqrt(3000)
    assert errors.std() == pytest.approx(2e-4, rel=0.06)
