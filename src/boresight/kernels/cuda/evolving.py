"""One block of threads evolves one whole population, generation after generation, without leaving the card."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numba import cuda, float64, from_dtype, int32
from numba.core import config

from boresight.kernels.breeding import component, parents
from boresight.kernels.cuda.batches import Shape
from boresight.kernels.cuda.costing import cost_function
from boresight.kernels.programs import WORST
from boresight.kernels.random import draw, high_uniform, low_uniform, subkey


@lru_cache(maxsize=64)
def evolving_kernel(shape: Shape, precision: str) -> Any:
    """Returns the kernel of a shape in `float64` or `float32`; the first call with it compiles it.

    Its arguments: `program` and `rows` of a batch; `lower` and `upper` (runs, parameters); `strategy` (K, F, its
    spread, CR) and whether mutants start from the member itself, whether differences point downhill; `keys` (runs,);
    `first`, the generation to begin with, 0 for the first population itself; `limits` (cost at which to stop, stale
    generations at which to stop, relative improvement that counts); and, kept from one launch to the next,
    `members` (runs, parameters * members), `costs` (runs, members), `stale` (runs,), `reference` (runs,), `done`
    (runs,) generations of this launch, `history` (runs, generations, 2); work space `trials` like members,
    `trial_costs` like costs, `leaders` (runs, elite).
    """
    real = np.float64 if precision == "float64" else np.float32
    parameters, count, threads, elite = shape.parameters, shape.members, shape.threads, shape.elite
    in_shared = shape.in_shared(real)
    half = 1
    while 2 * half < threads:
        half *= 2
    limits = {} if config.ENABLE_CUDASIM else {"max_registers": shape.registers(real)}  # type: ignore[attr-defined]
    cost, kind = cost_function(shape, real), from_dtype(np.dtype(real))

    @cuda.jit(device=True)
    def find_best(costs, lowest, place, total):
        """Leaves the lowest cost, its member and the sum of costs in the first of the threads' numbers."""
        t = cuda.threadIdx.x
        lowest[t], place[t], total[t] = WORST, count, 0.0
        for i in range(t, count, threads):
            total[t] += np.float64(costs[i])
            if costs[i] < lowest[t]:
                lowest[t], place[t] = costs[i], i
        cuda.syncthreads()
        step = half
        while step > 0:
            if t < step and t + step < threads:
                other = t + step
                total[t] += total[other]
                if lowest[other] < lowest[t] or (lowest[other] == lowest[t] and place[other] < place[t]):
                    lowest[t], place[t] = lowest[other], place[other]
            cuda.syncthreads()
            step //= 2

    @cuda.jit(device=True)
    def lead(costs, leaders, run):
        """Writes the `elite` cheapest members, cheapest first: each member counts those before it."""
        for i in range(cuda.threadIdx.x, count, threads):
            rank = 0
            for other in range(count):
                if costs[other] < costs[i] or (costs[other] == costs[i] and other < i):
                    rank += 1
            if rank < elite:
                leaders[run, rank] = i

    @cuda.jit(fastmath=True, **limits)
    def kernel(
        program, rows, lower, upper, strategy, from_current, downhill, keys, first, limits,
        members, costs, stale, reference, done, history, trials, trial_costs, leaders,
    ):  # fmt: skip
        run, t = cuda.blockIdx.x, cuda.threadIdx.x
        lowest = cuda.shared.array(threads, float64)
        place = cuda.shared.array(threads, int32)
        total = cuda.shared.array(threads, float64)
        if in_shared:
            own = cuda.shared.array(0, kind)
            population, prices = own[: parameters * count], own[parameters * count : (parameters + 1) * count]
        else:
            population, prices = members[run], costs[run]
        pull, scale, spread, crossover = strategy
        pull = real(pull)
        target, patience, tolerance = limits
        key = keys[run]
        if first == 0:
            generation_key = np.uint64(subkey(key, 0))
            for i in range(t, count, threads):
                member_key = np.uint64(subkey(generation_key, i))
                for j in range(parameters):
                    share = real(low_uniform(np.uint64(draw(member_key, j))))
                    number = lower[run, j] + share * (upper[run, j] - lower[run, j])
                    trials[run, j * count + i] = number
                    population[j * count + i] = number
                price = cost(program, rows, run, trials, i)
                prices[i] = price
        elif in_shared:
            for i in range(t, count, threads):
                prices[i] = costs[run, i]
                for j in range(parameters):
                    population[j * count + i] = members[run, j * count + i]
        cuda.syncthreads()
        find_best(prices, lowest, place, total)
        since, compared = stale[run], reference[run]
        if first == 0:
            since, compared = 0, lowest[0]
        step = 0
        going = first == 0 or not (lowest[0] <= target or since >= patience)
        while going and step < history.shape[1]:
            generation = first + step
            if generation > 0:
                if elite > 1:
                    lead(prices, leaders, run)
                    cuda.syncthreads()
                generation_key = np.uint64(subkey(key, generation))
                for i in range(t, count, threads):
                    member_key = np.uint64(subkey(generation_key, i))
                    a, plus, minus, leader, factor, forced = parents(
                        member_key, np.uint64(i), count, parameters, elite, scale, spread
                    )
                    best = np.int64(leaders[run, leader]) if elite > 1 else np.int64(place[0])
                    origin = np.int64(i) if from_current else np.int64(a)
                    higher, smaller = np.int64(plus), np.int64(minus)
                    if downhill and prices[smaller] < prices[higher]:
                        higher, smaller = smaller, higher
                    factor = real(factor)
                    for j in range(parameters):
                        bits = np.uint64(draw(member_key, j))
                        k = j * count
                        trials[run, k + i] = component(
                            population[k + i], population[k + origin], population[k + best], population[k + higher],
                            population[k + smaller], pull, factor, lower[run, j], upper[run, j],
                            real(high_uniform(bits)), low_uniform(bits) < crossover or j == forced,
                        )  # fmt: skip
                    trial_costs[run, i] = cost(program, rows, run, trials, i)
                cuda.syncthreads()
                for i in range(t, count, threads):
                    if trial_costs[run, i] < prices[i]:
                        prices[i] = trial_costs[run, i]
                        for j in range(parameters):
                            population[j * count + i] = trials[run, j * count + i]
                cuda.syncthreads()
                find_best(prices, lowest, place, total)
                if lowest[0] < compared * (1.0 - tolerance):
                    compared = lowest[0]
                    since = 0
                else:
                    since += 1
            if t == 0:
                history[run, step, 0], history[run, step, 1] = lowest[0], total[0] / count
            step += 1
            going = not (lowest[0] <= target or since >= patience)
            cuda.syncthreads()
        if in_shared:
            for i in range(t, count, threads):
                costs[run, i] = prices[i]
                for j in range(parameters):
                    members[run, j * count + i] = population[j * count + i]
        if t == 0:
            stale[run], reference[run], done[run] = since, compared, step

    return kernel
