"""The roofline's operations against a sweep that runs, uncompiled, on numbers that count."""

from __future__ import annotations

import numpy as np
import pytest
from benchmarks.space_arm import draw, one_plane, three_planes
from benchmarks.speed.cases import plain
from benchmarks.speed.operations import operations
from counting import MATH, Counted

from boresight.kernels import building, carrying, sweeping, trigonometry
from boresight.kernels.lanes import tile
from boresight.kernels.programs import workspace
from boresight.sensing.compiled import compile_program, compile_rows

LANES = tile(np.float64)


@pytest.fixture
def uncompiled(monkeypatch):
    """Every compiled function replaced by the Python it is made of."""
    for module in (trigonometry, carrying, building, sweeping):
        for name, function in list(vars(module).items()):
            if hasattr(function, "py_func"):
                monkeypatch.setattr(module, name, function.py_func)
    monkeypatch.setattr(carrying, "math", MATH)
    monkeypatch.setattr(sweeping, "wide", lambda number: number)


def objects(array):
    return np.full(array.shape, 0.0, dtype=object)


@pytest.mark.parametrize("rows", [2, 6])
@pytest.mark.parametrize("kind", [one_plane, three_planes])
def test_operations_are_those_that_the_sweep_computes(kind, rows, uncompiled):
    problem = draw(kind(rows), 0).problem
    program = compile_program(problem.cell, problem.names, np.full(len(problem.names), 0.5))
    readings = compile_rows(problem.cell, problem.readings, np.ones(problem.readings.values.shape))
    work = type(workspace(program))(*(objects(array) for array in workspace(program)))
    drawn = np.random.default_rng(0).uniform(-1e-3, 1e-3, (len(problem.names), LANES))
    members, costs = np.vectorize(Counted, otypes=[object])(drawn), np.empty(LANES, dtype=object)
    Counted.operations = 0
    sweeping.sweep(program, readings, work, members, costs)
    unused = rows * LANES  # f - reading, which is the residual of an offset and not of a range: the compiler drops it
    assert Counted.operations - unused == operations(program, readings).of(LANES, rows)


def test_the_uncompiled_sweep_is_the_cost(uncompiled):
    problem = plain(35).on(np.arange(4))
    program = compile_program(problem.cell, problem.names, np.zeros(len(problem.names)))
    readings = compile_rows(problem.cell, problem.readings, np.ones(problem.readings.values.shape))
    drawn = np.random.default_rng(1).uniform(-1e-3, 1e-3, (len(problem.names), LANES))
    costs = np.empty(LANES)
    sweeping.sweep(program, readings, workspace(program), drawn, costs)
    errors = np.array([problem.errors(x) for x in drawn.T])
    np.testing.assert_allclose(costs, np.sum(errors**2, axis=(1, 2)), rtol=1e-9)
