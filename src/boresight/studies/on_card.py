"""Evolutions of many runs at once on this machine's card: workers draw the campaigns, the card searches."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor

from boresight.kernels.cuda.batches import Task
from boresight.parallel import in_order
from boresight.search import Evolved
from boresight.sensing.on_card import evolve_on_card
from boresight.studies.grid import Point
from boresight.studies.run import evolution_of

AT_A_TIME = 2048
"""Runs drawn, evolved and kept before the next ones: enough to fill a card, and little is lost to an interrupt."""

_TO_A_WORKER = 32

Run = tuple[Point, int]
EvolvedRun = tuple[Point, int, Evolved | None]


def evolved_runs(runs: Sequence[Run], pool: Executor) -> Iterator[list[EvolvedRun]]:
    """Yields runs, some at a time, each with its evolution; without one where it runs elsewhere or cannot."""
    for first in range(0, len(runs), AT_A_TIME):
        yield _evolved(runs[first : first + AT_A_TIME], pool)


def draw_tasks(runs: Sequence[Run]) -> list[Task | None]:
    """Returns the evolutions of some runs: what a worker does."""
    return [evolution_of(point, seed) for point, seed in runs]


def _evolved(runs: Sequence[Run], pool: Executor) -> list[EvolvedRun]:
    chunks = [runs[first : first + _TO_A_WORKER] for first in range(0, len(runs), _TO_A_WORKER)]
    tasks = [task for chunk in in_order(pool, draw_tasks, chunks) for task in chunk]
    found: list[Evolved | None] = [None] * len(runs)
    solvers = [point.solver for point, _ in runs]
    for device, stops in dict.fromkeys((solver.device, solver.stops) for solver in solvers):
        places = [
            place
            for place, (solver, task) in enumerate(zip(solvers, tasks, strict=True))
            if task is not None and (solver.device, solver.stops) == (device, stops)
        ]
        chosen = [task for place in places if (task := tasks[place]) is not None]
        for place, evolved in zip(places, evolve_on_card(chosen, device, stops), strict=True):
            found[place] = evolved
    return [(point, seed, evolved) for (point, seed), evolved in zip(runs, found, strict=True)]
