"""Sets of rows that agree with each other: found among few rows, the same ones every time."""

from dataclasses import replace

import numpy as np
from rehearsed import rehearsed_campaign

from boresight.calibration.concentration import concentrated
from boresight.calibration.problem import Problem


def spoiled_problem(rows, wrong):
    campaign, _ = rehearsed_campaign(planes=3, rows=rows, seed=1)
    values = campaign.readings.values.copy()
    values[wrong, 0] += np.linspace(0.05, 0.4, len(wrong)) * np.where(np.arange(len(wrong)) % 2, 1, -1)
    return Problem(campaign.cell, replace(campaign.readings, values=values), campaign.freedoms)


def test_a_set_without_gross_errors_is_among_the_best():
    wrong = [2, 11, 20, 29]
    problem = spoiled_problem(40, wrong)
    sets = concentrated(problem, np.zeros(len(problem.names)))
    good = [np.max(np.abs(problem.errors(x)[rows])) for rows, x in sets if not rows[wrong].any()]
    assert min(good) < 0.005


def test_sets_are_the_same_every_time():
    problem = spoiled_problem(40, [3, 4])
    first, second = (concentrated(problem, np.zeros(len(problem.names))) for _ in range(2))
    assert all(np.array_equal(a[0], b[0]) and np.array_equal(a[1], b[1]) for a, b in zip(first, second, strict=True))


def test_fewer_readings_than_parameters_are_no_error():
    problem = spoiled_problem(6, [1])
    assert all(rows.any() for rows, _ in concentrated(problem, np.zeros(len(problem.names))))
