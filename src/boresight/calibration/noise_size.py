"""How large the readings' noise is: as stated, unless the residuals say that it is larger."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from boresight.calibration.robust import Fit, check_noise, refine

STATED_COUNTS = 1.0
"""Degrees of freedom that the stated noise counts for. With 5 of the residuals' own beside it (30 rows, 25 parameters),
intervals hold the truth in 94 to 95 % of campaigns where the noise is stated at a third or half of its size, and in
99 % where it is stated rightly: so few residuals cannot tell which."""

ORDINARY = 6.0
"""Rows that were left out may be ordinary ones of a larger noise, where all rows together leave no more than so many
times the stated noise."""


@dataclass(frozen=True, slots=True)
class NoiseSize:
    """The size of the readings' noise.

    Attributes:
        scale: its standard deviation over the stated one, the model's own error included where there is one; at least
            1, as noise stated too large costs nothing but width.
        freedom: degrees of freedom with which it is known.
    """

    scale: float
    freedom: float


def noise_size(fit: Fit) -> NoiseSize:
    """Returns the size of the noise that a fit's intervals rest on.

    Where residuals are so large that the model's own error was found beside the noise (`inference.model_std`), that
    has explained them; else what chi-square exceeds its expectation by widens the intervals (Birge 1932), the stated
    size counting as `STATED_COUNTS` more residuals.
    """
    check = check_noise(fit)
    if fit.problem.model_std > 0.0:
        share = float(np.mean(1.0 / fit.problem.repeats[fit.kept]))  # rows of one configuration count once
        return NoiseSize(1.0, max(share * check.freedom, 1.0))
    freedom = STATED_COUNTS + check.freedom
    found = NoiseSize(math.sqrt(max(1.0, (STATED_COUNTS + check.chi_square) / freedom)), freedom)
    if fit.kept.all():
        return found
    of_all = _of_all_rows(fit)
    return of_all if found.scale < of_all.scale < ORDINARY else found


def _of_all_rows(fit: Fit) -> NoiseSize:
    """Returns the size of the noise that plain least squares of all rows leaves."""
    whole = fit.problem.weighed(np.ones(len(fit.kept)), 0.0)
    check = check_noise(replace(fit, problem=whole, search=refine(whole, fit.x)))
    return NoiseSize(check.ratio, max(check.freedom, 1.0))
