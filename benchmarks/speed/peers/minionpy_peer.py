"""minionpy (C++): its plain DE with F and CR as here, and L-SHADE and jSO, its strongest on this problem.

It hands over many members a call. L-SHADE (Tanabe & Fukunaga 2014) and jSO (Brest, Maučec & Bošković 2017) adapt F, CR
and the number of members by themselves, within the same number of evaluations.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.speed.cases import CROSSOVER, MEMBERS, SCALE, rms_mm
from benchmarks.speed.peers.costs import BatchCost, compiled_costs
from benchmarks.speed.timing import Entry
from boresight.calibration.problem import Problem

STRATEGY = "current_to_pbest1bin"
PLAIN: dict[str, Any] = {
    "population_size": MEMBERS,
    "mutation_strategy": STRATEGY,
    "mutation_rate": SCALE,
    "crossover_rate": CROSSOVER,
    "x_tol": -1.0,
}


ADAPTIVE: dict[str, Any] = {"x_tol": -1.0}


def entries(problem: Problem, generations: int) -> list[Entry]:
    """Returns DE on two costs, and L-SHADE and jSO on ours, the faster one."""
    cost: Any = problem.cost
    most = MEMBERS * (generations + 1)
    return [
        _entry(problem, most, "DE", "compiled cost", compiled_costs(problem), PLAIN, STRATEGY),
        _entry(problem, most, "DE", "our cost", cost, PLAIN, STRATEGY),
        _entry(problem, most, "LSHADE", "compiled cost", compiled_costs(problem), ADAPTIVE, "adapts"),
        _entry(problem, most, "LSHADE", "our cost", cost, ADAPTIVE, "adapts"),
        _entry(problem, most, "jSO", "our cost", cost, ADAPTIVE, "adapts"),
    ]


def _entry(
    problem: Problem, most: int, algorithm: str, how: str, cost: BatchCost, options: dict[str, Any], notes: str
) -> Entry:
    import minionpy

    bounds = list(zip(problem.box.lower, problem.box.upper, strict=True))

    def run(seed: int) -> float:
        spent, lowest = 0, np.inf

        def told(members: Any, *_: object) -> list[float]:
            nonlocal spent, lowest
            costs = cost(np.asarray(members, dtype=float))
            lowest = min(lowest, float(costs[: max(most - spent, 0)].min(initial=np.inf)))
            spent += len(costs)
            return costs.tolist()

        minionpy.Minimizer(told, bounds, algo=algorithm, maxevals=most, seed=seed, options=options).optimize()
        assert spent >= 0.99 * most, f"{algorithm} stopped after {spent:,} evaluations"
        return rms_mm(lowest, problem)

    return Entry(f"minionpy {algorithm}, {how}", run, notes)
