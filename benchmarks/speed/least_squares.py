"""Least squares from the nominal model: the campaign with its priors, as `calibrate` has it, 25 parameters.

Ours is `calibration.robust.refine`, one fit; on its second line `fit`, which also looks for gross errors and judges
the stated noise. SciPy's least_squares gets the same residual in the same scale and with the same tolerances, by
MINPACK (`lm`) and by its default (`trf`), with our exact Jacobian and with differences of two points.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from benchmarks.speed.cases import believed
from benchmarks.speed.lines import Line, lines_of
from benchmarks.speed.timing import Entry, interleaved
from boresight.calibration.problem import Problem, rms
from boresight.calibration.robust import fit, refine

TOLERANCES = {"xtol": 1e-12, "ftol": 1e-14, "gtol": 1e-12}


def measure(readings: int, rounds: int) -> list[Line]:
    """Returns the lines of a number of readings."""
    problem, start = believed(readings), np.zeros(len(believed(readings).names))
    entries = [
        Entry("Boresight, refine", _run(problem, lambda: refine(problem, start).best), is_ours=True),
        Entry("Boresight, robust fit", _run(problem, lambda: fit(problem, start).x), "looks for outliers"),
    ]
    for method in ("lm", "trf"):
        for how in ("our Jacobian", "2-point"):
            entries.append(Entry(f"SciPy {method}, {how}", _run(problem, _scipys(problem, method, how))))
    title = f"least squares, {readings:,} readings"
    return lines_of(title, interleaved(entries, rounds, title=title), "mm RMS")


def _scipys(problem: Problem, method: str, how: str) -> Callable[[], np.ndarray]:
    from scipy.optimize import least_squares

    scale = problem.scale
    exact = how == "our Jacobian"

    def solve() -> np.ndarray:
        found = least_squares(
            lambda z: problem.residual(z * scale),
            np.zeros(len(scale)),
            jac=(lambda z: problem.jacobian(z * scale) * scale) if exact else "2-point",
            method=method,
            **TOLERANCES,
        )
        return found.x * scale

    return solve


def _run(problem: Problem, solve: Callable[[], np.ndarray]) -> Callable[[int], float]:
    return lambda _: 1e3 * rms(problem.errors(solve()))
