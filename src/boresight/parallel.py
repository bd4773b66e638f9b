"""Many independent tasks on several workers: any `concurrent.futures` executor, processes of this machine by default.

Tasks carry their own seeds, so results do not depend on how many workers there are or on who did what.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait
from typing import TypeVar

Task = TypeVar("Task")
Value = TypeVar("Value")

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

AHEAD = 4
"""Tasks handed out to each worker beyond the one it works on: none waits, and few are lost to an interrupt."""


def worker_count(asked: int | None = None) -> int:
    """Returns how many processes to use: as asked, or the cores this process may run on."""
    if asked is not None:
        return asked
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextlib.contextmanager
def local_workers(count: int | None = None) -> Iterator[Executor]:
    """Yields worker processes of this machine, one thread each, and cancels what is left when it is over.

    They are spawned, not forked: compiled code and threads of the parent do not survive a fork. They end with their
    parent even where that is killed, and leave Ctrl-C to it.
    """
    spawning = multiprocessing.get_context("spawn")
    _have_silent_tracker()
    pool = ProcessPoolExecutor(worker_count(count), mp_context=spawning, initializer=_begin_worker)
    try:
        yield pool
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def completed(
    executor: Executor, function: Callable[[Task], Value], tasks: Iterable[Task], ahead: int = 0, retries: int = 0
) -> Iterator[tuple[int, Value]]:
    """Yields the place of a task and its value, as they come.

    Args:
        executor: who works.
        function: of one task, importable by a worker.
        tasks: each with its own seed; taken as they are handed out.
        ahead: most tasks handed out at a time; enough for this machine's cores by default.
        retries: how often a task that failed is handed out again: on a cluster, workers come and go. A broken
            pool of processes takes no more tasks, and ends it.
    """
    most = ahead or worker_count() * (1 + AHEAD)
    waiting: dict[Future[Value], tuple[int, Task, int]] = {}
    left = iter(enumerate(tasks))
    with _one_thread_each():
        try:
            while True:
                while len(waiting) < most and (one := next(left, None)) is not None:
                    waiting[executor.submit(function, one[1])] = (*one, retries)
                if not waiting:
                    return
                done, _ = wait(waiting, return_when=FIRST_COMPLETED)
                for future in done:
                    place, task, more = waiting.pop(future)
                    if more and future.exception() and not isinstance(future.exception(), BrokenExecutor):
                        waiting[executor.submit(function, task)] = (place, task, more - 1)
                    else:
                        yield place, future.result()
        finally:
            for future in waiting:
                future.cancel()


def in_order(executor: Executor, function: Callable[[Task], Value], tasks: Sequence[Task]) -> list[Value]:
    """Returns the values of all tasks, in their order."""
    found = dict(completed(executor, function, tasks))
    return [found[place] for place in range(len(tasks))]


def _have_silent_tracker() -> None:
    """Starts the process that removes what a killed parent leaves: it does so, and need not tell the user."""
    if os.name != "posix":
        return
    from multiprocessing import resource_tracker

    before = os.environ.get("PYTHONWARNINGS")
    os.environ["PYTHONWARNINGS"] = ",".join(filter(None, (before, "ignore:resource_tracker:UserWarning")))
    try:
        resource_tracker.ensure_running()
    finally:
        if before is None:
            del os.environ["PYTHONWARNINGS"]
        else:
            os.environ["PYTHONWARNINGS"] = before


def _begin_worker() -> None:
    """Leaves Ctrl-C to the parent, and ends when that is gone: a killed parent tells its workers nothing."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        _end_by_signal_with(parent.sentinel)
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_by_signal_with(pipe: int) -> None:
    """Has Linux end this process when a pipe's other end closes, whatever it computes: a thread has to wait for it."""
    with contextlib.suppress(ImportError, AttributeError, OSError):
        import fcntl

        fcntl.fcntl(pipe, fcntl.F_SETSIG, signal.SIGKILL)
        fcntl.fcntl(pipe, fcntl.F_SETOWN, os.getpid())
        fcntl.fcntl(pipe, fcntl.F_SETFL, fcntl.fcntl(pipe, fcntl.F_GETFL) | os.O_ASYNC)


def _end_with(parent: multiprocessing.process.BaseProcess) -> None:
    parent.join()
    os._exit(1)


@contextlib.contextmanager
def _one_thread_each() -> Iterator[None]:
    """Has processes that start meanwhile use one thread for linear algebra: cores are counted by processes."""
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
