"""Fits that leave so much that something other than small errors is wrong: a target, a unit, a joint's sign."""

from __future__ import annotations

import numpy as np

from boresight.calibration.robust import Fit, check_noise

GROSS_RATIO, GROSS_SHARE = 10.0, 2e-3
"""Residuals are grossly above the noise where they are this many times as large, and more than this share of the arm's
reach: 2 mm a metre. Real arms whose gears and links give way leave a tenth of it (UR10: 0.16 mm a metre)."""

MOST_LEFT_OUT = 0.25
"""Share of rows left out from which on the others may be the wrong ones."""


def grossly_off(fit: Fit) -> bool:
    """Returns whether residuals stay grossly above the noise."""
    reach = fit.problem.cell.arm.reach
    return check_noise(fit).ratio > GROSS_RATIO and fit.problem.model_std > GROSS_SHARE * reach


def share_left_out(fit: Fit) -> float:
    """Returns the share of the rows that a fit left out."""
    return float(np.mean(~fit.kept))


def beyond_help(fit: Fit) -> bool:
    """Returns whether no term beside the geometry can be looked for: something else is wrong first."""
    return grossly_off(fit) or share_left_out(fit) > MOST_LEFT_OUT
