"""SciPy's differential_evolution: `randtobest1bin`, our `rand-to-best/1`; it has no midpoint strategy.

Vectorised with deferred updating, or one member a call with immediate updating, its default. No polish, no early
stop, first population drawn uniform as ours is.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.speed.cases import CROSSOVER, MEMBERS, SCALE, rms_mm
from benchmarks.speed.peers.costs import compiled_cost, numpy_cost, our_scalar_cost
from benchmarks.speed.timing import Entry
from boresight.calibration.problem import Problem

STRATEGY = "randtobest1bin"


def entries(problem: Problem, generations: int) -> list[Entry]:
    """Returns SciPy on four costs."""
    cost: Any = problem.cost
    together: dict[str, Any] = {"vectorized": True, "updating": "deferred"}
    return [
        _entry(problem, generations, "vectorised, NumPy cost", numpy_cost(problem), together),
        _entry(problem, generations, "vectorised, our cost", lambda members: cost(members.T), together),
        _entry(problem, generations, "scalar, compiled cost", compiled_cost(problem), {}),
        _entry(problem, generations, "scalar, our cost", our_scalar_cost(problem), {}),
    ]


def _entry(problem: Problem, generations: int, how: str, cost: Callable[..., Any], options: dict[str, Any]) -> Entry:
    from scipy.optimize import differential_evolution

    lower, upper = problem.box.lower, problem.box.upper
    bounds = list(zip(lower, upper, strict=True))

    def run(seed: int) -> float:
        random = np.random.default_rng(seed)
        found = differential_evolution(
            cost, bounds, strategy=STRATEGY, init=random.uniform(lower, upper, (MEMBERS, len(bounds))), rng=random,
            maxiter=generations, tol=0.0, atol=0.0, mutation=SCALE, recombination=CROSSOVER, polish=False, **options,
        )  # fmt: skip
        assert found.nit == generations, (found.nit, found.nfev)
        return rms_mm(float(found.fun), problem)

    return Entry(f"SciPy DE, {how}", run, STRATEGY)
