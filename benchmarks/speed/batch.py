"""One range batch: the cost of some members over some configurations, in our compiled code and as others write it.

In whole-array NumPy, and in a compiled loop over members and readings with our flags, which is what the costs of
every peer are made of (`benchmarks.speed.peers.costs`). Members lie around the nominal arm, where every beam hits its
plane: a miss costs 10 km in ours and is not told from a hit in theirs, and somewhere in the whole box two of 100,000
beams miss for every member. All three are held to each other on the very members that are timed.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from benchmarks.speed.cases import plain, rms_mm
from benchmarks.speed.lines import Line, lines_of
from benchmarks.speed.peers.costs import compiled_costs, numpy_cost
from benchmarks.speed.timing import Entry, interleaved

WITHIN = 0.1
"""Share of the box that members are drawn in."""

_TURN, _RANGE = 5e-3, 3e-9
"""About how long [s] a turn lasts, and a range of a member in compiled code."""


def measure(readings: int, count: int, rounds: int) -> list[Line]:
    """Returns the lines of a batch; times are of one range of one member, the end is the cheapest member's error.

    Args:
        readings: how many ranges.
        count: of members.
        rounds: how often each has its turn.
    """
    problem = plain(readings)
    box = problem.box
    members = WITHIN * np.random.default_rng(0).uniform(box.lower, box.upper, (count, len(box)))
    across = np.ascontiguousarray(members.T)
    whole, compiled = numpy_cost(problem), compiled_costs(problem)
    for costs in (compiled(members), whole(across)):
        np.testing.assert_allclose(costs, problem.cost(members), rtol=1e-9)
    # What is short is done several times a turn, all about equally long.
    ways = (
        ("Boresight", lambda: problem.cost(members), 1.0),
        ("compiled, a member at a time", lambda: compiled(members), 1.0),
        ("NumPy, whole arrays", lambda: whole(across), 30.0),
    )
    repeats = [max(1, int(_TURN / (slower * _RANGE * count * readings))) for _, _, slower in ways]
    entries = [
        Entry(who, _run(cost, again, problem), is_ours=who == "Boresight")
        for (who, cost, _), again in zip(ways, repeats, strict=True)
    ]
    title = f"range batch, {readings:,} x {count:,}"
    timed = interleaved(entries, rounds, title=title)
    for each, again in zip(timed, repeats, strict=True):
        each.seconds[:] = [seconds / (again * count * readings) for seconds in each.seconds]
    return lines_of(f"{title}, a range", timed, "mm RMS")


def _run(cost: Callable[[], np.ndarray], again: int, problem) -> Callable[[int], float]:
    def run(_: int) -> float:
        for _again in range(again):
            costs = cost()
        return rms_mm(float(costs.min()), problem)

    return run
