"""A study, run: what is missing is handed to workers, and what they find is kept at once."""

from __future__ import annotations

import contextlib
import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor
from dataclasses import dataclass
from pathlib import Path

from boresight.errors import BoresightError
from boresight.parallel import AHEAD, completed, local_workers, worker_count
from boresight.studies.cluster import cluster_workers
from boresight.studies.grid import Study
from boresight.studies.on_card import EvolvedRun, Run, evolved_runs
from boresight.studies.outcome import Outcome
from boresight.studies.run import run
from boresight.studies.store import Store
from boresight.studies.summary import Summary, summarise

TASK_S, MOST_RUNS = 0.25, 32
"""Runs go to a worker in tasks of about this long [s], and of so many at most: handing them over costs little then,
and little is lost to an interrupt."""

RETRIES = 3
"""How often a task is handed out again that failed with its worker."""

RESTARTS = 3
"""How often local workers are started anew after one was killed, by the system for want of memory, say."""

Progress = Callable[[int, int], None]
"""Called with runs done and runs asked for."""


@dataclass(frozen=True, slots=True)
class Shard:
    """Every `count`-th run of a study, to divide it among machines by hand.

    Attributes:
        number: which, from 1.
        count: of how many.
    """

    number: int = 1
    count: int = 1

    def __post_init__(self) -> None:
        if not 1 <= self.number <= self.count:
            raise ValueError(f"shard {self.number} of {self.count}")

    def of(self, runs: Iterable[Run]) -> Iterator[Run]:
        """Yields this shard's runs; they do not depend on what is done already."""
        return (each for place, each in enumerate(runs) if place % self.count == self.number - 1)


def study(
    asked: Study,
    path: Path,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    executor: Executor | None = None,
    shard: Shard | None = None,
    on_progress: Progress | None = None,
) -> Summary:
    """Returns the summary of a study, after making the runs that its file does not hold yet.

    The numbers depend on neither the workers nor the order in which they finish; only `seconds` does.

    Args:
        asked: what to run.
        path: the sqlite file that keeps the outcomes, made if it is not there.
        workers: processes of this machine; one a core by default.
        scheduler: address of a Dask scheduler, whose workers do the work instead.
        executor: any other `concurrent.futures` executor that does.
        shard: which part of the runs to make; all by default.
        on_progress: called when it begins and after every task.

    Raises:
        BoresightError: the file is none of ours, or workers keep dying. What was done is kept.
    """
    with Store.open(path) as store:
        mine = list((shard or Shard()).of(asked.runs()))
        for restart in range(1 + RESTARTS):
            try:
                with _workers(workers, scheduler, executor) as (pool, count):
                    _make(store, mine, pool, count, on_progress or _silent)
                break
            except BrokenExecutor as error:
                if restart == RESTARTS or executor is not None:
                    raise BoresightError(
                        f"worker processes keep dying ({error}); is there enough memory? What was done is kept in "
                        f"{path}; go on with fewer --workers"
                    ) from None
        return summarise(asked, store)


def missing(store: Store, runs: Sequence[Run]) -> list[Run]:
    """Returns the runs that a store does not hold, in their order."""
    done = {key: store.seeds(point) for key, point in {point.key: point for point, _ in runs}.items()}
    return [(point, seed) for point, seed in runs if seed not in done[point.key]]


def run_task(task: Sequence[EvolvedRun]) -> list[Outcome]:
    """Returns the outcomes of some runs, in their order: what a worker does."""
    return [run(point, seed, evolved) for point, seed, evolved in task]


def _make(store: Store, mine: Sequence[Run], pool: Executor, threads: int, on_progress: Progress) -> None:
    left = missing(store, mine)
    done = len(mine) - len(left)
    on_progress(done, len(mine))
    on_card = [(point, seed) for point, seed in left if point.on_card]
    here: list[EvolvedRun] = [(point, seed, None) for point, seed in left if not point.on_card]
    for some in itertools.chain([here], evolved_runs(on_card, pool)):
        tasks = _Tasks(some)
        for place, outcomes in completed(pool, run_task, tasks, ahead=threads * (1 + AHEAD), retries=RETRIES):
            runs = tasks.handed_out.pop(place)
            store.add_many((point, seed, outcome) for (point, seed, _), outcome in zip(runs, outcomes, strict=True))
            tasks.took([outcome.seconds for outcome in outcomes])
            done += len(runs)
            on_progress(done, len(mine))


class _Tasks:
    """Runs in tasks, the first of one run, later as many as take `TASK_S`."""

    def __init__(self, runs: Sequence[EvolvedRun]) -> None:
        self._runs = runs
        self._size = 1
        self.handed_out: dict[int, Sequence[EvolvedRun]] = {}

    def __iter__(self) -> Iterator[Sequence[EvolvedRun]]:
        first = number = 0
        while first < len(self._runs):
            task = self._runs[first : first + self._size]
            self.handed_out[number] = task
            first, number = first + len(task), number + 1
            yield task

    def took(self, seconds: Sequence[float]) -> None:
        """Lets later tasks be as long as they should be, by what the last one took a run."""
        known = [each for each in seconds if math.isfinite(each)]  # a run that failed took none
        each = max(sum(known) / max(len(known), 1), 1e-3)
        self._size = max(1, min(MOST_RUNS, int(TASK_S / each)))


@contextlib.contextmanager
def _workers(count: int | None, scheduler: str | None, executor: Executor | None) -> Iterator[tuple[Executor, int]]:
    """Yields who works, and how many they are."""
    if executor is not None:
        yield executor, worker_count(count)
    elif scheduler is not None:
        with cluster_workers(scheduler) as workers:
            yield workers
    else:
        with local_workers(count) as pool:
            yield pool, worker_count(count)


def _silent(done: int, asked: int) -> None:
    pass
