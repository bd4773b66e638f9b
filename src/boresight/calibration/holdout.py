"""Errors on rows that were not fitted: a validation file, or cross-validation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.calibration.problem import rms
from boresight.calibration.result import ErrorSummary, Residuals
from boresight.calibration.robust import Fit, refine
from boresight.sensing import Cell, Readings
from boresight.sensing.linear import model_of

FOLDS = 5


@dataclass(frozen=True)
class HeldOut:
    """Sizes of errors on held-out rows.

    Attributes:
        method: how the rows were held out.
        before: (rows,) error sizes [m], geometry nominal and unknown frames fitted; NaN where a beam misses.
        after: (rows,) error sizes [m], identified.
    """

    method: str
    before: Float[np.ndarray, "rows"]
    after: Float[np.ndarray, "rows"]

    @property
    def residuals(self) -> Residuals:
        """These errors, summarised over the rows that both models can predict."""
        return summarise(self.method, self.before, self.after)


def on_validation_rows(nominal: Cell, identified: Cell, rows: Readings) -> HeldOut:
    """Returns the errors on rows kept for validation."""
    return HeldOut("validation rows", error_sizes(nominal, rows), error_sizes(identified, rows))


def by_cross_validation(fit: Fit, seed: int) -> HeldOut:
    """Returns each used row's error under a fit to the other folds' rows.

    Every fold's fit starts at the final one, which decides the optimum's neighbourhood but not the optimum.
    Rows that the final fit left out as gross errors are not held out either: they say nothing about the arm.

    Args:
        fit: the final fit.
        seed: of the assignment of rows to folds.
    """
    problem, kept = fit.problem, np.flatnonzero(fit.kept)
    count = len(kept)
    order = np.random.Generator(np.random.Philox(seed)).permutation(count)
    fold = np.empty(count, dtype=int)
    fold[order] = np.arange(count) % min(FOLDS, count)
    before, after = row_sizes(problem.errors(np.zeros(len(fit.x))))[kept], np.empty(count)
    for number in range(min(FOLDS, count)):
        weight = problem.row_weight.copy()
        weight[kept[fold == number]] = 0.0
        trained = problem.weighed(weight, problem.model_std)
        after[fold == number] = row_sizes(problem.errors(refine(trained, fit.x).best))[kept[fold == number]]
    return HeldOut(f"{FOLDS}-fold cross-validation", before, after)


def error_sizes(cell: Cell, rows: Readings) -> Float[np.ndarray, "rows"]:
    """Returns the size [m] of each row's error: of a range, or the length of a position's error vector."""
    return row_sizes(model_of(cell, rows, ()).errors(np.empty(0)))


def row_sizes(errors: Float[np.ndarray, "rows channels"]) -> Float[np.ndarray, "rows"]:
    """Returns the size of each row's error; NaN where a beam misses."""
    return np.linalg.norm(errors, axis=1)


def summarise(method: str, before: Float[np.ndarray, "rows"], after: Float[np.ndarray, "rows"]) -> Residuals:
    """Returns RMS and maximum of error sizes over the rows that both models can predict."""
    both = np.isfinite(before) & np.isfinite(after)
    missed = int(np.count_nonzero(~np.isfinite(after)))
    return Residuals(method, int(np.count_nonzero(both)), missed, summary_of(before[both]), summary_of(after[both]))


def summary_of(errors: Float[np.ndarray, "rows"]) -> ErrorSummary:
    """Returns RMS, mean and maximum of error sizes; NaN where there are none."""
    if not len(errors):
        return ErrorSummary(float("nan"), float("nan"), float("nan"))
    return ErrorSummary(rms(errors), float(np.mean(errors)), float(np.max(errors)))
