"""Case-1 least squares a second on a card: Levenberg-Marquardt from the nominal model, in double precision.

The time is whole: from the costs to the refined parameters on the host. Beside it the processor's least squares of the
same campaigns, and the largest difference of the two ends in the parameters' standard deviations.
"""

from __future__ import annotations

import time

import numpy as np

from benchmarks.report import Figure, Table
from benchmarks.speed.lines import duration
from benchmarks.speed.timing import say
from boresight.calibration.problem import Problem
from boresight.calibration.robust import refine
from boresight.sensing.on_card import refine_on_card

TARGET = 100_000
"""Refinements a second on one H100."""


def refining(problems: list[Problem], runs: int, rounds: int) -> tuple[Table, Figure]:
    """Returns refinements a second and how the card's ends compare with the processor's.

    Args:
        problems: campaigns with priors; they are refined in turn.
        runs: refinements of a launch.
        rounds: launches that are timed.
    """
    chosen = [problems[run % len(problems)] for run in range(runs)]
    costs, starts = [problem.cost for problem in chosen], [np.zeros(len(problem.names)) for problem in chosen]
    say(f"gpu: least squares, {runs:,} refinements a launch")
    refine_on_card(costs[:1], starts[:1])
    seconds = []
    for _ in range(rounds):
        began = time.perf_counter()
        there = refine_on_card(costs, starts)
        seconds.append(time.perf_counter() - began)
    apart, here = [], []
    for problem, found in zip(problems, there, strict=False):
        began = time.perf_counter()
        expected = refine(problem, np.zeros(len(problem.names))).best
        here.append(time.perf_counter() - began)
        apart.append(np.max(np.abs(found.x - expected) / np.sqrt(np.diag(problem.covariance(expected)))))
    rate = runs / float(np.median(seconds))
    steps = float(np.median([found.steps for found in there]))
    row = (
        f"{rate:,.0f}", duration(float(np.median(seconds))), f"{steps:.0f}", duration(float(np.median(here))),
        f"{max(apart):.1e}",
    )  # fmt: skip
    header = ("a second", "whole launch", "steps, median", "processor, one", "largest difference, std")
    return (
        Table("Least squares on the card, double precision", header, (row,)),
        Figure("least squares on the card, a second", f"{rate:,.0f}", f">= {TARGET:,} on one H100", rate >= TARGET),
    )
