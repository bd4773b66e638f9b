"""How surely each way of evolving reaches the optimum: both cases of the paper, its evaluations and half of them.

A campaign a seed (35 and 100 readings, the plane's tilt estimated, 25 parameters; truth, configurations, noise and
first population all differ), the paper's cost: squared range errors, no priors, no early stop. The optimum is what
least squares ends at inside the same box, the lower of a start at the nominal model and one at the truth. A search
reached it where the RMS range error of its best member is within 1 % of the optimum's: with 35 readings for 25
parameters that is a fifth of a standard deviation for all parameters together.

Strategies run once with the paper's evaluations, and their history is read at half of them as well; populations
other than 150 are cut to whole generations within the budget. Rivals, whose schedules depend on the budget, run once
for each: L-SHADE (Tanabe & Fukunaga 2014) and jSO (Brest, Maučec & Bošković 2017) of minionpy (C++), with its own
settings, given our compiled cost a population at a time. Times are medians, other processes running: compare them
only among searches that ran on as many seeds.
"""

from __future__ import annotations

import importlib.util
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from benchmarks.parallel import on_all_cores
from benchmarks.report import Figure, Report, Table, percent
from benchmarks.space_arm import Setup, draw, one_plane
from boresight.calibration.problem import Problem
from boresight.search import STRATEGIES, DifferentialEvolution, Stops, evolve, least_squares

ROWS = (35, 100)
"""Readings of case 1 and of case 2."""

FULL, HALF = 75_150, 37_500
"""Evaluations of the paper, first population included, and half of them."""

WITHIN = 1.01
RIVALS = ("LSHADE", "jSO")
NEW = "downhill"
EVERYWHERE = ("trade-off", NEW)

Measured = tuple[float, float]
"""RMS over the optimum's, and seconds."""

FIRST_SEED = 10_000
"""The new strategy's settings were found on seeds below 1,000; these are others."""

VARIANTS = {name: DifferentialEvolution(strategy) for name, strategy in STRATEGIES.items()}
"""Every strategy with its own settings; the default and the new one run on every seed."""

PARTS = {
    "downhill, b and c as drawn": DifferentialEvolution(replace(STRATEGIES[NEW], downhill=False)),
    "downhill, the best alone": DifferentialEvolution(replace(STRATEGIES[NEW], elite=0.0)),
    "downhill, F fixed": DifferentialEvolution(replace(STRATEGIES[NEW], spread=0.0)),
    "downhill, CR = 0.9": DifferentialEvolution(STRATEGIES[NEW], crossover=0.9),
    "downhill, CR = 1": DifferentialEvolution(STRATEGIES[NEW], crossover=1.0),
}
"""What the new strategy's parts are worth: each left out in turn. These and the rest run on a tenth of the seeds."""


def plain(kind: Setup, seed: int) -> tuple[Problem, np.ndarray]:
    """Returns the campaign of a seed without priors, and its true corrections."""
    drawn = draw(kind, seed)
    freedoms = tuple(replace(f, prior_std=None) for f in drawn.problem.freedoms)
    return replace(drawn.problem, freedoms=freedoms), drawn.x


def optimum(problem: Problem, truth: np.ndarray) -> float:
    """Returns the lowest sum of squared range errors [m²] in the box that least squares finds."""
    box, to_squares = problem.box, float(problem.usual_std**2)
    return to_squares * min(
        least_squares(problem.residual, problem.jacobian, start, scale=box.upper, lower=box.lower, upper=box.upper).cost
        for start in (np.zeros(len(box)), truth)
    )


def contest(task: tuple[int, int, bool]) -> dict[tuple[str, int], Measured]:
    """Returns what every search reached on the campaign of a number of readings and a seed, by name and budget.

    Args:
        task: number of readings, seed, and whether all searches run rather than the default and the new one.
    """
    rows, seed, all_of_them = task
    problem, truth = plain(one_plane(rows), seed)
    lowest = optimum(problem, truth)
    reached: dict[tuple[str, int], Measured] = {}
    for name, settings in (VARIANTS | PARTS if all_of_them else {name: VARIANTS[name] for name in EVERYWHERE}).items():
        problem.cost.load(settings, problem.box)
        for budget, (cost, seconds) in _evolved(problem, settings, seed).items():
            reached[name, budget] = float(np.sqrt(cost / lowest)), seconds
    for name in RIVALS if all_of_them and importlib.util.find_spec("minionpy") else ():
        for budget in (FULL, HALF):
            cost, seconds = _rivals(problem, name, budget, seed)
            reached[f"minionpy {name}", budget] = float(np.sqrt(cost / lowest)), seconds
    return reached


