"""Batches put on the card, evolved in stretches or refined, and brought back."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeVar

import numpy as np
from numba import cuda

from boresight.errors import BoresightError
from boresight.kernels.cuda.batches import Batch, Task, batch_of
from boresight.kernels.cuda.launching import Launch, on_card
from boresight.kernels.cuda.refining import refining_kernel, refining_threads
from boresight.kernels.programs import POINT

Ended = TypeVar("Ended")

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
    return _in_batches(
        tasks,
        real,
        lambda task: _bytes_to_evolve(task, real, generations),
        lambda batch, _: _evolve(batch, real, generations, limits, on_progress),
    )


class Refined(NamedTuple):
    """Where least squares ended for one task.

    Attributes:
        x: (parameters,) there.
        cost: there.
        steps: tried.
    """

    x: np.ndarray
    cost: float
    steps: int


def refine_tasks(tasks: Sequence[Task], starts: Sequence[np.ndarray], most: int) -> list[Refined]:
    """Returns where Levenberg-Marquardt ends for every task, in their order.

    Args:
        tasks: of any kinds, whose readings are ranges to planes or offsets from them, without a robust loss.
        starts: (parameters,) where each begins.
        most: steps to try.

    Raises:
        BoresightError: a task is of another sort, or has more parameters than fit.
    """
    for task in tasks:
        if task.shape.others or task.program.loss > 0.0 or (task.program.plane_dropped == POINT).any():
            raise BoresightError("the card refines plain squares of ranges and offsets only")
        if not refining_threads(task.shape):
            raise BoresightError(f"{task.shape.parameters} free parameters are more than the card can refine")
    return _in_batches(
        tasks,
        np.float64,
        _bytes_to_refine,
        lambda batch, places: _refine(batch, np.array([starts[p] for p in places]), most),
    )


def _in_batches(
    tasks: Sequence[Task],
    real: type[np.floating],
    size: Callable[[Task], int],
    run: Callable[[Batch, list[int]], Sequence[Ended]],
) -> list[Ended]:
    """Returns what became of tasks, in their order: those of one kind go together, as many as a launch may take.

    Args:
        tasks: of any kinds.
        real: precision.
        size: what a task takes on the card [bytes].
        run: of a batch and the places of its tasks.
    """
    kinds: dict[tuple, list[int]] = {}
    for place, task in enumerate(tasks):
        kinds.setdefault(task.kind, []).append(place)
    found: dict[int, Ended] = {}
    for places in kinds.values():
        together = max(1, _MEMORY_BYTES // size(tasks[places[0]]))
        for first in range(0, len(places), together):
            chosen = places[first : first + together]
            found.update(zip(chosen, run(batch_of([tasks[place] for place in chosen], real), chosen), strict=True))
    return [found[place] for place in range(len(tasks))]


def _bytes_of_rows(task: Task, real: type[np.floating]) -> int:
    return len(task.rows.reading) * (2 * task.shape.joints + 2) * np.dtype(real).itemsize


def _bytes_to_evolve(task: Task, real: type[np.floating], generations: int) -> int:
    return _bytes_of_rows(task, real) + 2 * task.shape.shared_bytes(real) + 16 * generations


def _bytes_to_refine(task: Task) -> int:
    return _bytes_of_rows(task, np.float64) + 16 * (task.shape.parameters + 1) ** 2


def _refine(batch: Batch, starts: np.ndarray, most: int) -> list[Refined]:
    shape, runs = batch.shape, len(batch.keys)
    x, cost, steps = cuda.to_device(starts), cuda.device_array(runs), cuda.device_array(runs, np.int64)
    normal = cuda.device_array((runs, shape.parameters + 1, shape.parameters + 1))
    factor = cuda.device_array((runs, shape.parameters, shape.parameters))
    refining_kernel(shape)[runs, refining_threads(shape)](
        on_card(batch.program), on_card(batch.rows), x, cost, steps, most, normal, factor
    )
    ends = zip(x.copy_to_host(), cost.copy_to_host().tolist(), steps.copy_to_host().tolist(), strict=True)
    return [Refined(*end) for end in ends]


def _evolve(
    batch: Batch,
    real: type[np.floating],
    generations: int,
    limits: tuple[float, int, float],
    on_progress: Callable[[int, float], None] | None,
) -> list[Run]:
    shape, runs = batch.shape, len(batch.keys)
    launch = Launch(batch, real, limits)
    stretch = int(max(1, _STRETCH_EVALUATIONS / (runs * shape.members * batch.rows.reading.shape[1])))
    stretches: list[np.ndarray] = []
    counts: list[np.ndarray] = []
    first = 0
    while first <= generations:
        history = launch.history(min(stretch, generations + 1 - first))
        launch.advance(first, history)
        counts.append(launch.done.copy_to_host())
        stretches.append(history.copy_to_host())
        first += history.shape[1]
        ran = counts[-1] > 0
        if on_progress is not None and ran.any():
            lowest = stretches[-1][ran, counts[-1][ran] - 1, 0]
            on_progress(min(first - 1, generations), float(lowest.min()))
        if not (counts[-1] == history.shape[1]).any():
            break
    populations = launch.members.copy_to_host().reshape(runs, shape.parameters, shape.members).astype(float)
    priced, still = launch.costs.copy_to_host().astype(float), launch.stale.copy_to_host()
    return [
        Run(
            np.ascontiguousarray(populations[run].T),
            priced[run],
            np.concatenate([part[run, : count[run]] for part, count in zip(stretches, counts, strict=True)]),
            int(still[run]),
        )
        for run in range(runs)
    ]
