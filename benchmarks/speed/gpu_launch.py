"""Parts of a launch on their own: arrays put together on the host, and the kernel without transfers."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from numba import cuda

from boresight.kernels.cuda.batches import Task, batch_of
from boresight.kernels.cuda.evolving import evolving_kernel


def host_seconds(tasks: Sequence[Task], real: type[np.floating]) -> float:
    """Returns the time of putting tasks of one kind together [s]."""
    began = time.perf_counter()
    batch_of(tasks, real)
    return time.perf_counter() - began


def card_seconds(tasks: Sequence[Task], real: type[np.floating], generations: int) -> float:
    """Returns the time of the kernel [s], one launch from the first population to the last, no early stop.

    Args:
        tasks: of one kind.
        real: precision.
        generations: after the first population.
    """
    batch = batch_of(tasks, real)
    shape, runs, breeding = batch.shape, len(batch.keys), batch.breeding
    kernel = evolving_kernel(shape, np.dtype(real).name)
    program = type(batch.program)(*(cuda.to_device(array) for array in batch.program))
    rows = type(batch.rows)(*(cuda.to_device(array) for array in batch.rows))
    lower, upper, keys = (cuda.to_device(a) for a in (breeding.lower, breeding.upper, batch.keys))
    strategy = (float(breeding.pull), float(breeding.scale), float(breeding.spread), float(breeding.crossover))
    members, trials = (cuda.device_array((runs, shape.parameters * shape.members), real) for _ in range(2))
    costs, trial_costs = (cuda.device_array((runs, shape.members), real) for _ in range(2))
    leaders = cuda.device_array((runs, shape.elite), np.int32)
    stale, reference = cuda.to_device(np.zeros(runs, np.int64)), cuda.to_device(np.zeros(runs))
    done, history = cuda.device_array(runs, np.int64), cuda.device_array((runs, generations + 1, 2), np.float64)
    shared = shape.shared_bytes(real) if shape.in_shared(real) else 0
    cuda.synchronize()
    began = time.perf_counter()
    kernel[runs, shape.threads, 0, shared](
        program, rows, lower, upper, strategy, bool(breeding.from_current), bool(breeding.downhill), keys, 0,
        (0.0, 10**9, 0.0), members, costs, stale, reference, done, history, trials, trial_costs, leaders,
    )  # fmt: skip
    cuda.synchronize()
    return time.perf_counter() - began
