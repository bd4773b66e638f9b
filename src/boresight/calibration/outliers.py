"""Rows that do not fit with the others."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from boresight.calibration.result import Outlier
from boresight.calibration.robust import Fit


def find_outliers(fit: Fit) -> tuple[Outlier, ...]:
    """Returns the rows that the fit left out, the most glaring first; they stay in the files.

    Args:
        fit: the final fit.
    """
    errors = fit.problem.errors(fit.x)
    rows, read = np.flatnonzero(~fit.kept), fit.problem.readings.read
    return tuple(
        Outlier(int(fit.problem.readings.line[row]), _size(-errors[row][read[row]]), float(fit.ratio[row]))
        for row in rows[np.argsort(-fit.ratio[rows], kind="stable")]
    )


def _size(error: Float[np.ndarray, " channels"]) -> float:
    """Returns measured minus predicted [m], or the length of an error vector."""
    return float(error[0]) if len(error) == 1 else float(np.linalg.norm(error))
