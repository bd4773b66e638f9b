"""Levenberg-Marquardt (Moré 1978) as MINPACK's `lmder` has it, on triangles in place of whole Jacobians.

MINPACK's own takes the Jacobian whole, and reaches it through SciPy row by row; its decisions need no more than the
triangle. The damped steps come from one singular value decomposition a point, of a matrix of parameters by parameters,
so that each further damping costs next to nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.search.triangles import Triangle

Vector = Float[np.ndarray, "parameters"]

FTOL, XTOL, GTOL = 1e-14, 1e-12, 1e-12
"""Relative fall of the sum of squares, step relative to the point, and cosine between the residuals and any column of
the Jacobian, below which the search has converged."""

UNSEEN = 1e-14
"""A singular value below this share of the largest moves nothing: no step goes along its direction."""

_FIRST_RADIUS = 100.0
_EPSILON = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Descent:
    """The end of a descent.

    Attributes:
        point: where.
        square: sum of squared residuals there.
        converged: whether no step improved it any further; otherwise evaluations ran out.
        evaluations: sums of squares evaluated.
    """

    point: Vector
    square: float
    converged: bool
    evaluations: int


@dataclass(frozen=True)
class _Damped:
    """Steps from a point by how firmly they are held.

    Attributes:
        sizes: singular values that are seen.
        pull: the residuals along them.
        directions: (seen, parameters).
    """

    sizes: Float[np.ndarray, "seen"]
    pull: Float[np.ndarray, "seen"]
    directions: Float[np.ndarray, "seen parameters"]

    @classmethod
    def of(cls, triangle: Triangle) -> _Damped:
        left, sizes, right = np.linalg.svd(triangle.slopes, full_matrices=False)
        seen = sizes > UNSEEN * max(float(sizes[0]), 1e-300)
        return cls(sizes[seen], (left.T @ triangle.residual)[seen], right[seen])

    def within(self, radius: float, damping: float) -> tuple[Vector, float]:
        """Returns the best step of about a radius at most, and its damping (MINPACK's `lmpar`)."""
        lengths = self.pull / self.sizes
        beyond = float(np.linalg.norm(lengths)) - radius
        if beyond <= 0.1 * radius:
            return -lengths @ self.directions, 0.0
        gradient = self.sizes * self.pull
        low = beyond * float(lengths @ lengths) / (radius * float(np.sum((lengths / self.sizes) ** 2)))
        high = max(float(np.linalg.norm(gradient)) / radius, 1e-300)
        damping = min(max(damping, low), high) or float(np.linalg.norm(gradient)) / float(np.linalg.norm(lengths))
        for trial in range(10):
            spread = self.sizes**2 + damping
            lengths = gradient / spread
            before, beyond = beyond, float(np.linalg.norm(lengths)) - radius
            if abs(beyond) <= 0.1 * radius or (low == 0.0 and beyond <= before < 0.0) or trial == 9:
                break
            low, high = (max(low, damping), high) if beyond > 0.0 else (low, min(high, damping))
            change = beyond * float(lengths @ lengths) / (radius * float(np.sum(lengths**2 / spread)))
            damping = max(low, damping + change)
        return -lengths @ self.directions, damping


def descend(
    square: Callable[[Vector], float], triangle: Callable[[Vector], Triangle], start: Vector, evaluations: int
) -> Descent:
    """Returns the minimum of a sum of squares that the steepest way leads to.

    Args:
        square: the sum at a point; its parameters are all about one in size.
        triangle: the residuals' derivatives there.
        start: where to begin.
        evaluations: how many sums may be evaluated.
    """
    point, norm, used = start, np.sqrt(square(start)), 1
    radius, damping, first = _FIRST_RADIUS * (float(np.linalg.norm(start)) or 1.0), 0.0, True
    while norm > 0.0:
        here = triangle(point)
        sizes = np.linalg.norm(here.slopes, axis=0)
        cosine = float(np.max(np.abs(here.gradient) / (np.where(sizes > 0.0, sizes, 1.0) * norm), initial=0.0))
        if cosine <= GTOL:
            break
        steps, gain = _Damped.of(here), 0.0
        while gain < 1e-4:
            step, damping = steps.within(radius, damping)
            length = float(np.linalg.norm(step))
            radius, first = (min(radius, length), False) if first else (radius, False)
            trial = point + step
            trial_norm, used = np.sqrt(square(trial)), used + 1
            fell = 1.0 - (trial_norm / norm) ** 2 if 0.1 * trial_norm < norm else -1.0
            straight = (float(np.linalg.norm(here.slopes @ step)) / norm) ** 2
            held = damping * (length / norm) ** 2
            foreseen = straight + 2.0 * held
            gain = fell / foreseen if foreseen > 0.0 else 0.0
            if gain <= 0.25:
                slope = straight + held
                shrunk = 0.5 if fell >= 0.0 else 0.5 * slope / (slope - 0.5 * fell)
                shrunk = 0.1 if 0.1 * trial_norm >= norm or shrunk < 0.1 else shrunk
                radius, damping = shrunk * min(radius, 10.0 * length), damping / shrunk
            elif damping == 0.0 or gain >= 0.75:
                radius, damping = 2.0 * length, 0.5 * damping
            if gain >= 1e-4:
                point, norm = trial, trial_norm
            still = abs(fell) <= FTOL and foreseen <= FTOL and gain <= 2.0
            if still or radius <= max(XTOL * float(np.linalg.norm(point)), _EPSILON * 1e-3):
                return Descent(point, float(norm**2), True, used)
            if used >= evaluations:
                return Descent(point, float(norm**2), False, used)
    return Descent(point, float(norm**2), True, used)
