"""pymoo's DE, whole populations of arrays: `best/1`, its default, mutation of its own besides.

It ended at 0.024 to 0.11 mm RMS in case 1 (three seeds), `target-to-best` at 2.0 to 3.0, `rand` at 2.9 to 3.5.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.speed.cases import CROSSOVER, MEMBERS, SCALE, rms_mm
from benchmarks.speed.peers.costs import numpy_cost
from benchmarks.speed.timing import Entry
from boresight.calibration.problem import Problem

VARIANT = "DE/best/1/bin"


def entries(problem: Problem, generations: int) -> list[Entry]:
    """Returns pymoo's DE on two costs."""
    cost: Any = problem.cost
    whole = numpy_cost(problem)
    return [
        _entry(problem, generations, "NumPy cost", lambda members: whole(np.ascontiguousarray(members.T))),
        _entry(problem, generations, "our cost", cost),
    ]


def _entry(problem: Problem, generations: int, how: str, cost: Callable[[np.ndarray], np.ndarray]) -> Entry:
    from pymoo.algorithms.soo.nonconvex.de import DE
    from pymoo.core.problem import Problem as Asked
    from pymoo.optimize import minimize

    class Ours(Asked):
        def __init__(self) -> None:
            super().__init__(n_var=len(problem.box), n_obj=1, xl=problem.box.lower, xu=problem.box.upper)

        def _evaluate(self, x: np.ndarray, out: dict, *args: Any, **kwargs: Any) -> None:
            out["F"] = cost(x)

    asked = Ours()

    def run(seed: int) -> float:
        algorithm = DE(pop_size=MEMBERS, variant=VARIANT, F=SCALE, CR=CROSSOVER)
        found = minimize(asked, algorithm, ("n_gen", generations + 1), seed=seed, copy_algorithm=False)
        assert found.algorithm.evaluator.n_eval == MEMBERS * (generations + 1), found.algorithm.evaluator.n_eval
        return rms_mm(float(found.F[0]), problem)

    return Entry(f"pymoo DE, {how}", run, "best/1, its default")
