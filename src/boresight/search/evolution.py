"""Differential evolution as immutable values behind ask and tell (Storn & Price 1997; paper, section 3.2).

    population = seed_population(evolution, box, seed=1)
    while True:
        trials = ask(evolution, box, population)
        population = tell(population, trials, cost(trials))

Every random number depends on (seed, run, generation, member) alone, so any generation can be replayed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from boresight.kernels.breeding import Breeding, breed, lead, select, sow
from boresight.kernels.lanes import padded
from boresight.kernels.programs import WORST, aligned
from boresight.kernels.random import run_key
from boresight.search.box import Box
from boresight.search.strategies import TRADE_OFF, Strategy


@dataclass(frozen=True, slots=True)
class DifferentialEvolution:
    """The settings of an evolution; those left out are the strategy's own, by default the paper's (eq. 24).

    Attributes:
        strategy: how mutants are made.
        population: Np, number of members, at least 5.
        scale: F, weight of the difference of two members.
        crossover: CR, probability of taking a component from the mutant.
    """

    strategy: Strategy = TRADE_OFF
    population: int = None  # type: ignore[assignment]
    scale: float = None  # type: ignore[assignment]
    crossover: float = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        for name in ("population", "scale", "crossover"):
            if getattr(self, name) is None:
                object.__setattr__(self, name, getattr(self.strategy, name))
        if self.population < 5:
            raise ValueError(f"a population needs at least 5 members, got {self.population}")

    def breeding(self, box: Box) -> Breeding:
        """Returns these settings as the compiled loop takes them."""
        pull = self.scale if self.strategy.pull is None else self.strategy.pull
        return Breeding(
            from_current=self.strategy.from_current,
            pull=float(pull),
            scale=float(self.scale),
            spread=float(self.strategy.spread),
            crossover=float(self.crossover),
            downhill=self.strategy.downhill,
            elite=max(1, round(self.strategy.elite * self.population)),
            lower=box.lower,
            upper=box.upper,
        )


@dataclass(frozen=True)
class Population:
    """The members of a generation and what they cost; every operation returns a new one.

    Attributes:
        key: key of the run's random numbers.
        members: (members, parameters) one a row.
        costs: (members,) their costs; `WORST` before the first `tell`.
        generation: generations completed; 0 before the first `tell`.
    """

    key: int
    members: Float[np.ndarray, "members parameters"]
    costs: Float[np.ndarray, "members"]
    generation: int = 0

    @property
    def best(self) -> Float[np.ndarray, "parameters"]:
        """The member of lowest cost."""
        return self.members[int(np.argmin(self.costs))].copy()

    @property
    def best_cost(self) -> float:
        """The lowest cost."""
        return float(np.min(self.costs))


def seed_population(settings: DifferentialEvolution, box: Box, seed: int, run: int = 0) -> Population:
    """Returns a first population, uniform in the box (paper, step 3), not yet evaluated."""
    members = aligned(settings.population, len(box))
    key = int(run_key(np.uint64(seed), np.uint64(run)))
    sow(np.uint64(key), box.lower, box.upper, members)
    return Population(key, members, np.full(settings.population, WORST))


def ask(settings: DifferentialEvolution, box: Box, population: Population) -> Float[np.ndarray, "members parameters"]:
    """Returns the members to evaluate next: the first population itself, then trials bred from it."""
    if population.generation == 0:
        return population.members.copy()
    count, parameters = population.members.shape
    trials, lanes = aligned(count, parameters), aligned(parameters, padded(count))
    breeding, key = settings.breeding(box), np.uint64(population.key)
    leaders = np.empty(min(breeding.elite, count), dtype=np.uint64)
    lead(population.costs, leaders)
    breed(key, population.generation, breeding, population.members, population.costs, leaders, trials, lanes)
    return trials


def tell(
    population: Population, trials: Float[np.ndarray, "members parameters"], costs: Float[np.ndarray, "members"]
) -> Population:
    """Returns the next generation: of each member and its trial, the cheaper (paper, eq. 18)."""
    members, kept = population.members.copy(), population.costs.copy()
    told = np.where(np.isnan(costs), WORST, np.minimum(costs, WORST))
    select(members, kept, np.ascontiguousarray(trials), told)
    return replace(population, members=members, costs=kept, generation=population.generation + 1)
