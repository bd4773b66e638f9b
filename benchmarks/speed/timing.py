"""Times of things that are compared: run in turns, so that what else the machine does meets all alike.

The median is the main number; the minimum stands beside it, for other processes only ever add.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

MOST_REPEATS = 20
"""In a round; quick things run several times a round, so that a round is not spent on the slow ones alone."""

_SLICE_SECONDS = 0.2


@dataclass(frozen=True)
class Entry:
    """One thing to time.

    Attributes:
        who: does it.
        run: does it under a seed, and returns how well: lower is better; None where there is nothing to judge.
        notes: what a reader should know.
        is_ours: whether the others are compared with it.
    """

    who: str
    run: Callable[[int], float | None]
    notes: str = ""
    is_ours: bool = False


@dataclass
class Timed:
    """What an entry took, and how well it ended.

    Attributes:
        entry: it.
        seconds: wall time of each run.
        ends: what each returned.
    """

    entry: Entry
    seconds: list[float] = field(default_factory=list)
    ends: list[float] = field(default_factory=list)

    @property
    def median(self) -> float:
        """Median wall time [s]."""
        return float(np.median(self.seconds))

    @property
    def least(self) -> float:
        """Least wall time [s]."""
        return min(self.seconds)


def interleaved(entries: Iterable[Entry], rounds: int, *, title: str = "", warm: bool = True) -> list[Timed]:
    """Returns every entry timed in rounds.

    Args:
        entries: what to time.
        rounds: how often each has its turn; seeds differ from turn to turn and are the same for all.
        title: named on stderr while it runs.
        warm: whether to run everything once or twice first, untimed: the first run may compile.
    """
    timed = [Timed(entry) for entry in entries]
    repeats = [1] * len(timed)
    for place, each in enumerate(timed if warm else ()):
        say(f"{title}: {each.entry.who}, first run")
        seconds = 0.0
        for _ in range(2):
            began = time.perf_counter()
            each.entry.run(0)
            seconds = time.perf_counter() - began
            if seconds > 1.0:
                break
        repeats[place] = int(np.clip(_SLICE_SECONDS / (seconds + 1e-9), 1, MOST_REPEATS))
    for round_ in range(rounds):
        say(f"{title}: round {round_ + 1} of {rounds}")
        for each, times in zip(timed, repeats, strict=True):
            for repeat in range(times):
                began = time.perf_counter()
                end = each.entry.run(1 + round_ * MOST_REPEATS + repeat)
                each.seconds.append(time.perf_counter() - began)
                if end is not None:
                    each.ends.append(end)
    return timed


def say(text: str) -> None:
    """Tells on stderr what is being done."""
    print(text, file=sys.stderr, flush=True)
