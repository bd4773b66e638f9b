"""Rows that do not fit with the others."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from boresight.calibration.problem import Problem
from boresight.calibration.result import Outlier

FLAGGED = 5.0
"""Standard deviations beyond which a residual stands out: of 100,000 good rows, one in 17 batches."""


def find_outliers(problem: Problem, x: Float[np.ndarray, "parameters"]) -> tuple[Outlier, ...]:
    """Returns the rows whose studentised residual stands out, by size.

    Each error is divided by its standard deviation after the fit, sqrt(1 - leverage) of the one before (Cook &
    Weisberg 1982), and by a robust estimate of the residuals' spread where that is larger than stated.

    Args:
        problem: what was fitted.
        x: the corrections found.
    """
    errors = problem.errors(x)
    if not errors.size:
        return ()
    jacobian = problem.sensitivity(x)
    full = np.vstack([jacobian, np.diag(1.0 / problem.prior_std)])
    basis = np.linalg.qr(full)[0][: len(jacobian)] if full.shape[1] else np.zeros((len(jacobian), 1))
    leverage = np.minimum(np.sum(basis**2, axis=1), 1.0 - 1e-6).reshape(errors.shape)
    studentised = errors / problem.std / np.sqrt(1.0 - leverage)
    sizes = np.nan_to_num(np.sqrt(np.mean(studentised**2, axis=1)), nan=np.inf)
    spread = max(1.0, 1.4826 * float(np.median(np.abs(studentised[np.isfinite(studentised)]), axis=None)))
    ratio = sizes / spread
    rows = np.flatnonzero(ratio > FLAGGED)
    return tuple(
        Outlier(int(problem.readings.line[row]), _signed_size(-errors[row]), float(ratio[row]))
        for row in rows[np.argsort(-ratio[rows])]
    )


def _signed_size(error: Float[np.ndarray, "channels"]) -> float:
    return float(error[0]) if len(error) == 1 else float(np.linalg.norm(error))