def run(quick: bool) -> Report:
    """Returns shares within 1 % of the optimum, how far the rest are, and times."""
    count = 20 if quick else 1000
    tasks = [(rows, FIRST_SEED + seed, seed < count // 10) for rows in ROWS for seed in range(count)]
    outcomes = on_all_cores(contest, tasks)
    of_case = {rows: outcomes[place * count : (place + 1) * count] for place, rows in enumerate(ROWS)}
    figures, tables = [], []
    for budget in (HALF, FULL):
        lines = []
        for name in [name for name, spent in outcomes[0] if spent == budget]:
            ends = {rows: np.array([o[name, budget] for o in of_case[rows] if (name, budget) in o]) for rows in ROWS}
            lines.append((name, f"{len(ends[ROWS[0]]):,}", *(shown for rows in ROWS for shown in _line(ends[rows]))))
            if name == NEW and budget == HALF:
                figures += [_figure(rows, ends[rows]) for rows in ROWS]
        header = ("search", "seeds", *(f"{rows} readings: {what}" for rows in ROWS for what in COLUMNS))
        tables.append(Table(f"At most {budget:,} evaluations", header, tuple(lines)))
    notes = () if importlib.util.find_spec("minionpy") else ("minionpy is not installed, so it was left out.",)
    about = f"{count:,} campaigns of each case; see the module's docstring."
    return Report("strategies", about, tuple(figures), tuple(tables), notes)


COLUMNS = ("within 1 %", "median", "99th percentile", "worst", "ms")
"""Of a case: the share of seeds within 1 % of the optimum; RMS over the optimum's; median time."""


def _line(ends: np.ndarray) -> tuple[str, ...]:
    ratio, seconds = ends.T
    told = (np.median(ratio), np.quantile(ratio, 0.99), ratio.max())
    return (percent(float(np.mean(ratio <= WITHIN))), *(f"{r:.4g}" for r in told), f"{1e3 * np.median(seconds):.0f}")


def _figure(rows: int, ends: np.ndarray) -> Figure:
    share = float(np.mean(ends[:, 0] <= WITHIN))
    return Figure(f"{NEW}, {rows} readings, half the evaluations", percent(share), ">= 99 %", share >= 0.99)


def _generations(budget: int, members: int) -> int:
    return budget // members - 1


def _evolved(problem: Problem, settings: DifferentialEvolution, seed: int) -> dict[int, Measured]:
    """Returns the best cost within each budget, and the time it takes."""
    last = _generations(FULL, settings.population)
    found = evolve(problem.cost, problem.box, settings, Stops(last, patience=last + 1), seed=seed)
    ends = {budget: _generations(budget, settings.population) for budget in (FULL, HALF)}
    return {b: (float(found.history[end, 0]), found.seconds * (end + 1) / (last + 1)) for b, end in ends.items()}


def _rivals(problem: Problem, algorithm: str, budget: int, seed: int) -> Measured:
    """Returns minionpy's lowest cost and its time."""
    import minionpy

    spent, lowest = 0, np.inf
    cost: Callable[[np.ndarray], np.ndarray] = problem.cost

    def told(members: list[list[float]], *_: object) -> list[float]:
        nonlocal spent, lowest
        costs = cost(np.array(members))
        counted = costs[: max(budget - spent, 0)]
        spent += len(costs)
        lowest = min(lowest, float(counted.min(initial=np.inf)))
        return costs.tolist()

    bounds = list(zip(problem.box.lower, problem.box.upper, strict=True))
    started = time.perf_counter()
    minionpy.Minimizer(told, bounds, algo=algorithm, maxevals=budget, seed=seed).optimize()
    return lowest, time.perf_counter() - started
