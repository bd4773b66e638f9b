"""One range batch: the cost of 150 members over some configurations, in our compiled code and as others write it.

In whole-array NumPy, and in a compiled loop over members and readings with our flags, which is what the costs of
every peer are made of (`benchmarks.speed.peers.costs`). Members lie around the nominal arm, where every beam hits its
plane: a miss costs 10 km in ours and is not told from a hit in theirs, and somewhere in the whole box two of 100,000
beams miss for every member. All three are held to each other on the very members that are timed.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from benchmarks.speed.cases import MEMBERS, plain, rms_mm
from benchmarks.speed.lines import Line, lines_of
from benchmarks.speed.peers.costs import compiled_costs, numpy_cost
from benchmarks.speed.timing import Entry, interleaved

WITHIN = 0.1
"""Share of the box that members are drawn in."""


def measure(readings: int, rounds: int) -> list[Line]:
    """Returns the lines of a batch; times are of one range of one member, the end is the cheapest member's error."""
    problem = plain(readings)
    box = problem.box
    members = WITHIN * np.random.default_rng(0).uniform(box.lower, box.upper, (MEMBERS, len(box)))
    across = np.ascontiguousarray(members.T)
    whole, compiled = numpy_cost(problem), compiled_costs(problem)
    for costs in (compiled(members), whole(across)):
        np.testing.assert_allclose(costs, problem.cost(members), rtol=1e-9)
    again = max(1, int(5e-3 / (MEMBERS * readings * 3e-9)))
    entries = [
        Entry("Boresight", _run(lambda: problem.cost(members), again, problem), is_ours=True),
        Entry("compiled, a member at a time", _run(lambda: compiled(members), again, problem)),
        Entry("NumPy, whole arrays", _run(lambda: whole(across), max(1, again // 30), problem)),
    ]
    title = f"range batch, {readings:,} x {MEMBERS}"
    timed = interleaved(entries, rounds, title=title)
    for each, times in zip(timed, (again, again, max(1, again // 30)), strict=True):
        each.seconds[:] = [seconds / (times * MEMBERS * readings) for seconds in each.seconds]
    return lines_of(f"{title}, a range", timed, "mm RMS")


def _run(cost: Callable[[], np.ndarray], again: int, problem) -> Callable[[int], float]:
    def run(_: int) -> float:
        for _again in range(again):
            costs = cost()
        return rms_mm(float(costs.min()), problem)

    return run
