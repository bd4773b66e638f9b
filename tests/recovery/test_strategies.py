"""Strategies on the paper's case 1: compiled and plain loops agree, and who reaches the optimum with how much."""

from functools import cache

import numpy as np
import pytest

from boresight.arm import catalogue
from boresight.calibration.campaign import Freedom
from boresight.calibration.freedom import link_candidates
from boresight.calibration.problem import Problem
from boresight.geometry import Plane
from boresight.search import STRATEGIES, DifferentialEvolution, Stops, evolve, least_squares
from boresight.sensing import Cell, LaserRanger
from boresight.synthetic import draw_configurations, perturbed, simulated_readings

WITHIN = {"angle": 0.025, "length": 0.010, "number": 0.02}


@cache
def case1(seed: int) -> Problem:
    """Returns 35 ranges to one plane, 25 parameters, no priors."""
    arm, ranger = catalogue.load("space-arm"), LaserRanger(0.0002, repeats=10)
    cell = Cell(arm, ranger, targets={"deck": Plane.of((0.0, 1.0, 4.6), -0.69)})
    free = {*link_candidates(arm), "deck.normal_x", "deck.normal_z"} - {"j1.theta"}
    widths = {p.name: WITHIN[p.quantity] for p in cell.parameters if p.name in free}
    truth = perturbed(cell, widths, seed)
    joints, target = draw_configurations((cell, truth), 35, seed)
    freedoms = tuple(Freedom(name, widths[name], None) for name in cell.index if name in free)
    return Problem(cell, simulated_readings(truth, joints, target, seed), freedoms)


def rms_of_best(problem: Problem, strategy: str, evaluations: int) -> float:
    settings = DifferentialEvolution(STRATEGIES[strategy])
    generations = evaluations // settings.population - 1
    found = evolve(problem.cost, problem.box, settings, Stops(generations, patience=generations + 1), seed=1)
    assert found.evaluations <= evaluations
    return float(np.sqrt(np.mean(problem.errors(found.best) ** 2)))


def rms_of_optimum(problem: Problem) -> float:
    box = problem.box
    start = np.zeros(len(box))
    found = least_squares(problem.residual, problem.jacobian, start, scale=box.upper, lower=box.lower, upper=box.upper)
    return float(np.sqrt(np.mean(problem.errors(found.best) ** 2)))


@pytest.mark.parametrize("strategy", STRATEGIES.values(), ids=STRATEGIES)
def test_asking_and_telling_goes_the_way_of_the_compiled_loop(strategy):
    problem = case1(0)
    settings = DifferentialEvolution(strategy)
    compiled = evolve(problem.cost, problem.box, settings, Stops(40), seed=3)
    plain = evolve(lambda members: problem.cost(members), problem.box, settings, Stops(40), seed=3)
    assert np.array_equal(compiled.population.members, plain.population.members)
    assert np.array_equal(compiled.history[:, 0], plain.history[:, 0])


@pytest.mark.parametrize("seed", range(4))
def test_downhill_reaches_the_optimum_in_half_the_papers_evaluations_where_the_trade_off_does_not(seed):
    problem = case1(seed)
    optimum = rms_of_optimum(problem)
    assert rms_of_best(problem, "downhill", 37_500) < 1.01 * optimum
    assert rms_of_best(problem, "trade-off", 37_500) > 1.5 * optimum
