"""Least squares inside a box, for where the free optimum lies outside: Gauss-Newton steps that end at its faces.

Each step is the best one of the linear problem inside the box and inside a trust region that is a box too, found
exactly (bounded-variable least squares; Stark & Parker 1995). Held parameters so end on their bounds to the bit, where
SciPy's trust-region reflective stays off them, and takes an SVD of the whole Jacobian a step.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from boresight.search.levenberg_marquardt import FTOL, GTOL, XTOL, Descent, Vector
from boresight.search.triangles import Triangle

_SMALLEST = 1e-16


def descend_within(
    square: Callable[[Vector], float],
    triangle: Callable[[Vector], Triangle],
    start: Vector,
    lower: Vector,
    upper: Vector,
    evaluations: int,
) -> Descent:
    """Returns the minimum of a sum of squares inside a box that the steepest way leads to.

    Args:
        square: the sum at a point; its parameters are all about one in size.
        triangle: the residuals' derivatives there.
        start: where to begin, inside.
        lower: lower bounds, -inf where there is none.
        upper: upper bounds, inf where there is none.
        evaluations: how many sums may be evaluated.
    """
    point, value, used = start, square(start), 1
    radius = max(1.0, float(np.max(np.abs(start), initial=0.0)))
    while value > 0.0:
        here, gain = triangle(point), 0.0
        if _flat(here, point, lower, upper, value):
            break
        while gain < 1e-4:
            low, high = np.maximum(lower - point, -radius), np.minimum(upper - point, radius)
            step = _best_within(here, low, high)
            trial = np.clip(point + step, lower, upper)
            trial_value, used = square(trial), used + 1
            foreseen = here.square - _square_after(here, step)
            fell = value - trial_value
            gain = fell / foreseen if foreseen > 0.0 else 0.0
            length = float(np.max(np.abs(step), initial=0.0))
            radius = 0.25 * min(radius, length) if gain < 0.25 else max(radius, 2.0 * length) if gain > 0.75 else radius
            settled = abs(fell) <= FTOL * value and foreseen <= FTOL * value
            if gain >= 1e-4:
                point, value = trial, trial_value
            if settled or min(length, radius) <= max(XTOL * float(np.linalg.norm(point)), _SMALLEST):
                return Descent(point, value, True, used)
            if used >= evaluations:
                return Descent(point, value, False, used)
    return Descent(point, value, True, used)


def _flat(here: Triangle, point: Vector, lower: Vector, upper: Vector, value: float) -> bool:
    """Returns whether no column of the Jacobian that the box lets move is at an angle to the residuals."""
    gradient, sizes = here.gradient, np.linalg.norm(here.slopes, axis=0)
    moves = ~((point <= lower) & (gradient > 0.0) | (point >= upper) & (gradient < 0.0))
    cosines = np.abs(gradient) / (np.where(sizes > 0.0, sizes, 1.0) * np.sqrt(value))
    return bool(np.all(cosines[moves] <= GTOL))


def _square_after(here: Triangle, step: Vector) -> float:
    """Returns the sum of squares that the linear problem has after a step."""
    rest = here.slopes @ step
    return here.square + float(rest @ (rest + 2.0 * here.residual))


def _best_within(here: Triangle, low: Vector, high: Vector) -> Vector:
    """Returns the step of the linear problem inside a box that holds 0."""
    step = np.linalg.lstsq(here.slopes, -here.residual, rcond=None)[0]
    if np.all((step >= low) & (step <= high)):
        return step
    from scipy import optimize

    thick = high - low > 0.0  # a parameter whose bounds meet does not move
    step = np.zeros_like(low)
    found = optimize.lsq_linear(
        here.slopes[:, thick], -here.residual, (low[thick], high[thick]), method="bvls", tol=1e-15, max_iter=1000
    )
    step[thick] = found.x
    return step
