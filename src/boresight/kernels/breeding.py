"""One generation of differential evolution: mutation, crossover, redrawing inside the box, selection.

Populations are (parameters, lanes) arrays, a member a column, so that every inner loop runs over members.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from boresight.kernels.compiling import compiled
from boresight.kernels.programs import padded
from boresight.kernels.random import draw, high_uniform, low_uniform, subkey


class Breeding(NamedTuple):
    """The numbers of a strategy and its box.

    Attributes:
        from_current: whether mutants start from the member itself rather than from a random one.
        pull: K, how far they are drawn towards the best (0: rand/1, 1: best/1).
        scale: F, the weight of the difference of two random members.
        crossover: CR, the probability of taking a component from the mutant.
        lower: (parameters,) lower bounds.
        upper: (parameters,) upper bounds.
    """

    from_current: bool
    pull: float
    scale: float
    crossover: float
    lower: np.ndarray
    upper: np.ndarray


class Draws(NamedTuple):
    """A generation's random choices, a lane a member: the work space of `breed`.

    Attributes:
        key: (lanes,) key of each member's own random stream.
        origin, plus, minus: (lanes,) the members a mutant is made of.
        forced: (lanes,) the component always taken from the mutant.
    """

    key: np.ndarray
    origin: np.ndarray
    plus: np.ndarray
    minus: np.ndarray
    forced: np.ndarray


def draws_for(members: int) -> Draws:
    """Returns fresh memory for the random choices of a population."""
    lanes = padded(members)
    return Draws(*(np.zeros(lanes, dtype=np.uint64) for _ in range(5)))


@compiled
def sow(run, lower, upper, count, members):
    """Writes a first population, uniform in the box; spare lanes repeat the first member."""
    for i in range(members.shape[1]):
        key = subkey(subkey(run, 0), i if i < count else 0)
        for j in range(members.shape[0]):
            members[j, i] = lower[j] + low_uniform(draw(key, j)) * (upper[j] - lower[j])


@compiled
def choose(run, generation, parameters, from_current, count, draws):
    """Writes every member's three distinct partners, none itself, and its forced component."""
    generation_key = subkey(run, generation)
    for i in range(count):
        key = subkey(generation_key, i)
        draws.key[i] = key
        draws.forced[i] = draw(key, parameters) % np.uint64(parameters)
        me, total = np.uint64(i), np.uint64(count)
        index = parameters + 1
        a, b, c = me, me, me
        while a == me:
            a = draw(key, index) % total
            index += 1
        while b in (me, a):
            b = draw(key, index) % total
            index += 1
        while c in (me, a, b):
            c = draw(key, index) % total
            index += 1
        draws.origin[i] = me if from_current else a
        draws.plus[i], draws.minus[i] = b, c
    for i in range(count, draws.key.shape[0]):
        draws.key[i], draws.origin[i], draws.plus[i], draws.minus[i] = draws.key[0], 0, 0, 0


@compiled
def breed(run, generation, breeding, members, count, best, draws, trials):
    """Writes the trial members of a generation (paper, eq. 14 to 17).

    A component that leaves the box is drawn again between the member's own value and the bound it crossed.
    Drawing it from the whole box instead throws away what the population knows, and stopping it at the bound
    breeds members that share it: on case 1 with half the box, the first needed twice the generations and
    the second lost the bound's neighbourhood.
    """
    parameters = members.shape[0]
    choose(run, generation, parameters, breeding.from_current, count, draws)
    pull, scale, crossover = breeding.pull, breeding.scale, breeding.crossover
    for j in range(parameters):
        own, trial = members[j], trials[j]
        lower, upper, leader = breeding.lower[j], breeding.upper[j], own[best]
        component = np.uint64(j)
        for i in range(own.shape[0]):
            bits = draw(draws.key[i], component)
            origin = own[draws.origin[i]]
            mutant = origin + pull * (leader - origin) + scale * (own[draws.plus[i]] - own[draws.minus[i]])
            redrawn = high_uniform(bits)
            if mutant < lower:
                mutant = lower + redrawn * (own[i] - lower)
            if mutant > upper:
                mutant = upper - redrawn * (upper - own[i])
            crossed = low_uniform(bits) < crossover or draws.forced[i] == component
            trial[i] = mutant if crossed else own[i]


@compiled
def select(members, costs, trials, trial_costs):
    """Replaces every member by its trial where that costs less (paper, eq. 18)."""
    for j in range(members.shape[0]):
        own, trial = members[j], trials[j]
        for i in range(own.shape[0]):
            own[i] = trial[i] if trial_costs[i] < costs[i] else own[i]
    for i in range(costs.shape[0]):
        costs[i] = min(costs[i], trial_costs[i])


@compiled
def summarise(costs, count):
    """Returns the place of the lowest cost, that cost, and the mean cost."""
    best = 0
    total = 0.0
    for i in range(count):
        total += costs[i]
        if costs[i] < costs[best]:
            best = i
    return best, costs[best], total / count
