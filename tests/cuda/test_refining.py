"""Least squares on the card against SciPy's on the NumPy model, and against the processor's compiled cost."""

from __future__ import annotations

import os

import numpy as np
import pytest
from scipy.optimize import least_squares

from boresight.errors import BoresightError
from boresight.kernels.cuda import refining
from boresight.kernels.programs import MISSED
from boresight.sensing.compiled import CompiledCost, compile_program, compile_rows
from boresight.sensing.on_card import refine_on_card
from random_cells import CONVENTIONS, compiled_names, near_readings, random_arm, random_cell, random_corrections

SIMULATED = os.environ.get("NUMBA_ENABLE_CUDASIM") == "1"


def problem(rng, cell, rows, share=1.0, loss=0.0):
    """Returns a cost, the same as residuals by NumPy, and a start."""
    names = [name for name in compiled_names(cell) if rng.random() < share]
    columns = [cell.index[name] for name in names]
    readings = near_readings(rng, cell, 40 * rows, 0.002)
    hits = np.flatnonzero(np.isfinite(cell.errors(readings)).all(axis=1))
    readings = readings.chosen(hits[:rows])
    assert len(readings) == rows
    weight, prior = rng.uniform(0.5, 2.0, readings.values.shape), rng.uniform(1e-3, 1e-2, len(names))
    cost = CompiledCost(compile_program(cell, names, prior, loss), compile_rows(cell, readings, weight))

    def residual(x):
        full = np.zeros(len(cell.parameters))
        full[columns] = x
        errors = np.nan_to_num(cell.errors(readings, full), nan=MISSED)
        return np.concatenate([(np.sqrt(weight) * errors).ravel(), np.sqrt(prior) * x])

    return cost, residual, 0.1 * random_corrections(rng, cell)[columns]


@pytest.fixture(autouse=True)
def few_threads(monkeypatch):
    """Simulated threads are those of Python: with 8 of them in place of 64 these tests take seconds."""
    if SIMULATED:
        monkeypatch.setattr(refining, "WARP", 4)


@pytest.mark.parametrize(("sensor", "convention"), [("laser_ranger", CONVENTIONS[1]), ("position", CONVENTIONS[0])])
def test_it_ends_where_scipy_ends(convention, sensor):
    rng = np.random.default_rng([CONVENTIONS.index(convention), len(sensor)])
    cell = random_cell(rng, planes=2, sensor=sensor, arm=random_arm(rng, 2, convention))
    asked = [problem(rng, cell, rows=9, share=0.6) for _ in range(1)]
    found = refine_on_card([cost for cost, _, _ in asked], [start for _, _, start in asked])
    for (cost, residual, start), end in zip(asked, found, strict=True):
        expected = least_squares(residual, start, jac="3-point", xtol=1e-15, ftol=1e-15, gtol=1e-15)
        assert 0 < end.steps < 50
        assert end.cost == pytest.approx(float(cost(end.x[None])[0]), rel=1e-9)
        assert end.cost <= 2.0 * expected.cost * (1.0 + 1e-7)
        std = np.sqrt(np.diag(np.linalg.inv(expected.jac.T @ expected.jac)) * 2.0 * expected.cost)
        np.testing.assert_array_less(np.abs(end.x - expected.x), 1e-3 * std + 1e-12)


def test_what_it_cannot_refine_is_refused():
    rng = np.random.default_rng(2)
    robust, _, start = problem(rng, random_cell(rng, planes=1, arm=random_arm(rng, 2)), rows=4, loss=1e-4)
    with pytest.raises(BoresightError, match="plain squares"):
        refine_on_card([robust], [start])
    wire, _, start = problem(rng, random_cell(rng, planes=1, sensor="draw_wire", arm=random_arm(rng, 2)), rows=4)
    with pytest.raises(BoresightError, match="plain squares"):
        refine_on_card([wire], [start])
