"""Evolution on an NVIDIA card: many calibrations at once, each what `search.evolve` would make of it."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import numpy as np

from boresight.kernels.cuda.batches import Task
from boresight.kernels.random import run_key
from boresight.search import Box, Device, DifferentialEvolution, Evolved, Population, Stops
from boresight.sensing.compiled import CompiledCost


def task_of(cost: CompiledCost, box: Box, settings: DifferentialEvolution, seed: int) -> Task:
    """Returns an evolution as the flat arrays that a card is given.

    Args:
        cost: what is minimised.
        box: where.
        settings: strategy, Np, F and CR.
        seed: of its random numbers.
    """
    key = int(run_key(np.uint64(seed), np.uint64(0)))
    return Task(cost.program, cost.rows, settings.breeding(box), settings.population, key)


def evolve_on_card(
    tasks: Sequence[Task],
    device: Device,
    stops: Stops,
    on_progress: Callable[[int, float], None] | None = None,
) -> list[Evolved]:
    """Returns the end of every evolution, in their order.

    The random numbers are those of `search.evolve`, and so is every step; in double precision a search takes the
    same path until rounding parts the two, for the card multiplies and adds in one operation.

    Args:
        tasks: what to run; those of one shape (arm, sensors, targets, rows, free parameters) run at once.
        device: a card and its precision.
        stops: G, V and patience.
        on_progress: called with generations completed and the lowest cost.

    Raises:
        BoresightError: there is no card, or what it needs is not installed.
    """
    from boresight.kernels.cuda.devices import require_card

    require_card()
    from boresight.kernels.cuda.running import evolve_tasks

    started = time.perf_counter()
    limits = (stops.cost, stops.patience, stops.improvement)
    runs = evolve_tasks(tasks, device.real, stops.generations, limits, on_progress)
    seconds = (time.perf_counter() - started) / max(len(tasks), 1)
    found = []
    for task, run in zip(tasks, runs, strict=True):
        population = Population(task.key, run.members, run.costs, len(run.history))
        found.append(
            Evolved(
                best=population.best,
                cost=population.best_cost,
                outcome=stops.outcome(population.generation - 1, population.best_cost, run.stale),
                population=population,
                history=run.history,
                evaluations=task.members * population.generation,
                seconds=seconds,
            )
        )
    return found
