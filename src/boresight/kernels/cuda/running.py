"""Batches put on the card, evolved in stretches, and brought back."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numba import cuda

from boresight.kernels.cuda.batches import Batch, Task, batch_of
from boresight.kernels.cuda.evolving import evolving_kernel

_MEMORY_BYTES = 2**30
"""What a launch may take on the card."""

_STRETCH_EVALUATIONS = 2e10
"""Ranges predicted in a launch, about: a second on a large card, so that progress shows and Ctrl-C is heard."""


class Run(NamedTuple):
    """What became of one task.

    Attributes:
        members: (members, parameters) the last population.
        costs: (members,) its costs.
        history: (generations + 1, 2) best and mean cost, the first population's in row 0.
        stale: generations since the best last improved.
    """

    members: np.ndarray
    costs: np.ndarray
    history: np.ndarray
    stale: int


def evolve_tasks(
    tasks: Sequence[Task],
    real: type[np.floating],
    generations: int,
    limits: tuple[float, int, float],
    on_progress: Callable[[int, float], None] | None = None,
) -> list[Run]:
    """Returns what becomes of every task, in their order.

    Args:
        tasks: of any kinds; those of one kind go to the card together.
        real: precision.
        generations: most generations after the first population.
        limits: cost at which to stop, stale generations at which to stop, relative improvement that counts.
        on_progress: called with the generations completed and the lowest cost of a batch.
    """
    kinds: dict[tuple, list[int]] = {}
    for place, task in enumerate(tasks):
        kinds.setdefault(task.kind, []).append(place)
    found: dict[int, Run] = {}
    for places in kinds.values():
        together = _together(tasks[places[0]], real, generations)
        for first in range(0, len(places), together):
            chosen = places[first : first + together]
            batch = batch_of([tasks[place] for place in chosen], real)
            found.update(zip(chosen, _evolve(batch, real, generations, limits, on_progress), strict=True))
    return [found[place] for place in range(len(tasks))]


def _together(task: Task, real: type[np.floating], generations: int) -> int:
    """Returns how many tasks like this fit in a launch."""
    shape, size = task.shape, np.dtype(real).itemsize
    rows = len(task.rows.reading) * (2 * shape.joints + 2) * size
    each = rows + 2 * (shape.parameters + 1) * shape.members * size + 16 * generations
    return int(max(1, _MEMORY_BYTES // each))


def _evolve(
    batch: Batch,
    real: type[np.floating],
    generations: int,
    limits: tuple[float, int, float],
    on_progress: Callable[[int, float], None] | None,
) -> list[Run]:
    shape, runs = batch.shape, len(batch.keys)
    kernel = evolving_kernel(shape, np.dtype(real).name)
    program = type(batch.program)(*(cuda.to_device(array) for array in batch.program))
    rows = type(batch.rows)(*(cuda.to_device(array) for array in batch.rows))
    lower, upper, keys = (cuda.to_device(a) for a in (batch.breeding.lower, batch.breeding.upper, batch.keys))
    breeding = batch.breeding
    strategy = (float(breeding.pull), float(breeding.scale), float(breeding.spread), float(breeding.crossover))
    members, trials = (cuda.device_array((runs, shape.parameters * shape.members), real) for _ in range(2))
    costs, trial_costs = (cuda.device_array((runs, shape.members), real) for _ in range(2))
    leaders = cuda.device_array((runs, shape.elite), np.int32)
    stale, reference = cuda.to_device(np.zeros(runs, np.int64)), cuda.to_device(np.zeros(runs))
    done = cuda.device_array(runs, np.int64)
    stretch = int(max(1, _STRETCH_EVALUATIONS / (runs * shape.members * batch.rows.reading.shape[1])))
    stretches: list[np.ndarray] = []
    counts: list[np.ndarray] = []
    first = 0
    while first <= generations:
        history = cuda.device_array((runs, min(stretch, generations + 1 - first), 2), np.float64)
        kernel[runs, shape.threads, 0, shape.shared_bytes(real) if shape.in_shared(real) else 0](
            program, rows, lower, upper, strategy, bool(breeding.from_current), bool(breeding.downhill), keys, first,
            (float(limits[0]), int(limits[1]), float(limits[2])), members, costs, stale, reference, done, history,
            trials, trial_costs, leaders,
        )  # fmt: skip
        counts.append(done.copy_to_host())
        stretches.append(history.copy_to_host())
        first += history.shape[1]
        ran = counts[-1] > 0
        if on_progress is not None and ran.any():
            lowest = stretches[-1][ran, counts[-1][ran] - 1, 0]
            on_progress(min(first - 1, generations), float(lowest.min()))
        if not (counts[-1] == history.shape[1]).any():
            break
    populations = members.copy_to_host().reshape(runs, shape.parameters, shape.members).astype(float)
    priced, still = costs.copy_to_host().astype(float), stale.copy_to_host()
    return [
        Run(
            np.ascontiguousarray(populations[run].T),
            priced[run],
            np.concatenate([part[run, : count[run]] for part, count in zip(stretches, counts, strict=True)]),
            int(still[run]),
        )
        for run in range(runs)
    ]
