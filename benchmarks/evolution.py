"""When least squares from the nominal model is enough, and what evolution adds.

For each size of the initial errors (the search box grows with it), share of gross errors, number of readings and
cell, over seeds: does a solver end at the best optimum known? That is the one of lowest trimmed cost among a fit
started at the truth and the solvers' own, judged by the smallest model_std. A solver reached it where no parameter
differs by more than 5 % of its standard deviation. The solvers:

- *least squares*: `robust.fit` from the nominal model (`--solver least-squares`).
- *evolution*: the best member after the paper's 500 generations (`--solver evolution`).
- *polished*: least squares from there.
- *default*: the lower of the first and the third (`--solver evolution+least-squares`).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.parallel import on_all_cores
from benchmarks.report import Report, Table, percent
from benchmarks.space_arm import Setup, draw, one_plane, three_planes
from boresight.calibration.robust import fit, lower
from boresight.calibration.solve import SAME_OPTIMUM
from boresight.search import DifferentialEvolution, evolve
from boresight.synthetic import spoiled

UNIT = {"angle": 0.01, "length": 0.003, "number": 0.01}
"""Half-widths of the initial errors of size 1 [rad, m, 1]."""

SIZES = (1, 3, 10, 30)

STEEPEST = 0.02
"""Planes are never off by more than this: beyond, (23) could not be told from one that leans the other way."""

SETTINGS = (
    (one_plane, 35, (0.0, 0.08)),
    (one_plane, 100, (0.0, 0.08, 0.25)),
    (three_planes, 100, (0.0, 0.08, 0.25)),
)
"""Cells, numbers of readings and shares of gross errors. A quarter of 35 readings leaves 26 for 25 parameters, which
no search can tell from noise."""

SOLVERS = ("least squares", "evolution", "polished", "default")


@dataclass(frozen=True)
class Contest:
    """The outcome of one campaign.

    Attributes:
        reached: whether each of `SOLVERS` ended at the best optimum known.
        truth_best: whether the fit started at the truth did: else the data prefer an optimum that is not it.
        seconds: what least squares, evolution and polishing took.
    """

    reached: tuple[bool, ...]
    truth_best: bool
    seconds: tuple[float, float, float]


def contest(task: tuple[int, Setup, float]) -> Contest:
    """Returns which solvers reach the best optimum of the campaign of a seed, kind and share of gross errors."""
    seed, kind, share = task
    drawn = draw(kind, seed)
    problem = drawn.with_readings(spoiled(drawn.problem.readings, share, seed)[0])
    problem.robust_cost.load(DifferentialEvolution(), problem.box)
    direct = fit(problem, np.zeros(len(drawn.x)))
    evolved = evolve(problem.robust_cost, problem.box, seed=seed)
    polished = fit(problem, evolved.best)
    from_truth = fit(problem, drawn.x)
    best = lower(lower(from_truth, polished), direct)
    std = np.sqrt(np.diag(best.problem.covariance(best.x)))
    ends = (direct.x, evolved.best, polished.x, lower(polished, direct).x, from_truth.x)
    *reached, truth_best = (bool(np.all(np.abs(x - best.x) <= SAME_OPTIMUM * std)) for x in ends)
    return Contest(tuple(reached), truth_best, (direct.search.seconds, evolved.seconds, polished.search.seconds))


def run(quick: bool) -> Report:
    """Returns how often each solver reaches the best optimum known, and what it takes."""
    count = 5 if quick else 50
    lines = [
        (kind, share, size)
        for make, readings, shares in SETTINGS
        for share, size in itertools.product(shares, SIZES)
        for kind in [_sized(make, readings, size)]
    ]
    tasks = [(seed, kind, share) for kind, share, _ in lines for seed in range(count)]
    outcomes = on_all_cores(contest, tasks)
    rows = []
    for place, (kind, share, size) in enumerate(lines):
        of_line = outcomes[place * count : (place + 1) * count]
        reached = np.mean([(*o.reached, o.truth_best) for o in of_line], axis=0)
        least, evolution, polish = np.array([o.seconds for o in of_line]).T
        times = (np.median(t) for t in (least, evolution, least + evolution + polish))
        errors = f"{size * UNIT['angle']:g} rad, {1e3 * size * UNIT['length']:g} mm"
        shown = (*(percent(r, 0) for r in reached), *(f"{1e3 * t:.0f}" for t in times))
        rows.append((kind.name, percent(share, 0), errors, *shown))
    header = ("campaign", "gross errors", "initial errors within", *SOLVERS, "from the truth")
    times = ("least squares, ms", "evolution, ms", "default, ms")
    return Report(
        "evolution",
        f"{count} campaigns a line; see the module's docstring. Times are medians, one campaign a core.",
        (),
        (Table("Share of campaigns that ended at the best optimum known", (*header, *times), tuple(rows)),),
    )


def _sized(make: Callable[..., Setup], rows: int, size: float) -> Setup:
    widths = {quantity: size * unit for quantity, unit in UNIT.items()}
    return make(rows, widths | {"number": min(widths["number"], STEEPEST)})
