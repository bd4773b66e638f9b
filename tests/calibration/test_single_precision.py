"""Evolution in single precision explores the same way, and least squares after it ends at the same digits."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import rehearsed_campaign

from boresight.calibration import Solver, calibrate
from boresight.calibration.campaign import Freedom
from boresight.calibration.problem import Problem
from boresight.calibration.solve import solve
from boresight.errors import BoresightError
from boresight.search import Device, DifferentialEvolution, Stops, evolve
from boresight.sensing import Cell, Distances
from boresight.synthetic import perturbed
from random_cells import SENSORS, near_readings, random_arm, random_cell

SINGLE = Device("cpu", "single")


def near_problem(sensor, rows=40):
    """Returns a small problem of a sensor: readings of an arm near the nominal one."""
    rng = np.random.default_rng([7, list(SENSORS).index(sensor)])
    cell = random_cell(rng, planes=3, sensor=sensor, arm=random_arm(rng, 4, "modified-dh"))
    names = [p.name for p in cell.parameters if p.quantity == "angle" and p.name.startswith("j")][:6]
    truth = perturbed(cell, dict.fromkeys(names, 0.01), seed=1)
    readings = near_readings(rng, truth, rows, 1e-4)
    return Problem(cell, readings, tuple(Freedom(name, 0.01, 0.01 / 3**0.5) for name in names))


@pytest.mark.parametrize("sensor", SENSORS)
def test_least_squares_ends_at_the_same_digits_whatever_the_sensor(sensor):
    problem = near_problem(sensor)
    settings = Solver(evolution=DifferentialEvolution(population=60), stops=Stops(150))
    double, single = (solve(problem, replace(settings, device=device)) for device in (Device(), SINGLE))
    assert single.history.shape == double.history.shape
    assert not np.array_equal(single.history, double.history)
    np.testing.assert_allclose(single.fit.x, double.fit.x, atol=1e-9)


@pytest.mark.parametrize("sensor", SENSORS)
def test_it_begins_on_the_path_of_double_precision(sensor):
    problem = near_problem(sensor)
    cost, box = problem.robust_cost, problem.box
    double, single = (evolve(each, box, stops=Stops(5), seed=3) for each in (cost, cost.single()))
    np.testing.assert_allclose(single.history[0], double.history[0], rtol=1e-3)
    np.testing.assert_allclose(single.population.members, double.population.members, atol=1e-6)
    assert single.population.members.dtype == single.history.dtype == np.float64


def test_the_result_says_what_evolution_ran_in_and_the_same_seed_gives_the_same_bits():
    campaign, _ = rehearsed_campaign(rows=40)
    first, again = (calibrate(campaign, Solver("evolution", device=SINGLE, seed=4)) for _ in range(2))
    assert np.array_equal(first.solution.fit.x, again.solution.fit.x)
    assert str(first.solver.device) == "cpu, single precision"


def test_distances_cannot_and_say_so():
    campaign, _ = rehearsed_campaign(rows=40)
    cell = Cell(campaign.cell.arm, Distances(1e-4))
    problem = Problem(cell, campaign.readings, (Freedom("j2.theta", 0.01, None),))
    with pytest.raises(BoresightError, match="cpu, single precision cannot evolve readings of distances"):
        solve(problem, Solver(device=SINGLE))
