"""Score (Lagrange multiplier) tests: what a fit would gain from each effect that its model lacks.

The fit is linearised at its optimum. Every row counts, those too that it left out, by Huber's loss: that is convex in
a linear model, so that where rows were left out because an effect is missing, freeing the effect brings them back. A
score needs no fit of its own (Rao 1948; Breusch & Pagan 1980); the few best effects are then fitted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

QUADRATIC = 3.0
"""Standard deviations up to which a residual counts by its square, and beyond by its size (Huber 1964)."""

ITERATIONS = 20
SETTLED = 1e-6

IDENTIFIABLE = 1e-8
"""An effect of which less than this share is its own, and no parameter's, cannot be tested."""


@dataclass(frozen=True)
class LinearFit:
    """A robust linear fit of residuals r by columns A: r - A d, with priors pulling at d.

    Attributes:
        columns: (values, parameters) derivatives over the readings' standard deviations.
        residual: (values,) what they leave of the residuals.
        weight: (values,) each value's weight in the end.
        inverse: (parameters, parameters) of the normal equations' matrix.
        step: (parameters,) d.
        cost: Huber's loss and the priors', as a chi-square is.
    """

    columns: Float[np.ndarray, "values parameters"]
    residual: Float[np.ndarray, "values"]
    weight: Float[np.ndarray, "values"]
    inverse: Float[np.ndarray, "parameters parameters"]
    step: Float[np.ndarray, "parameters"]
    cost: float

    @property
    def decided(self) -> float:
        """How many parameters the values decide, rather than the priors."""
        weighted = self.columns * self.weight[:, None]
        return float(np.sum((self.columns.T @ weighted) * self.inverse))


def fit_robustly(
    columns: Float[np.ndarray, "values parameters"],
    residual: Float[np.ndarray, "values"],
    precision: Float[np.ndarray, "parameters"],
    at: Float[np.ndarray, "parameters"],
    weight: Float[np.ndarray, "values"] | None = None,
) -> LinearFit:
    """Returns the robust linear fit, by iteratively reweighted least squares.

    Args:
        columns: derivatives of the predicted values, over the readings' standard deviations.
        residual: measured minus predicted, over the same.
        precision: of each parameter's prior.
        at: where the parameters stand, from their priors' middle.
        weight: where to begin; every value counts in full by default.
    """
    weight = np.ones(len(residual)) if weight is None else weight
    step, rest, inverse = np.zeros(columns.shape[1]), residual, np.zeros((0, 0))
    for _ in range(ITERATIONS):
        weighted = columns * weight[:, None]
        inverse = _inverse(columns.T @ weighted + np.diag(precision))
        step, before = inverse @ (weighted.T @ residual - precision * at), step
        rest = residual - columns @ step
        weight = 1.0 / np.maximum(1.0, np.abs(rest) / QUADRATIC)
        if np.all(np.abs(columns @ (step - before)) <= SETTLED * (1.0 + np.abs(rest))):
            break
    size = np.abs(rest)
    loss = np.where(size <= QUADRATIC, size**2, QUADRATIC * (2.0 * size - QUADRATIC))
    return LinearFit(columns, rest, weight, inverse, step, float(np.sum(loss) + np.sum(precision * (at + step) ** 2)))


def scores(
    fit: LinearFit, effects: Sequence[Float[np.ndarray, "values numbers"]], stds: Sequence[Float[np.ndarray, "numbers"]]
) -> Float[np.ndarray, "effects"]:
    """Returns by how much each effect would lower the cost, to second order: its score statistic.

    Args:
        fit: without any of them.
        effects: derivatives by each effect's numbers, over the readings' standard deviations.
        stds: how large each effect's numbers may be.
    """
    weighted = fit.columns * fit.weight[:, None]
    found = np.zeros(len(effects))
    for place, (own, std) in enumerate(zip(effects, stds, strict=True)):
        shared = weighted.T @ own
        square = own.T @ (own * fit.weight[:, None])
        information = square - shared.T @ fit.inverse @ shared
        scale = np.sqrt(np.maximum(np.diag(square), 1e-300))
        values, directions = np.linalg.eigh(information / np.outer(scale, scale))
        kept = values > IDENTIFIABLE
        if not kept.any():
            continue
        pull = (directions.T @ ((own.T @ (fit.weight * fit.residual)) / scale))[kept]
        own_precision = np.sum((directions[:, kept] / (scale * std)[:, None]) ** 2, axis=0)
        found[place] = float(np.sum(pull**2 / (values[kept] + own_precision)))
    return found


def _inverse(matrix: Float[np.ndarray, "parameters parameters"]) -> Float[np.ndarray, "parameters parameters"]:
    scale = 1.0 / np.sqrt(np.maximum(np.diag(matrix), 1e-300))
    return scale[:, None] * np.linalg.pinv(matrix * np.outer(scale, scale), hermitian=True) * scale
