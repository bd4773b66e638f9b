"""What the model leaves unexplained of the tool's position: its size in the rows that were fitted, or in held-out ones.

The tool's uncertainty is that of the real tool. Where gears, links and bearings do what no parameter describes, rows
that were fitted show less of it than others, and a few far more than a normal distribution has: the model's own error
is widened until 95 % of the held-out configurations lie within what is expected of them (split conformal prediction:
Papadopoulos et al. 2002; Lei et al. 2018).
"""

from __future__ import annotations

import math

import numpy as np

from boresight.calibration.holdout import HeldOut
from boresight.calibration.robust import Fit
from boresight.inference.coverage import PROBABILITY
from boresight.sensing import Readings

FEWEST = 20
"""With fewer held-out configurations than this, the largest of them is all that their 95 % point rests on; their mean
square then decides."""

SURE = 1.5
"""Where rows that were fitted show no error of the model's own, held-out ones must show this ratio to their expected
size before they are believed: the 95 % point of 60 rows is known to a fifth."""

FAR = 3.0
"""So many standard deviations of its mean a mean square must be too large, where there are few configurations."""


def model_error(fit: Fit, held_out: HeldOut, validation: Readings | None) -> float:
    """Returns the standard deviation [m] of the model's own error along each axis; 0 where there is none.

    Args:
        fit: the final fit.
        held_out: errors of rows that were not fitted.
        validation: these rows; None where they are those that the fit used, by cross-validation.
    """
    from scipy import special

    model_std, rows = fit.problem.model_std, fit.problem.readings.chosen(fit.kept) if validation is None else validation
    seen = np.isfinite(held_out.after)
    own = np.arange(len(seen)) if held_out.configuration is None else held_out.configuration
    if held_out.expected is None or not seen.any():
        return model_std
    channels, count = rows.channels, len(np.unique(own[seen]))
    expected = held_out.expected / channels * special.chdtri(channels, 1.0 - PROBABILITY)
    shares = np.sort(held_out.after[seen] ** 2 / expected[seen])
    largest = float(shares[min(math.ceil(PROBABILITY * (len(shares) + 1)), len(shares)) - 1])
    least = SURE**2 if model_std == 0.0 else 1.0
    if count < FEWEST:
        largest = float(np.mean(held_out.after[seen] ** 2 / held_out.expected[seen]))
        least = 1.0 + FAR * math.sqrt(2.0 / count)
    if largest <= least:
        return model_std
    return math.sqrt(model_std**2 + (largest - 1.0) * float(np.median(held_out.expected[seen] / channels[seen])))
