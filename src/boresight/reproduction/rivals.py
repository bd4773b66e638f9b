"""Others' searches on the same data: least squares from the nominal model, and modern differential evolution."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.calibration.problem import Problem
from boresight.reproduction.setting import STOPS
from boresight.reproduction.variants import MODERN
from boresight.search import LeastSquares, least_squares

EVALUATIONS = 150 * (STOPS.generations + 1)
"""Evaluations of the paper's search: 150 members, 500 generations after the first."""


@dataclass(frozen=True)
class Found:
    """Where a search ended.

    Attributes:
        x: (parameters,) corrections.
        evaluations: how often the cost was evaluated.
        seconds: wall time.
    """

    x: Float[np.ndarray, "parameters"]
    evaluations: int
    seconds: float


def from_nominal(problem: Problem) -> LeastSquares:
    """Returns the nearest minimum within the scopes, from the nominal model, with the exact Jacobian."""
    start = np.zeros(len(problem.names))
    lower, upper = problem.box.lower, problem.box.upper
    return least_squares(problem.residual, problem.jacobian, start, scale=problem.scale, lower=lower, upper=upper)


def modern(problem: Problem, name: str, seed: int) -> Found:
    """Returns where L-SHADE or jSO ends, as minionpy has them, given our compiled cost and the same evaluations.

    Their defaults are kept but for the tolerance on the population's spread, which would end them sooner. Parameters
    are scaled to ±1, and the cost is in mm².
    """
    import minionpy  # an extra

    half = problem.box.upper
    began = time.perf_counter()
    found = minionpy.Minimizer(
        lambda members: (1e6 * problem.cost(np.array(members) * half)).tolist(),
        [(-1.0, 1.0)] * len(half),
        algo=MODERN[name],
        maxevals=EVALUATIONS,
        seed=seed % 2**31,
        options={"x_tol": -1.0, "f_tol": -1.0},
    ).optimize()
    return Found(np.array(found.x) * half, int(found.nfev), time.perf_counter() - began)
