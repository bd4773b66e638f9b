"""Linear least squares in which groups of parameters are held near zero, as firmly as the data themselves suggest.

Empirical Bayes: the parameters of a group are taken for draws from a normal distribution about zero, and its
standard deviation, with that of the noise, is where the readings are most probable (MacKay 1992). What the data do
not ask for shrinks to nothing, and what they hardly see stays small instead of running away.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

LEAST_STD, LARGEST_STD = 1e-7, 0.1
"""Bounds of a group's standard deviation, which is 0 or without end where nothing is there or nothing known."""

ROUNDS = 40
"""Rounds of re-estimation; most settle in ten to thirty, and a group that is not there goes on shrinking."""

_SETTLED = 1e-3


@dataclass(frozen=True)
class Squares:
    """What least squares needs to know of some rows: their normal equations. Rows add and subtract.

    Attributes:
        information: (parameters, parameters) J'J of the scaled Jacobian.
        pull: (parameters,) J'y of the scaled residuals y, measured minus predicted.
        square: y'y.
        count: number of values.
    """

    information: Float[np.ndarray, "parameters parameters"]
    pull: Float[np.ndarray, "parameters"]
    square: float
    count: int

    @classmethod
    def of(cls, jacobian: Float[np.ndarray, "values parameters"], y: Float[np.ndarray, "values"]) -> Squares:
        """Returns the normal equations of some values, each over its standard deviation."""
        return cls(jacobian.T @ jacobian, jacobian.T @ y, float(y @ y), len(y))

    def without(self, other: Squares) -> Squares:
        """Returns the normal equations of the other rows."""
        return Squares(
            self.information - other.information,
            self.pull - other.pull,
            self.square - other.square,
            self.count - other.count,
        )

    def on(self, columns: Int[np.ndarray, "some"]) -> Squares:
        """Returns the normal equations of some of the parameters."""
        return Squares(self.information[np.ix_(columns, columns)], self.pull[columns], self.square, self.count)


UNDECIDED = 1e-10
"""Share of the largest eigenvalue below which neither data nor priors decide a direction."""


@dataclass(frozen=True)
class Shrunk:
    """A fit with groups held near zero.

    Attributes:
        step: (parameters,) the fit.
        group_std: (groups,) standard deviation of each group's parameters.
        effective: (groups,) how many of each group's parameters the data decide.
        noise: standard deviation of what is left, of scaled residuals: 1 where the scale was right.
    """

    step: Float[np.ndarray, "parameters"]
    group_std: Float[np.ndarray, "groups"]
    effective: Float[np.ndarray, "groups"]
    noise: float


def shrink(
    squares: Squares,
    at: Float[np.ndarray, "parameters"],
    prior_std: Float[np.ndarray, "parameters"],
    group: Int[np.ndarray, "parameters"],
    start: Float[np.ndarray, "groups"],
) -> Shrunk:
    """Returns the step that the data and the priors ask for, and the groups' standard deviations.

    Args:
        squares: the rows.
        at: where the parameters are; priors pull to zero from there.
        prior_std: of the parameters of no group, infinite where nothing is believed.
        group: number of each parameter's group, -1 for none.
        start: standard deviations of the groups to begin with.
    """
    seen = np.diag(squares.information)
    scale = 1.0 / np.sqrt(np.where(seen > 0.0, seen, 1.0))
    scaled, pull = squares.information * np.outer(scale, scale), squares.pull * scale
    std, variance, grouped = start.astype(float), 1.0, group >= 0
    for _ in range(ROUNDS):
        prior = scale**2 / np.where(grouped, std[group] if len(std) else 1.0, prior_std) ** 2
        covariance = _inverse(scaled / variance + np.diag(prior), held=bool(np.all(prior > 0.0)))
        step = covariance @ (pull / variance - prior * at / scale)
        decided = 1.0 - prior * np.diag(covariance)
        effective = np.array([max(float(decided[group == each].sum()), 1e-9) for each in range(len(std))])
        sizes = np.array([float(np.sum(((step * scale + at)[group == each]) ** 2)) for each in range(len(std))])
        before, std = std, np.clip(np.sqrt(sizes / effective), LEAST_STD, LARGEST_STD) if len(std) else std
        left = squares.square - 2.0 * float(step @ pull) + float(step @ scaled @ step)
        variance, was = max(left, 1e-12) / max(squares.count - float(decided.sum()), 1.0), variance
        moved = np.abs(np.log(np.append(std / before, variance / was))) if len(std) else np.abs(np.log(variance / was))
        if np.all(moved < _SETTLED):
            break
    return Shrunk(step * scale, std, effective, float(np.sqrt(variance)))


def _inverse(matrix: Float[np.ndarray, "parameters parameters"], *, held: bool) -> np.ndarray:
    """Returns the inverse; where priors do not hold every parameter, without the directions that nothing decides."""
    return np.linalg.inv(matrix) if held else np.linalg.pinv(matrix, rcond=UNDECIDED, hermitian=True)
