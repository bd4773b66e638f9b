"""The campaigns that are timed: the paper's cases (section 4.4), and larger ones of the same kind.

One plane whose tilt is estimated, 25 parameters; case 1 has 35 readings, case 2 100. The cost is the paper's: squared
range errors without priors, so that all that is left is arithmetic and search.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from benchmarks.space_arm import draw, one_plane
from boresight.calibration.problem import Problem

MEMBERS, GENERATIONS = 150, 500
EVALUATIONS = MEMBERS * (GENERATIONS + 1)
"""The paper's (eq. 24), first population included."""

SCALE, CROSSOVER = 0.6, 0.9
"""F and CR (eq. 24)."""

CASES = {1: 35, 2: 100}
"""Readings of each case."""


@cache
def believed(rows: int, seed: int = 0) -> Problem:
    """Returns a campaign with its priors, as `calibrate` has it."""
    return draw(one_plane(rows), seed).problem


@cache
def plain(rows: int, seed: int = 0) -> Problem:
    """Returns the same without priors."""
    problem = believed(rows, seed)
    return replace(problem, freedoms=tuple(replace(f, prior_std=None) for f in problem.freedoms))


def rms_mm(cost: float, problem: Problem) -> float:
    """Returns the RMS range error [mm] of a cost [m²]."""
    return float(1e3 * np.sqrt(cost / len(problem.readings)))
