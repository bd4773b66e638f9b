"""Coverage factors: from a covariance to the interval or ball that holds the truth with 95 % probability.

Where the size of the noise was itself estimated from a few residuals, Student's t and Fisher's F take the place of the
normal and of chi-square (JCGM 100, annex G); degrees of freedom of a combined variance are Welch's and Satterthwaite's.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

PROBABILITY = 0.95


def interval_factor(freedom: Float[np.ndarray, "values"]) -> Float[np.ndarray, "values"]:
    """Returns the coverage factor k of a single value: 1.96 with known noise, Student's t else."""
    from scipy import special

    upper = 0.5 * (1.0 + PROBABILITY)
    known = np.isinf(freedom)
    return np.where(known, special.ndtri(upper), special.stdtrit(np.where(known, 1.0, freedom), upper))


def ball_radius(
    covariance: Float[np.ndarray, "rows size size"], freedom: Float[np.ndarray, "rows"]
) -> Float[np.ndarray, "rows"]:
    """Returns the radius of the ball that holds a vector of zero mean with 95 % probability.

    The squared length is a sum of chi-squares weighted by the eigenvalues, of which mean and variance are matched (Box
    1954, Annals of Mathematical Statistics 25, theorem 3.1); exact for one direction and for equal ones.
    """
    from scipy import special

    total = np.trace(covariance, axis1=1, axis2=2)
    squares = np.einsum("rij,rji->r", covariance, covariance)
    directions = np.where(squares > 0.0, total**2 / np.where(squares > 0.0, squares, 1.0), 1.0)
    return np.sqrt(np.maximum(total, 0.0) * _mean_square(special, directions, freedom))


def ellipsoid_square(freedom: Float[np.ndarray, "rows"], size: int = 3) -> Float[np.ndarray, "rows"]:
    """Returns the squared Mahalanobis distance within which a vector lies with 95 % probability."""
    from scipy import special

    return size * _mean_square(special, np.full(len(freedom), float(size)), freedom)


def effective_freedom(
    total: Float[np.ndarray, "values"], estimated: Float[np.ndarray, "values"], freedom: float
) -> Float[np.ndarray, "values"]:
    """Returns the degrees of freedom of variances of which a part was estimated with so many (Welch-Satterthwaite).

    Args:
        total: the variances.
        estimated: the part of each that rests on an estimated size of the noise.
        freedom: degrees of freedom of that estimate, infinite where the size is known.
    """
    share = np.where(total > 0.0, np.clip(estimated / np.where(total > 0.0, total, 1.0), 1e-9, 1.0), 1.0)
    return np.full(len(total), np.inf) if np.isinf(freedom) else np.minimum(freedom / share**2, 1e9)


def _mean_square(special, directions: np.ndarray, freedom: np.ndarray) -> np.ndarray:
    """Returns the 95 % point of a mean square of so many normal values, its scale estimated with some freedom."""
    known = np.isinf(freedom)
    chi = special.chdtri(directions, 1.0 - PROBABILITY) / directions
    return np.where(known, chi, special.fdtri(directions, np.where(known, 1.0, freedom), PROBABILITY))
