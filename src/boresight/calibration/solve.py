"""From a problem to its optimum: evolution, least squares, or one after the other (paper, section 3.3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from boresight.calibration.problem import Problem, rms
from boresight.calibration.robust import Fit, fit, trimmed_cost
from boresight.calibration.thinning import thinned
from boresight.errors import BoresightError
from boresight.kernels.cuda.batches import Task
from boresight.search import CPU, Device, DifferentialEvolution, Evolved, Stops, evolve
from boresight.sensing.compiled import CompiledCost
from boresight.sensing.on_card import evolve_on_card, task_of

SolverName = Literal["evolution+least-squares", "evolution", "least-squares"]
SOLVERS: tuple[SolverName, ...] = ("evolution+least-squares", "evolution", "least-squares")

SAME_OPTIMUM = 0.05
"""Two searches ended at the same optimum where no parameter differs by more than this share of its standard
deviation."""

LOWER = 1e-4
"""One optimum is lower than another where its cost is lower by more than this share."""

Progress = Callable[[int, float], None]
Step = Callable[[str], None]


def unheard(what: str) -> None:
    """Does nothing with what is done next, where nobody wants to hear it."""


EVOLUTION, LEAST_SQUARES = "evolution", "least squares"
"""What a solver does, in words."""


@dataclass(frozen=True, slots=True)
class Solver:
    """How to search.

    Attributes:
        name: which stages to run.
        evolution: settings of the evolution.
        stops: limits of the evolution.
        seed: of all random numbers.
        device: where evolution runs; least squares runs on the processor.
    """

    name: SolverName = "evolution+least-squares"
    evolution: DifferentialEvolution = DifferentialEvolution()
    stops: Stops = Stops()
    seed: int = 0
    device: Device = CPU


@dataclass(frozen=True, slots=True)
class Stage:
    """One stage of a solution.

    Attributes:
        name: what ran.
        cost: squared residuals over the final variances, gross errors counted as the largest allowed, and priors:
            comparable between stages, and about the number of readings where all is well.
        rms_m: root of the mean squared error of the values used in the end [m], at this stage's end.
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
        fit: the best fit, its weights and what it leaves unexplained.
        stages: what ran, in order.
        history: (generations + 1, 2) best and mean cost [m²] of the evolution, empty without one.
        nominal: the stage that least squares from the nominal model alone would have been; None if not tried.
        nominal_suffices: whether it reached the same optimum.
    """

    fit: Fit
    stages: tuple[Stage, ...]
    history: Float[np.ndarray, "generations 2"]
    nominal: Stage | None
    nominal_suffices: bool | None


def solve(
    problem: Problem,
    solver: Solver,
    on_progress: Progress | None = None,
    evolved: Evolved | None = None,
    on_step: Step = unheard,
) -> Solution:
    """Returns the best fit that the solver finds; of two optima, the lower.

    Unless evolution is asked for alone, least squares from the nominal model runs too: it takes milliseconds and
    shows whether evolution was needed.

    Args:
        problem: what is fitted to what.
        solver: how.
        on_progress: called now and then with generations completed and the best cost, as if of all rows.
        evolved: the evolution, where it has run already.
        on_step: called with what is done next.
    """
    if solver.name == "least-squares":
        on_step(LEAST_SQUARES)
        direct = fit(problem, np.zeros(len(problem.names)))
        stage = _stage("least squares from the nominal model", direct, direct)
        return Solution(direct, (stage,), np.empty((0, 2)), stage, True)
    if evolved is None:
        on_step(EVOLUTION)
        evolved = _evolve(problem, solver, on_progress)
    on_step(LEAST_SQUARES)
    if solver.name == "evolution":
        found = fit(problem, evolved.best, move=False)
        return Solution(found, (_evolution(found, evolved),), evolved.history, None, None)
    direct, polished = fit(problem, np.zeros(len(problem.names))), fit(problem, evolved.best)
    before, after = (_compared(found, (polished, direct)) for found in (direct, polished))
    best = direct if before < (1.0 - LOWER) * after else polished
    stages = [_evolution(best, evolved), _stage("least squares from evolution's best", best, polished)]
    nominal = _stage("least squares from the nominal model", best, direct)
    if best is direct:
        stages.append(nominal)
    return Solution(best, tuple(stages), evolved.history, nominal, _same(best, direct))


def evolution_task(problem: Problem, solver: Solver) -> Task:
    """Returns a problem's evolution as a card is given it, on a few of its rows where there are many.

    Raises:
        BoresightError: its cost has no compiled form.
    """
    cost = _compiled_cost(problem.thinned(), solver)
    return task_of(cost, problem.box, solver.evolution, solver.seed)


def _evolve(problem: Problem, solver: Solver, on_progress: Progress | None) -> Evolved:
    few = problem.thinned()
    share = problem.readings.count / max(few.readings.count, 1)
    told = None if on_progress is None else lambda generation, lowest: on_progress(generation, share * lowest)
    if solver.device.on_card:
        return evolve_on_card([evolution_task(few, solver)], solver.device, solver.stops, told)[0]
    single = solver.device.precision == "single"
    cost = _compiled_cost(few, solver).single() if single else few.robust_cost
    cost.load(solver.evolution, problem.box)
    return evolve(cost, problem.box, solver.evolution, solver.stops, seed=solver.seed, on_progress=told)


def _compiled_cost(problem: Problem, solver: Solver) -> CompiledCost:
    """Returns a problem's cost where it is asked for in a way that only compiled ones know.

    Raises:
        BoresightError: it has no compiled form.
    """
    cost = problem.robust_cost
    if not isinstance(cost, CompiledCost):
        raise BoresightError(
            f"device {solver.device} cannot evolve readings of distances or point contacts: use device cpu in double "
            "precision, or least squares"
        )
    return cost


def continued_by(solution: Solution, further: Fit) -> Solution:
    """Returns the solution that ends with a fit of a larger model; earlier stages keep the costs of the smaller."""
    stage = _stage("least squares with what lies beyond geometry", further, further)
    return replace(solution, fit=further, stages=(*solution.stages, stage))


def _compared(found: Fit, both: tuple[Fit, Fit]) -> float:
    """Returns the trimmed cost of a fit, under the smaller of two standard deviations for both alike."""
    judge = min(both, key=lambda each: each.problem.model_std).problem
    return trimmed_cost(judge, found.x)


def _same(best: Fit, other: Fit) -> bool:
    """Returns whether two fits are one optimum, to a small part of the parameters' standard deviations."""
    std = np.sqrt(np.diag(best.problem.covariance(best.x)))
    return bool(np.all(np.abs(best.x - other.x) <= SAME_OPTIMUM * std))


def _stage(name: str, best: Fit, found: Fit) -> Stage:
    search = found.search
    return Stage(
        name,
        trimmed_cost(best.problem, found.x),
        _used_rms(best, found.x),
        search.seconds,
        search.evaluations,
        search.outcome.value,
    )


def _evolution(best: Fit, evolved: Evolved) -> Stage:
    few, rows = len(thinned(best.problem.readings)), len(best.problem.readings)
    return Stage(
        "evolution" if few == rows else f"evolution on {few:,} of {rows:,} rows",
        trimmed_cost(best.problem, evolved.best),
        _used_rms(best, evolved.best),
        evolved.seconds,
        evolved.evaluations,
        evolved.outcome.value,
    )


def _used_rms(best: Fit, x: Float[np.ndarray, "parameters"]) -> float:
    return rms(best.problem.errors(x)[best.kept])
