"""Identifications by evolution, one core: 150 members, 500 generations, 25 parameters, no early stop.

Every search spends 75,150 evaluations (`downhill` 120 x 626 = 75,120, and half of them on its second line; minionpy's
L-SHADE and jSO two or three more, which are not looked at), with F and CR alike where it lets them be set; seeds
differ from run to run. Peers: `benchmarks.speed.peers`.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from benchmarks.speed.cases import CASES, CROSSOVER, GENERATIONS, SCALE, plain, rms_mm
from benchmarks.speed.lines import Line, lines_of
from benchmarks.speed.peers import PEERS, entries
from benchmarks.speed.peers.costs import hold_to_ours
from benchmarks.speed.timing import Entry, interleaved
from boresight.calibration.problem import Problem
from boresight.calibration.robust import refine
from boresight.search import STRATEGIES, DifferentialEvolution, Stops, evolve

THEIRS = ("trade-off", "rand-to-best/1", "current-to-best/1")
"""Ours is the first, the default; the others are what the peers' strategies are."""


def workload(case: int) -> str:
    """Returns the name of a case's line."""
    return f"case {case}, {CASES[case]} readings"


def ours(problem: Problem, generations: int = GENERATIONS) -> list[Entry]:
    """Returns our strategies, the default first."""
    found = [
        _entry(problem, DifferentialEvolution(STRATEGIES[name], scale=SCALE, crossover=CROSSOVER), generations, name)
        for name in THEIRS
    ]
    found[0] = replace(found[0], is_ours=True)
    found.append(_refined(problem, generations))
    downhill = DifferentialEvolution(STRATEGIES["downhill"])
    whole = max(1, round(150 * (generations + 1) / downhill.population) - 1)
    found.append(_entry(problem, downhill, whole, "downhill"))
    found.append(_entry(problem, downhill, max(1, (whole - 4) // 2), "downhill, half of them"))
    return found


def measure(
    case: int, rounds: int, generations: int = GENERATIONS, peers: tuple[str, ...] = tuple(PEERS)
) -> list[Line]:
    """Returns the lines of a case."""
    problem = plain(CASES[case])
    hold_to_ours(problem)
    timed = interleaved(
        [*ours(problem, generations), *entries(problem, generations, peers)], rounds, title=workload(case)
    )
    return lines_of(workload(case), timed, "mm RMS")


def _refined(problem: Problem, generations: int) -> Entry:
    """Returns the default in single precision, with least squares in double precision behind it."""
    settings = DifferentialEvolution(scale=SCALE, crossover=CROSSOVER)
    cost, stops = problem.cost.single(), Stops(generations, cost=0.0, patience=10**9)
    cost.load(settings, problem.box)

    def run(seed: int) -> float:
        found = refine(problem, evolve(cost, problem.box, settings, stops, seed=seed).best)
        return rms_mm(float(problem.cost(found.best[None])[0]), problem)

    return Entry("Boresight, single precision", run, "then least squares")


def _entry(problem: Problem, settings: DifferentialEvolution, generations: int, name: str) -> Entry:
    cost: Any = problem.cost
    cost.load(settings, problem.box)
    stops = Stops(generations, cost=0.0, patience=10**9)

    def run(seed: int) -> float:
        return rms_mm(evolve(cost, problem.box, settings, stops, seed=seed).cost, problem)

    return Entry(f"Boresight, {name}", run)
