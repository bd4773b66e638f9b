"""Least squares with an exact Jacobian, in units in which every parameter is about one."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from boresight.search.stopping import Outcome

Vector = Float[np.ndarray, "parameters"]


@dataclass(frozen=True)
class LeastSquares:
    """The end of a least-squares search.

    Attributes:
        best: (parameters,) where it ended.
        cost: sum of squared residuals there.
        outcome: why it ended.
        evaluations: residual vectors evaluated.
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
    """Returns the nearest minimum of the sum of squared residuals inside a box.

    Levenberg-Marquardt (MINPACK; Moré 1978), and where that leaves the box, trust-region reflective (Branch,
    Coleman & Li 1999) inside it, both as SciPy has them. The second alone took an SVD of the whole Jacobian a
    step: 14 s instead of 2 for 400 positions and 27 parameters on two busy cores.

    Args:
        residual: (parameters,) to (residuals,).
        jacobian: its exact derivative, (residuals, parameters).
        start: where to begin; brought just inside the box if need be.
        scale: a typical size of each parameter.
        lower: lower bounds, -inf where there is none.
        upper: upper bounds, inf where there is none.
        evaluations: how many residual vectors may be evaluated.
    """
    from scipy import optimize

    started = time.perf_counter()
    inside = np.clip(start, lower + 1e-9 * scale, upper - 1e-9 * scale)

    def search(**method: Any) -> Any:
        return optimize.least_squares(
            lambda z: residual(z * scale),
            inside / scale,
            jac=lambda z: jacobian(z * scale) * scale,
            xtol=1e-12,
            ftol=1e-14,
            gtol=1e-12,
            max_nfev=evaluations,
            **method,
        )

    found = search(method="lm")
    used = int(found.nfev)
    if np.any(found.x * scale < lower) or np.any(found.x * scale > upper):
        found = search(method="trf", bounds=(lower / scale, upper / scale))
        used += int(found.nfev)
    return LeastSquares(
        best=found.x * scale,
        cost=2.0 * float(found.cost),
        outcome=Outcome.CONVERGED if found.status > 0 else Outcome.EVALUATIONS,
        evaluations=used,
        seconds=time.perf_counter() - started,
    )
