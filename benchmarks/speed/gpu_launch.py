"""Parts of a launch on their own: arrays put together on the host, and the kernel without transfers."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from numba import cuda

from boresight.kernels.cuda.batches import Task, batch_of
from boresight.kernels.cuda.launching import Launch


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
    launch = Launch(batch_of(tasks, real), real, (0.0, 10**9, 0.0))
    history = launch.history(generations + 1)
    cuda.synchronize()
    began = time.perf_counter()
    launch.advance(0, history)
    cuda.synchronize()
    return time.perf_counter() - began
