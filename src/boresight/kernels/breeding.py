"""One generation of differential evolution: mutation, crossover, redrawing inside the box, selection.

Populations are (members, parameters) arrays, so that a mutant is made of rows; what the sweep reads is the
transposed copy that `breed` writes beside them. Gathering members lane by lane instead took 15 µs a generation
of 150 x 25, against 8.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from boresight.kernels.compiling import compiled
from boresight.kernels.random import below, draw, high_uniform, low_uniform, subkey


class Breeding(NamedTuple):
    """The numbers of a strategy and its box.

    Attributes:
        from_current: whether mutants start from the member itself rather than from a random one.
        pull: K, how far they are drawn towards the best (0: rand/1, 1: best/1).
        scale: F, the weight of the difference of two random members.
        spread: how far F varies from member to member, either way.
        crossover: CR, the probability of taking a component from the mutant.
        downhill: whether the difference points from the dearer to the cheaper of its two members.
        elite: how many of the best members stand for the best, each mutant drawn to one of them.
        lower: (parameters,) lower bounds.
        upper: (parameters,) upper bounds.
    """

    from_current: bool
    pull: float
    scale: float
    spread: float
    crossover: float
    downhill: bool
    elite: int
    lower: np.ndarray
    upper: np.ndarray


_OWN = np.uint64(1 << 32)
"""Number of the draw that gives a mutant its leader and its F: beyond those of any parameter."""


@compiled
def sow(run, lower, upper, members):
    """Writes a first population, uniform in the box."""
    for i in range(members.shape[0]):
        key = subkey(subkey(run, 0), i)
        for j in range(members.shape[1]):
            members[i, j] = lower[j] + low_uniform(draw(key, j)) * (upper[j] - lower[j])


@compiled
def partners(key, me, total, parameters):
    """Returns three distinct members, none of them `me`."""
    index = parameters + 1
    a, b, c = me, me, me
    while a == me:
        a = below(draw(key, index), total)
        index += 1
    while b in (me, a):
        b = below(draw(key, index), total)
        index += 1
    while c in (me, a, b):
        c = below(draw(key, index), total)
        index += 1
    return a, b, c


@compiled
def lead(costs, leaders):
    """Writes the rows of the cheapest members, cheapest first."""
    filled = 0
    for i in range(costs.shape[0]):
        if filled == leaders.shape[0] and not costs[i] < costs[leaders[filled - 1]]:
            continue
        filled = min(filled + 1, leaders.shape[0])
        place = filled - 1
        while place > 0 and costs[i] < costs[leaders[place - 1]]:
            leaders[place] = leaders[place - 1]
            place -= 1
        leaders[place] = i


@compiled
def parents(key, me, count, parameters, elite, scale, spread):
    """Returns who a mutant is made of.

    Args:
        key: of the member in this generation.
        me: the member.
        count: of members.
        parameters: how many numbers a member has.
        elite: how many members stand for the best.
        scale: F.
        spread: how far it varies.

    Returns:
        Three other members; the place of its leader among the best; its own F; the component that it takes for
        certain.
    """
    forced = below(draw(key, parameters), parameters)
    a, b, c = partners(key, me, np.uint64(count), parameters)
    bits = draw(key, _OWN)
    leader = np.int64(low_uniform(bits) * elite)
    return a, b, c, leader, scale + spread * (2.0 * high_uniform(bits) - 1.0), np.int64(forced)


@compiled
def component(own, start, best, plus, minus, pull, scale, lower, upper, redrawn, taken):
    """Returns one number of a trial member (paper, eq. 14 to 17).

    A component that leaves the box is drawn again between the member's own value and the bound it crossed.
    Drawing it from the whole box throws away what the population knows, and stopping it at the bound breeds
    members that share it.

    Args:
        own: the member's.
        start: that of its origin.
        best: that of its leader.
        plus: that of the member which is added.
        minus: that of the member which is taken off.
        pull: K.
        scale: F.
        lower: the box's lower bound.
        upper: its upper bound.
        redrawn: where in it to draw again, 0 to 1.
        taken: whether crossover takes the mutant's.
    """
    mutant = start + pull * (best - start) + scale * (plus - minus)
    mutant = lower + redrawn * (own - lower) if mutant < lower else mutant
    mutant = upper - redrawn * (upper - own) if mutant > upper else mutant
    return mutant if taken else own


@compiled
def breed(run, generation, breeding, members, costs, leaders, trials, lanes):
    """Writes the trial members of a generation, and transposed for the sweep.

    Args:
        run: key of the run.
        generation: number of the generation.
        breeding: the strategy and its box.
        members: (members, parameters) the population.
        costs: (members,) its costs.
        leaders: rows of its `elite` best members.
        trials: (members, parameters) out.
        lanes: (parameters, lanes) out: the same, a column each; spare lanes repeat the first.
    """
    count, parameters = members.shape
    generation_key = subkey(run, generation)
    pull, crossover = breeding.pull, breeding.crossover
    lower, upper = breeding.lower, breeding.upper
    real = members.dtype.type
    for i in range(count):
        key, me = subkey(generation_key, i), np.uint64(i)
        a, plus, minus, leader, scale, forced = parents(
            key, me, count, parameters, leaders.shape[0], breeding.scale, breeding.spread
        )
        origin, best = me if breeding.from_current else a, leaders[leader]
        if breeding.downhill and costs[minus] < costs[plus]:
            plus, minus = minus, plus
        for j in range(parameters):
            bits = draw(key, j)
            trials[i, j] = component(
                members[i, j], members[origin, j], members[best, j], members[plus, j], members[minus, j],
                real(pull), real(scale), lower[j], upper[j],
                real(high_uniform(bits)), low_uniform(bits) < crossover or j == forced,
            )  # fmt: skip
        for j in range(parameters):
            lanes[j, i] = trials[i, j]
    for j in range(parameters):
        for i in range(count, lanes.shape[1]):
            lanes[j, i] = lanes[j, 0]


@compiled
def select(members, costs, trials, trial_costs):
    """Replaces every member by its trial where that costs less (paper, eq. 18)."""
    for i in range(members.shape[0]):
        if trial_costs[i] < costs[i]:
            costs[i] = trial_costs[i]
            for j in range(members.shape[1]):
                members[i, j] = trials[i, j]


@compiled
def summarise(costs):
    """Returns the lowest and the mean cost."""
    best, count = 0, costs.shape[0]
    total = 0.0
    for i in range(count):
        total += costs[i]
        if costs[i] < costs[best]:
            best = i
    return costs[best], total / count
