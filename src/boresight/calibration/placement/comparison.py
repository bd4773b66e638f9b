"""How well a placement explains the readings once the geometry may be wrong too.

Nominal geometry leaves centimetres wherever the arm is placed, and a wrong placement may leave less by chance. With the
links free, held by their priors, the right one leaves the readings' noise.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from jaxtyping import Float

from boresight.calibration.campaign import Freedom
from boresight.calibration.freedom import link_candidates, usual_within
from boresight.calibration.problem import MISSED_M, Problem
from boresight.sensing import Cell, Readings

STEPS = 25
SOFT = 1.5
FIRST_DAMPING, WEAK = 1e-3, 1e-9
COUNTED = 0.7
"""Share of the values, those that fit best, that are counted: gross errors are not the placement's."""

OF_NORMAL = 0.5564
"""Root mean square of that share of standard normal numbers, the smallest of them."""


def unexplained(cell: Cell, readings: Readings, unknown: Iterable[str]) -> float:
    """Returns what the readings leave, with frames and links free, in stated standard deviations; priors counted.

    Args:
        cell: nominal, its frames where they were placed.
        readings: measured values, with their stated standard deviations.
        unknown: the frames' parameters.
    """
    within = usual_within(cell.arm)
    quantity = {parameter.name: parameter.quantity for parameter in cell.parameters}
    links = (
        Freedom(name, within[quantity[name]], within[quantity[name]] / math.sqrt(3.0))
        for name in link_candidates(cell.arm)
    )
    problem = Problem(cell, readings, (*(Freedom(name, None, None) for name in unknown), *links))
    x = _descended(problem)
    size = np.sort(np.abs(_residual(problem, x)))[: max(int(COUNTED * readings.count), 1)]
    return float(np.sqrt((np.sum(size**2) + np.sum((x / problem.prior_std) ** 2)) / len(size))) / OF_NORMAL


def _descended(problem: Problem) -> Float[np.ndarray, " parameters"]:
    """Returns corrections after some damped robust steps, the noise taken as large as the residuals are."""
    x, damping, precision = np.zeros(len(problem.names)), FIRST_DAMPING, 1.0 / problem.prior_std**2
    residual = _residual(problem, x)
    for _ in range(STEPS):
        spread = max(SOFT * float(np.median(np.abs(residual))), 1.0)
        columns = problem.sensitivity(x)[problem.readings.read.ravel()]
        weighted = columns / (spread**2 + residual**2)[:, None]
        matrix, pull = columns.T @ weighted, weighted.T @ residual + precision * x
        hold = precision + damping * np.diag(matrix) + WEAK * np.trace(matrix)
        moved = np.clip(x - np.linalg.solve(matrix + np.diag(hold), pull), -problem.half_width, problem.half_width)
        new = _residual(problem, moved)
        if _loss(new, moved, spread, precision) < _loss(residual, x, spread, precision):
            x, residual, damping = moved, new, 0.1 * damping
        else:
            damping *= 10.0
    return x


def _loss(residual: np.ndarray, x: np.ndarray, spread: float, precision: np.ndarray) -> float:
    return float(np.sum(np.log1p((residual / spread) ** 2)) + np.sum(precision * x**2))


def _residual(problem: Problem, x: Float[np.ndarray, " parameters"]) -> Float[np.ndarray, " values"]:
    errors = np.nan_to_num(problem.errors(x), nan=MISSED_M) / problem.std
    return np.asarray(errors[problem.readings.read])
