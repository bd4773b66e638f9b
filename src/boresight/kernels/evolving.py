"""Generations of evolution on the compiled cost, without leaving compiled code."""

from __future__ import annotations

import numpy as np

from boresight.kernels.breeding import breed, lead, select, summarise
from boresight.kernels.compiling import compiled
from boresight.kernels.sweeping import sweep


@compiled
def evolve_generations(
    program, rows, work, breeding, run, members, costs, trials, lanes, lane_costs, first, stale, limits, history
):
    """Runs generations until the history is full or a limit is met; nothing is allocated a generation.

    Args:
        program: how a member becomes links and planes.
        rows: the readings.
        work: the thread's memory.
        breeding: the strategy and its box.
        run: key of the run.
        members: (members, parameters) the population, changed in place.
        costs: (members,) its costs, changed in place.
        trials: (members, parameters) work space.
        lanes: (parameters, lanes) work space.
        lane_costs: (lanes,) work space.
        first: number of the first generation to run.
        stale: generations since the best last improved, and the cost it is compared with.
        limits: cost at which to stop, stale generations at which to stop, relative improvement that counts.
        history: (generations, 2) out, best and mean cost after each generation.

    Returns:
        Generations run, stale generations, and the cost they are compared with.
    """
    since, reference = stale
    target, patience, tolerance = limits
    leaders = np.empty(min(breeding.elite, members.shape[0]), dtype=np.uint64)
    for step in range(history.shape[0]):
        lead(costs, leaders)
        breed(run, first + step, breeding, members, costs, leaders, trials, lanes)
        sweep(program, rows, work, lanes, lane_costs)
        select(members, costs, trials, lane_costs)
        lowest, mean = summarise(costs)
        history[step, 0], history[step, 1] = lowest, mean
        if lowest < reference * (1.0 - tolerance):
            reference = lowest
            since = 0
        else:
            since += 1
        if lowest <= target or since >= patience:
            return step + 1, since, reference
    return history.shape[0], since, reference
