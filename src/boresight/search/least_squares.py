"""Least squares with an exact Jacobian, in units in which every parameter is about one."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.search.bounded import descend_within
from boresight.search.levenberg_marquardt import Vector, descend
from boresight.search.stopping import Outcome
from boresight.search.triangles import Triangle


@dataclass(frozen=True)
class LeastSquares:
    """The end of a least-squares search.

    Attributes:
        best: (parameters,) where it ended.
        cost: sum of squared residuals there.
        outcome: why it ended.
        evaluations: sums of squared residuals evaluated.
        seconds: wall time.
    """

    best: Vector
    cost: float
    outcome: Outcome
    evaluations: int
    seconds: float

    @classmethod
    def at(cls, point: Vector, cost: float) -> LeastSquares:
        """Returns the search that had nothing to do."""
        return cls(point, cost, Outcome.CONVERGED, 1, 0.0)


def least_squares(
    residual: Callable[[Vector], Float[np.ndarray, "residuals"]],
    jacobian: Callable[[Vector], Float[np.ndarray, "residuals parameters"]],
    start: Vector,
    *,
    scale: Vector,
    lower: Vector,
    upper: Vector,
    evaluations: int = 200,
) -> LeastSquares:
    """Returns the nearest minimum of the sum of squared residuals inside a box; see `tall_least_squares`.

    Args:
        residual: (parameters,) to (residuals,).
        jacobian: its exact derivative, (residuals, parameters).
        start: where to begin; brought just inside the box if need be.
        scale: a typical size of each parameter.
        lower: lower bounds, -inf where there is none.
        upper: upper bounds, inf where there is none.
        evaluations: how many sums may be evaluated.
    """
    return tall_least_squares(
        lambda x: float(np.sum(residual(x) ** 2)),
        lambda x: Triangle.of(jacobian(x), residual(x)),
        start,
        scale=scale,
        lower=lower,
        upper=upper,
        evaluations=evaluations,
    )


def tall_least_squares(
    square: Callable[[Vector], float],
    triangle: Callable[[Vector], Triangle],
    start: Vector,
    *,
    scale: Vector,
    lower: Vector,
    upper: Vector,
    evaluations: int = 200,
) -> LeastSquares:
    """Returns the nearest minimum of a sum of squares inside a box, however many squares there are.

    Levenberg-Marquardt, and where that leaves the box, Gauss-Newton steps that end at its faces.

    Args:
        square: (parameters,) to the sum.
        triangle: (parameters,) to the residuals' derivatives.
        start: where to begin; brought just inside the box if need be.
        scale: a typical size of each parameter.
        lower: lower bounds, -inf where there is none.
        upper: upper bounds, inf where there is none.
        evaluations: how many sums may be evaluated.
    """
    started = time.perf_counter()
    inside = np.clip(start, lower + 1e-9 * scale, upper - 1e-9 * scale) / scale

    def square_at(z: Vector) -> float:
        return square(z * scale)

    def triangle_at(z: Vector) -> Triangle:
        return triangle(z * scale).scaled(scale)

    found = descend(square_at, triangle_at, inside, evaluations)
    used, best = found.evaluations, found.point * scale
    if np.any(best < lower) or np.any(best > upper):
        found = descend_within(square_at, triangle_at, inside, lower / scale, upper / scale, evaluations)
        used, best = used + found.evaluations, np.clip(found.point * scale, lower, upper)
    return LeastSquares(
        best=best,
        cost=found.square,
        outcome=Outcome.CONVERGED if found.converged else Outcome.EVALUATIONS,
        evaluations=used,
        seconds=time.perf_counter() - started,
    )
