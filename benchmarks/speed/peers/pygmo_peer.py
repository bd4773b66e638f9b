"""pygmo (pagmo2, C++): `de`, and `sade`, which adapts F and CR, both of variant 8.

It asks for the cost of one member a call. Variant 8 is called rand-to-best/1/bin there, but its origin is the member
itself: our `current-to-best/1`. With its own variant `sade` ended case 1 at 5.6 to 5.9 mm RMS (three seeds) instead of
0.2 to 0.8, and `de1220`, which adapts the variant too, at 1.0 to 1.4.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.speed.cases import CROSSOVER, MEMBERS, SCALE, rms_mm
from benchmarks.speed.peers.costs import ScalarCost, compiled_cost, our_scalar_cost
from benchmarks.speed.timing import Entry
from boresight.calibration.problem import Problem

VARIANT = 8


class Asked:
    """The problem as pygmo asks for it."""

    def __init__(self, cost: ScalarCost, problem: Problem) -> None:
        self.cost, self.box = cost, problem.box

    def fitness(self, x: np.ndarray) -> tuple[float]:
        """Returns the cost of one member."""
        return (self.cost(x),)

    def get_bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Returns the box."""
        return self.box.lower, self.box.upper

    def __deepcopy__(self, memory: object) -> Asked:
        """Returns itself: nothing in it changes, and compiled functions are not copied."""
        return self


def entries(problem: Problem, generations: int) -> list[Entry]:
    """Returns `de` on two costs and `sade` on its own."""
    import pygmo

    limits = {"gen": generations, "ftol": 0.0, "xtol": 0.0}
    variant = {"variant": VARIANT}
    fixed = variant | {"F": SCALE, "CR": CROSSOVER}
    return [
        _entry(problem, pygmo.de, limits | fixed, "de, compiled cost", compiled_cost(problem)),
        _entry(problem, pygmo.de, limits | fixed, "de, our cost", our_scalar_cost(problem)),
        _entry(problem, pygmo.sade, limits | variant, "sade, compiled cost", compiled_cost(problem)),
    ]


def _entry(problem: Problem, algorithm: Any, settings: dict[str, Any], how: str, cost: ScalarCost) -> Entry:
    import pygmo

    asked = pygmo.problem(Asked(cost, problem))
    notes = "variant 8" if "F" in settings else "variant 8, adapts"

    def run(seed: int) -> float:
        population = pygmo.population(asked, MEMBERS, seed=seed)
        chosen = pygmo.algorithm(algorithm(seed=seed, **settings))
        ended = chosen.evolve(population)
        assert ended.problem.get_fevals() == MEMBERS * (settings["gen"] + 1), ended.problem.get_fevals()
        return rms_mm(float(ended.champion_f[0]), problem)

    return Entry(f"pygmo {how}", run, notes)
