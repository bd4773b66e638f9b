"""The model's own error, widened until held-out configurations lie within what is expected of them."""

import numpy as np
import pytest
from rehearsed import measured, ranger_cell, usual_freedoms

from boresight.calibration.holdout import HeldOut
from boresight.calibration.model_error import FEWEST, model_error
from boresight.calibration.problem import Problem
from boresight.calibration.robust import fit

CELL = ranger_cell(planes=3)
ROWS = measured(CELL, rows=400, seed=9)
EXPECTED_M = 1e-4


def found():
    freedoms = usual_freedoms(CELL)
    return fit(Problem(CELL, measured(CELL, rows=80), freedoms), np.zeros(len(freedoms)))


def held_out(errors):
    rows = len(errors)
    return HeldOut("validation rows", errors, errors, np.arange(rows), np.full(rows, EXPECTED_M**2))


@pytest.mark.parametrize("times", [3.0, 8.0])
def test_it_makes_up_for_what_held_out_rows_show(times):
    errors = np.abs(np.random.default_rng(0).normal(0.0, times * EXPECTED_M, 400))
    told = model_error(found(), held_out(errors), ROWS)
    widened = np.hypot(told, EXPECTED_M)
    assert widened == pytest.approx(times * EXPECTED_M, rel=0.12)
    assert np.mean(errors <= 1.96 * widened) == pytest.approx(0.95, abs=0.03)


def test_rows_as_good_as_expected_show_none():
    for seed in range(10):
        errors = np.abs(np.random.default_rng(seed).normal(0.0, EXPECTED_M, 400))
        assert model_error(found(), held_out(errors), ROWS) == 0.0


def test_few_configurations_are_believed_only_by_their_mean_square():
    errors = np.full(FEWEST - 5, 1.3 * EXPECTED_M)
    assert model_error(found(), held_out(errors), ROWS.chosen(slice(0, len(errors)))) == 0.0
    errors *= 4.0
    assert model_error(found(), held_out(errors), ROWS.chosen(slice(0, len(errors)))) > 4.0 * EXPECTED_M
