"""One block of threads refines one calibration by Levenberg-Marquardt, in double precision.

The normal equations of a batch's small problems are made and solved where the block is: rows are linearised a thread
each, the products of their derivatives are summed an entry a thread, and the Cholesky factor is made a column at a
time by all.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from numba import cuda, float64

from boresight.kernels.cuda.batches import SHARED_BYTES, WARP, Shape
from boresight.kernels.cuda.linearising import linearising_functions

FIRST_DAMPING, LEAST_DAMPING, MOST_DAMPING = 1e-4, 1e-13, 1e12
"""Marquardt's factor on the diagonal: it falls tenfold with a step that descends, and rises tenfold with one that does
not."""

SETTLED = 1e-13
"""A fall of the cost by less than this share of it ends the search."""


def refining_threads(shape: Shape) -> int:
    """Returns the threads of a block: as many as have room for their rows' derivatives, two warps at most; or 0."""
    room = (SHARED_BYTES - 2048) // 8 - 6 * shape.parameters - 3 * shape.motions - 7 * shape.planes
    return WARP * min(2, max(0, room) // ((shape.parameters + 1) * WARP))


@lru_cache(maxsize=64)
def refining_kernel(shape: Shape) -> Any:
    """Returns the kernel of a shape; the first call with it compiles it.

    Its arguments: `program` and `rows` of a batch; `x` (runs, parameters), where to begin and in the end where it
    ended; `cost` (runs,) and `steps` (runs,) out; `most` steps; work space `normal` (runs, parameters + 1,
    parameters + 1) and `factor` (runs, parameters, parameters).
    """
    parameters, threads = shape.parameters, refining_threads(shape)
    columns = parameters + 1
    of_motions, of_planes, of_slopes = 3 * max(shape.motions, 1), 7 * shape.planes, threads * columns
    half = threads // 2
    stand, linearise = linearising_functions(shape)

    @cuda.jit(device=True)
    def added(value, sums):
        """Returns the sum of a number over all threads."""
        t = cuda.threadIdx.x
        cuda.syncthreads()
        sums[t] = value
        cuda.syncthreads()
        step = half
        while step > 0:
            if t < step:
                sums[t] += sums[t + step]
            cuda.syncthreads()
            step //= 2
        return sums[0]

    @cuda.jit(device=True)
    def cost_at(program, rows, run, x, motions, planes, slopes, sums):
        t = cuda.threadIdx.x
        cuda.syncthreads()
        stand(program, run, x, motions, planes)
        cuda.syncthreads()
        total = 0.0
        for row in range(t, rows.reading.shape[1], threads):
            error = linearise(program, rows, run, row, motions, planes, x, slopes, 0, False)
            total += error * error
        for p in range(t, parameters, threads):
            total += program.prior_weight[run, p] * x[p] * x[p]
        return added(total, sums)

    @cuda.jit(device=True)
    def add_up(program, rows, run, x, motions, planes, slopes, normal):
        """Writes J'J and, in its last row, J'r, priors included, for the point where the block stands."""
        t, count = cuda.threadIdx.x, rows.reading.shape[1]
        for entry in range(t, columns * columns, threads):
            i, j = entry // columns, entry % columns
            own = 0.0
            if i == j and i < parameters:
                own = program.prior_weight[run, i]
            elif i == parameters and j < parameters:
                own = program.prior_weight[run, j] * x[j]
            normal[run, i, j] = own
        for start in range(0, count, threads):
            cuda.syncthreads()
            row, place = start + t, t * columns
            if row < count:
                slopes[place + parameters] = linearise(program, rows, run, row, motions, planes, x, slopes, place, True)
            cuda.syncthreads()
            filled = min(threads, count - start)
            for entry in range(t, columns * columns, threads):
                i, j = entry // columns, entry % columns
                if j <= i:
                    total = 0.0
                    for other in range(filled):
                        total += slopes[other * columns + i] * slopes[other * columns + j]
                    normal[run, i, j] += total
        cuda.syncthreads()

    @cuda.jit(device=True)
    def factorise(run, damping, normal, factor):
        """Writes the Cholesky factor of the damped equations, and returns whether they have one."""
        t = cuda.threadIdx.x
        for entry in range(t, parameters * parameters, threads):
            i, j = entry // parameters, entry % parameters
            if j <= i:
                factor[run, i, j] = normal[run, i, j] * (1.0 + damping if i == j else 1.0)
        for k in range(parameters):
            cuda.syncthreads()
            pivot = factor[run, k, k]
            if not pivot > 0.0:
                return False
            root = pivot**0.5
            cuda.syncthreads()
            for i in range(k + t, parameters, threads):
                factor[run, i, k] = root if i == k else factor[run, i, k] / root
            cuda.syncthreads()
            left = parameters - k - 1
            for entry in range(t, left * left, threads):
                i, j = k + 1 + entry // left, k + 1 + entry % left
                if j <= i:
                    factor[run, i, j] -= factor[run, i, k] * factor[run, j, k]
        cuda.syncthreads()
        return True

    @cuda.jit(device=True)
    def solve(run, normal, factor, step):
        """Writes the step that the factorised equations ask for."""
        t = cuda.threadIdx.x
        for i in range(t, parameters, threads):
            step[i] = -normal[run, parameters, i]
        for k in range(parameters):
            cuda.syncthreads()
            solved = step[k] / factor[run, k, k]
            cuda.syncthreads()
            for i in range(k + t, parameters, threads):
                step[i] = solved if i == k else step[i] - factor[run, i, k] * solved
        for back in range(parameters):
            k = parameters - 1 - back
            cuda.syncthreads()
            solved = step[k] / factor[run, k, k]
            cuda.syncthreads()
            for i in range(t, k + 1, threads):
                step[i] = solved if i == k else step[i] - factor[run, k, i] * solved
        cuda.syncthreads()

    @cuda.jit
    def kernel(program, rows, x, cost, steps, most, normal, factor):
        run, t = cuda.blockIdx.x, cuda.threadIdx.x
        here = cuda.shared.array(parameters, float64)
        there = cuda.shared.array(parameters, float64)
        step = cuda.shared.array(parameters, float64)
        motions = cuda.shared.array(of_motions, float64)
        planes = cuda.shared.array(of_planes, float64)
        slopes = cuda.shared.array(of_slopes, float64)
        sums = cuda.shared.array(threads, float64)
        for p in range(t, parameters, threads):
            here[p] = x[run, p]
        lowest = cost_at(program, rows, run, here, motions, planes, slopes, sums)
        add_up(program, rows, run, here, motions, planes, slopes, normal)
        damping, taken, going = FIRST_DAMPING, 0, True
        while going and taken < most:
            taken += 1
            better = False
            if factorise(run, damping, normal, factor):
                solve(run, normal, factor, step)
                promised = 0.0
                for p in range(t, parameters, threads):
                    there[p] = here[p] + step[p]
                    promised -= step[p] * normal[run, parameters, p]
                promised = added(promised, sums)
                tried = cost_at(program, rows, run, there, motions, planes, slopes, sums)
                better = tried < lowest
                if better:
                    going = min(promised, lowest - tried) > SETTLED * lowest
                    lowest = tried
                    for p in range(t, parameters, threads):
                        here[p] = there[p]
                    damping = max(0.1 * damping, LEAST_DAMPING)
                    if going:
                        cuda.syncthreads()
                        add_up(program, rows, run, here, motions, planes, slopes, normal)
                elif promised <= SETTLED * lowest:
                    going = False
            if not better:
                damping *= 10.0
                going = going and damping < MOST_DAMPING
            cuda.syncthreads()
        for p in range(t, parameters, threads):
            x[run, p] = here[p]
        if t == 0:
            cost[run], steps[run] = lowest, taken

    return kernel
