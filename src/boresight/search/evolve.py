"""The loop that runs an evolution to its end, on any cost."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from boresight.search.box import Box
from boresight.search.evolution import DifferentialEvolution, Population, ask, seed_population, tell
from boresight.search.stopping import Outcome, Stops

_STRETCH_SECONDS = 0.1

Cost = Callable[[Float[np.ndarray, "members parameters"]], Float[np.ndarray, "members"]]
"""Returns the cost of every member."""


@dataclass(frozen=True, slots=True)
class Staleness:
    """How long the best member has not improved.

    Attributes:
        generations: generations since it last did.
        reference: the cost it is compared with.
    """

    generations: int = 0
    reference: float = np.inf

    def after(self, cost: float, improvement: float) -> Staleness:
        """Returns the staleness one generation later."""
        if cost < self.reference * (1.0 - improvement):
            return Staleness(0, cost)
        return Staleness(self.generations + 1, self.reference)


@dataclass(frozen=True)
class Stretch:
    """Some generations, run.

    Attributes:
        population: the population after them.
        staleness: how long its best has not improved.
        history: (generations, 2) best and mean cost after each.
    """

    population: Population
    staleness: Staleness
    history: Float[np.ndarray, "generations 2"]


@runtime_checkable
class CompiledCost(Protocol):
    """A cost that can also run generations without coming back to Python."""

    def __call__(self, members: Float[np.ndarray, "members parameters"]) -> Float[np.ndarray, "members"]:
        """Returns the cost of every member."""
        ...

    def advance(
        self,
        settings: DifferentialEvolution,
        box: Box,
        population: Population,
        staleness: Staleness,
        stops: Stops,
        generations: int,
    ) -> Stretch:
        """Returns the population some generations later, or at the first stop."""
        ...


@dataclass(frozen=True)
class Evolved:
    """The end of an evolution.

    Attributes:
        best: (parameters,) the best member found.
        cost: its cost.
        outcome: why it ended.
        population: the last population.
        history: (generations + 1, 2) best and mean cost, the first population's in row 0.
        evaluations: members evaluated.
        seconds: wall time.
    """

    best: Float[np.ndarray, "parameters"]
    cost: float
    outcome: Outcome
    population: Population
    history: Float[np.ndarray, "generations 2"]
    evaluations: int
    seconds: float


def evolve(
    cost: Cost | CompiledCost,
    box: Box,
    settings: DifferentialEvolution | None = None,
    stops: Stops | None = None,
    *,
    seed: int = 0,
    run: int = 0,
    on_progress: Callable[[int, float], None] | None = None,
) -> Evolved:
    """Returns the best member found (paper, section 3.3, steps 3 to 9).

    It comes back to Python about ten times a second, to report and so that it can be interrupted; the answer
    depends on the seed and the run alone.

    Args:
        cost: returns the cost of (members, parameters); NaN counts as worse than anything.
        box: where to search.
        settings: strategy, Np, F and CR; the paper's by default.
        stops: G, V and patience; the paper's by default.
        seed: any whole number.
        run: number of the run under that seed.
        on_progress: called now and then with generations completed and the best cost.
    """
    settings, stops = settings or DifferentialEvolution(), stops or Stops()
    started = time.perf_counter()
    population = seed_population(settings, box, seed, run)
    first = ask(settings, box, population)
    population = tell(population, first, cost(first))
    staleness = Staleness(0, population.best_cost)
    history = [np.array([[population.best_cost, float(np.mean(population.costs))]])]
    advance = cost.advance if isinstance(cost, CompiledCost) else _advance_by_calls(cost)
    outcome = stops.outcome(0, population.best_cost, 0)
    stretch = 1
    while outcome is Outcome.RUNNING:
        ahead = min(stretch, stops.generations - (population.generation - 1))
        began = time.perf_counter()
        done = advance(settings, box, population, staleness, stops, ahead)
        stretch = max(1, min(4 * stretch, int(stretch * _STRETCH_SECONDS / (time.perf_counter() - began + 1e-9))))
        population, staleness = done.population, done.staleness
        history.append(done.history)
        outcome = stops.outcome(population.generation - 1, population.best_cost, staleness.generations)
        if on_progress is not None:
            on_progress(population.generation - 1, population.best_cost)
    return Evolved(
        best=population.best,
        cost=population.best_cost,
        outcome=outcome,
        population=population,
        history=np.concatenate(history),
        evaluations=settings.population * population.generation,
        seconds=time.perf_counter() - started,
    )


def _advance_by_calls(cost: Cost) -> Callable[..., Stretch]:
    """Returns the plain loop: ask, evaluate, tell."""

    def advance(
        settings: DifferentialEvolution,
        box: Box,
        population: Population,
        staleness: Staleness,
        stops: Stops,
        generations: int,
    ) -> Stretch:
        history = []
        for _ in range(generations):
            trials = ask(settings, box, population)
            population = tell(population, trials, cost(trials))
            staleness = staleness.after(population.best_cost, stops.improvement)
            history.append((population.best_cost, float(np.mean(population.costs))))
            if population.best_cost <= stops.cost or staleness.generations >= stops.patience:
                break
        return Stretch(population, staleness, np.array(history))

    return advance
