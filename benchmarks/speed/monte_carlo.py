"""Monte Carlo on one core and on two: the same study of case-1 identifications, in turns.

Time of a run from the first kept outcome to the last, so that the start of workers, which does not grow with a study,
is left out; what a run is, is said in `benchmarks.studies`, which also measures 10,000 of them whole.
"""

from __future__ import annotations

from benchmarks.speed.lines import Line, lines_of
from benchmarks.speed.timing import Entry, Timed, say
from benchmarks.studies import case1, timed
from boresight.studies import run as run_once

TITLE = "Monte Carlo, a case-1 run"


def measure(runs: int, rounds: int) -> list[Line]:
    """Returns the lines of one worker and of two, two first."""
    run_once(case1(1).points[0], 0)
    found = {
        workers: Timed(Entry(f"Boresight, {workers} core{'s' if workers > 1 else ''}", lambda _: None, f"{runs} runs"))
        for workers in (2, 1)
    }
    for round_ in range(rounds):
        for workers, each in found.items():
            say(f"Monte Carlo: round {round_ + 1} of {rounds}, {workers} workers, {runs} runs")
            each.seconds.append(timed(runs, workers)[1])
    return lines_of(TITLE, list(found.values()), per=runs)


def gain(lines: list[Line]) -> float:
    """Returns how many times as fast two cores are as one, of medians."""
    two, one = lines
    return one.median / two.median
