"""From a problem to its optimum: evolution, least squares, or one after the other (paper, section 3.3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from boresight.calibration.problem import Problem
from boresight.search import DifferentialEvolution, LeastSquares, Stops, evolve, least_squares

SolverName = Literal["evolution+least-squares", "evolution", "least-squares"]
SOLVERS: tuple[SolverName, ...] = ("evolution+least-squares", "evolution", "least-squares")

SAME_OPTIMUM = 1e-6
"""Two searches ended at the same optimum where their costs differ by less than this share."""

Progress = Callable[[int, float], None]


@dataclass(frozen=True, slots=True)
class Solver:
    """How to search.

    Attributes:
        name: which stages to run.
        evolution: settings of the evolution.
        stops: limits of the evolution.
        seed: of all random numbers.
    """

    name: SolverName = "evolution+least-squares"
    evolution: DifferentialEvolution = DifferentialEvolution()
    stops: Stops = Stops()
    seed: int = 0


@dataclass(frozen=True, slots=True)
class Stage:
    """One stage of a solution.

    Attributes:
        name: what ran.
        cost: sum of squared residuals over their standard deviations, priors included, at its end.
        rms_m: root of the mean squared error of a value [m] at its end.
        seconds: wall time.
        evaluations: how often the readings were predicted.
        outcome: why it ended, in words.
    """

    name: str
    cost: float
    rms_m: float
    seconds: float
    evaluations: int
    outcome: str


@dataclass(frozen=True)
class Solution:
    """Where the search ended.

    Attributes:
        x: (parameters,) corrections.
        cost: sum of squared residuals over their standard deviations, priors included.
        stages: what ran, in order.
        history: (generations + 1, 2) best and mean cost [m²] of the evolution, empty without one.
        nominal: the stage that least squares from the nominal model alone would have been; None if not tried.
        nominal_suffices: whether it reached the same optimum.
    """

    x: Float[np.ndarray, "parameters"]
    cost: float
    stages: tuple[Stage, ...]
    history: Float[np.ndarray, "generations 2"]
    nominal: Stage | None
    nominal_suffices: bool | None


def solve(problem: Problem, solver: Solver, on_progress: Progress | None = None) -> Solution:
    """Returns the best corrections that the solver finds; of two optima, the lower."""
    start = np.zeros(len(problem.names))
    if solver.name == "least-squares":
        found = refine(problem, start)
        stage = _stage(problem, "least squares from the nominal model", found)
        return Solution(found.best, found.cost, (stage,), np.empty((0, 2)), stage, True)
    evolved = evolve(
        problem.cost, problem.box, solver.evolution, solver.stops, seed=solver.seed, on_progress=on_progress
    )
    stage = Stage(
        "evolution",
        evolved.cost / problem.usual_std**2,
        rms(problem.errors(evolved.best)),
        evolved.seconds,
        evolved.evaluations,
        evolved.outcome.value,
    )
    if solver.name == "evolution":
        return Solution(evolved.best, stage.cost, (stage,), evolved.history, None, None)
    polished, direct = refine(problem, evolved.best), refine(problem, start)
    nominal = _stage(problem, "least squares from the nominal model", direct)
    stages: tuple[Stage, ...] = (stage, _stage(problem, "least squares from evolution's best", polished))
    best = polished
    if direct.cost < polished.cost * (1.0 - SAME_OPTIMUM):
        best, stages = direct, (*stages, nominal)
    suffices = direct.cost <= best.cost * (1.0 + SAME_OPTIMUM)
    return Solution(best.best, best.cost, stages, evolved.history, nominal, suffices)


def refine(problem: Problem, start: Float[np.ndarray, "parameters"], evaluations: int = 200) -> LeastSquares:
    """Returns the least-squares optimum reached from a start, inside the problem's bounds."""
    if not len(start):
        return LeastSquares.at(start, float(np.sum(problem.residual(start) ** 2)))
    return least_squares(
        problem.residual,
        problem.jacobian,
        start,
        scale=problem.scale,
        lower=-problem.half_width,
        upper=problem.half_width,
        evaluations=evaluations,
    )


def rms(errors: Float[np.ndarray, "*values"]) -> float:
    """Returns the root of the mean square of the finite errors; NaN if there are none."""
    finite = errors[np.isfinite(errors)]
    return float(np.sqrt(np.mean(finite**2))) if finite.size else float("nan")


def _stage(problem: Problem, name: str, found: LeastSquares) -> Stage:
    return Stage(
        name, found.cost, rms(problem.errors(found.best)), found.seconds, found.evaluations, found.outcome.value
    )
