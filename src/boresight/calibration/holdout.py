"""Errors on rows that were not fitted: a validation file, or cross-validation."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int

from boresight.calibration.configurations import configurations_of
from boresight.calibration.problem import Problem, rms
from boresight.calibration.result import ErrorSummary, Residuals
from boresight.calibration.robust import Fit, refine, threshold
from boresight.inference import posterior_root
from boresight.sensing import Cell, Readings
from boresight.sensing.linear import model_of

FOLDS = 5

GROSS, MOST_GROSS = 2.0, 0.25
"""A validation row is grossly wrong beyond so many times what would leave it out of a fit; no more than this share of
them can be."""


@dataclass(frozen=True)
class HeldOut:
    """Sizes of errors on held-out rows.

    Attributes:
        method: how the rows were held out.
        before: (rows,) error sizes [m], geometry nominal and unknown frames fitted; NaN where a beam misses.
        after: (rows,) error sizes [m], identified.
        configuration: (rows,) number of the configuration a row was taken in; each row's its own where None.
        expected: (rows,) mean square [m²] that each row's error should have: of the readings' noise, of the model's own
            error, and of parameters as they are known from the other rows; None where not told.
        gross: lines of validation rows that do not fit with the others and are not judged by; their sizes are NaN.
    """

    method: str
    before: Float[np.ndarray, "rows"]
    after: Float[np.ndarray, "rows"]
    configuration: Int[np.ndarray, "rows"] | None = None
    expected: Float[np.ndarray, "rows"] | None = None
    gross: tuple[int, ...] = ()

    @property
    def residuals(self) -> Residuals:
        """These errors, summarised over the rows that both models can predict."""
        found = summarise(self.method, self.before, self.after)
        return replace(found, missed=found.missed - len(self.gross))


def on_validation_rows(fit: Fit, rows: Readings) -> HeldOut:
    """Returns the errors on rows kept for validation, those aside that are as grossly wrong as no fit would use."""
    nominal, identified = fit.problem.cell, fit.problem.fitted(fit.x)
    before, after = error_sizes(nominal, rows), error_sizes(identified, rows)
    expected = _expected(fit.problem, fit.x, rows)
    gross = _gross(after, expected, rows)
    before[gross] = after[gross] = np.nan
    lines = tuple(rows.line[gross].tolist())
    return HeldOut("validation rows", before, after, configurations_of(rows.joints), expected, lines)


def _gross(
    after: Float[np.ndarray, "rows"], expected: Float[np.ndarray, "rows"], rows: Readings
) -> Bool[np.ndarray, "rows"]:
    """Returns which rows chance gives once in a million, by what the usual row is off; none where they are many."""
    size = after / np.sqrt(expected)
    typical = max(float(np.nanmedian(size)) if np.isfinite(size).any() else 1.0, 1.0)
    limit = np.array([np.inf, *(threshold(count) for count in range(1, rows.channels.max(initial=0) + 1))])
    gross = np.nan_to_num(size, nan=0.0) > GROSS * typical * limit[rows.channels]
    return gross if np.count_nonzero(gross) <= MOST_GROSS * len(rows) else np.zeros(len(rows), dtype=bool)


def by_cross_validation(fit: Fit, seed: int) -> HeldOut:
    """Returns each used row's error under a fit to the other folds' rows, rows of one configuration in one fold.

    Every fold's fit starts at the final one, which decides the optimum's neighbourhood but not the optimum.
    Rows that the final fit left out as gross errors are not held out either: they say nothing about the arm.

    Args:
        fit: the final fit.
        seed: of the assignment of rows to folds.
    """
    problem, kept = fit.problem, np.flatnonzero(fit.kept)
    configuration = configurations_of(problem.readings.joints[kept])
    count = int(configuration.max(initial=-1)) + 1
    dealt = np.empty(count, dtype=int)
    dealt[np.random.Generator(np.random.Philox(seed)).permutation(count)] = np.arange(count) % min(FOLDS, count)
    fold = dealt[configuration]
    before, after = row_sizes(problem.errors(np.zeros(len(fit.x))))[kept], np.empty(len(kept))
    expected = np.empty(len(kept))
    for number in range(min(FOLDS, count)):
        weight = problem.row_weight.copy()
        weight[kept[fold == number]] = 0.0
        trained, held = problem.weighed(weight, problem.model_std), kept[fold == number]
        best = refine(trained, fit.x).best
        after[fold == number] = row_sizes(problem.errors(best))[held]
        expected[fold == number] = _expected(trained, best, problem.readings.chosen(held))
    return HeldOut(f"{FOLDS}-fold cross-validation", before, after, configuration, expected)


def _expected(problem: Problem, x: Float[np.ndarray, "free"], rows: Readings) -> Float[np.ndarray, "rows"]:
    """Returns the mean square [m²] that errors of rows should have that a fit did not see."""
    root = posterior_root(problem.seen(x), problem.prior_std)
    noise = np.sum(np.where(rows.read, rows.std**2 + problem.model_std**2, 0.0), axis=1)
    own = np.empty(len(rows))
    for block in model_of(problem.cell, rows, problem.names).blocks(x, np.where(rows.read, 1.0, 0.0), 0.0):
        spread = np.sum((root.T @ block.columns[:-1]) ** 2, axis=0)
        own[block.rows] = spread.reshape(-1, rows.values.shape[1]).sum(axis=1)
    return noise + own


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
