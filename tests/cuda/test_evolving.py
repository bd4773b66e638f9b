"""Evolution on the card against evolution on the processor, which is held to the NumPy model elsewhere."""

from __future__ import annotations

import numpy as np
import pytest

from boresight.kernels.cuda import batches, running
from boresight.kernels.cuda.evolving import evolving_kernel
from boresight.search import STRATEGIES, Box, Device, DifferentialEvolution, Outcome, Stops, evolve
from boresight.sensing.compiled import CompiledCost, compile_program, compile_rows
from boresight.sensing.on_card import evolve_on_card, task_of
from random_cells import CONVENTIONS, mixed_cell, near_readings, random_arm, random_cell

MEMBERS, GENERATIONS = 8, 3
STOPS = Stops(GENERATIONS, patience=10**6)
DOUBLE, SINGLE = Device("cuda"), Device("cuda", "single")


def problem(rng, cell, rows=6, free=None, loss=0.0, half_width=0.02):
    """Returns a cost and its box."""
    names = [parameter.name for parameter in cell.parameters] if free is None else free
    readings = near_readings(rng, cell, rows, 0.05)
    weight = rng.uniform(0.5, 2.0, readings.values.shape)
    program = compile_program(cell, names, rng.uniform(0.0, 1.0, len(names)), loss)
    box = Box(np.full(len(names), -half_width), np.full(len(names), half_width))
    return CompiledCost(program, compile_rows(cell, readings, weight)), box


def both(cost, box, settings, device=DOUBLE, stops=STOPS, seed=5):
    there = evolve_on_card([task_of(cost, box, settings, seed)], device, stops)[0]
    return there, evolve(cost, box, settings, stops, seed=seed)


def assert_same_path(there, here, rtol):
    np.testing.assert_allclose(there.history, here.history, rtol=rtol)
    np.testing.assert_allclose(there.population.members, here.population.members, rtol=rtol, atol=rtol)
    np.testing.assert_allclose(there.population.costs, here.population.costs, rtol=rtol)
    assert there.evaluations == here.evaluations
    assert there.outcome is here.outcome


@pytest.mark.parametrize("sensor", ["laser_ranger", "position", "draw_wire"])
@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("joints", [1, 4])
def test_any_arm_takes_the_path_it_takes_on_the_processor(joints, convention, sensor):
    rng = np.random.default_rng([joints, CONVENTIONS.index(convention), len(sensor)])
    cell = random_cell(rng, planes=joints, sensor=sensor, arm=random_arm(rng, joints, convention))
    cost, box = problem(rng, cell)
    assert_same_path(*both(cost, box, DifferentialEvolution(population=MEMBERS)), rtol=1e-9)


@pytest.mark.parametrize("seed", range(2))
def test_every_sensor_on_two_markers_takes_the_same_path(seed):
    rng = np.random.default_rng([seed, 29])
    cost, box = problem(rng, mixed_cell(rng, random_arm(rng, 3)), rows=16)
    assert_same_path(*both(cost, box, DifferentialEvolution(population=MEMBERS)), rtol=1e-9)


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_every_strategy_takes_the_same_path(strategy):
    rng = np.random.default_rng(3)
    cost, box = problem(rng, random_cell(rng, planes=1, sensor="laser_ranger", arm=random_arm(rng, 2)), rows=4)
    settings = DifferentialEvolution(STRATEGIES[strategy], population=60 if strategy == "downhill" else MEMBERS)
    assert settings.breeding(box).elite == (2 if strategy == "downhill" else 1)
    assert_same_path(*both(cost, box, settings), rtol=1e-9)


def test_a_robust_loss_and_large_corrections_take_the_same_path():
    rng = np.random.default_rng(4)
    cell = random_cell(rng, planes=1, sensor="laser_ranger", arm=random_arm(rng, 3))
    free = [parameter.name for parameter in cell.parameters if parameter.quantity != "number"]
    cost, box = problem(rng, cell, free=free, loss=1e-4, half_width=0.9)
    assert_same_path(*both(cost, box, DifferentialEvolution(population=MEMBERS)), rtol=1e-9)


def test_single_precision_begins_on_the_same_path():
    rng = np.random.default_rng(5)
    cell = random_cell(rng, planes=2, sensor="position", arm=random_arm(rng, 4))
    cost, box = problem(rng, cell)
    assert_same_path(*both(cost, box, DifferentialEvolution(population=MEMBERS), SINGLE), rtol=1e-4)


def test_a_population_too_large_for_shared_memory_takes_the_same_path(monkeypatch):
    rng = np.random.default_rng(6)
    cost, box = problem(rng, random_cell(rng, planes=1, arm=random_arm(rng, 2)), rows=3)
    settings = DifferentialEvolution(population=MEMBERS + 1)
    expected, here = both(cost, box, settings)
    monkeypatch.setattr(batches, "SHARED_BYTES", 0)
    evolving_kernel.cache_clear()
    there, _ = both(cost, box, settings)
    evolving_kernel.cache_clear()
    assert_same_path(there, here, rtol=1e-9)
    np.testing.assert_array_equal(there.history, expected.history)


def test_more_members_than_threads_take_the_same_path(monkeypatch):
    rng = np.random.default_rng(7)
    cost, box = problem(rng, random_cell(rng, planes=1, arm=random_arm(rng, 1)), rows=2)
    monkeypatch.setattr(batches, "MOST_THREADS", 32)
    assert_same_path(*both(cost, box, DifferentialEvolution(population=70), stops=Stops(2)), rtol=1e-9)


def test_runs_of_several_shapes_come_back_in_their_order_and_in_stretches(monkeypatch):
    rng = np.random.default_rng(8)
    cells = [random_cell(rng, planes=1, sensor="laser_ranger", arm=random_arm(rng, joints)) for joints in (1, 2)]
    first, second = (problem(rng, cell, rows=3) for cell in cells)
    other, _ = problem(rng, cells[0], rows=3)
    settings = DifferentialEvolution(population=MEMBERS)
    asked = [(first, 1), (second, 2), ((other, first[1]), 3), (first, 4)]
    tasks = [task_of(*where, settings, seed) for where, seed in asked]
    heard = []
    monkeypatch.setattr(running, "_STRETCH_EVALUATIONS", 1.0)
    found = evolve_on_card(tasks, DOUBLE, STOPS, lambda generation, cost: heard.append((generation, cost)))
    for there, (where, seed) in zip(found, asked, strict=True):
        assert_same_path(there, evolve(*where, settings, STOPS, seed=seed), rtol=1e-9)
    assert [generation for generation, _ in heard] == [*range(GENERATIONS + 1)] * 2


@pytest.mark.parametrize("stops", [Stops(6, patience=1, improvement=0.5), Stops(6, cost=1e300)])
def test_it_stops_when_the_processor_does(stops):
    rng = np.random.default_rng(9)
    cost, box = problem(rng, random_cell(rng, planes=1, arm=random_arm(rng, 1)), rows=2)
    there, here = both(cost, box, DifferentialEvolution(population=MEMBERS), stops=stops)
    assert_same_path(there, here, rtol=1e-9)
    assert there.outcome in (Outcome.COST, Outcome.STAGNATION)
    assert len(there.history) < 7
