"""Observability indices: how well a set of configurations shows the parameters, as one number each.

All take the singular values σ_1 ≥ … ≥ σ_L of the Jacobian whose columns are scaled by a typical size of their
parameter and whose rows are divided by the reading's standard deviation, so that all are free of units and a
larger index is better. Sun & Hollerbach (2008) compare them. Only the directions that are seen count, or all
five would be 0 wherever one direction is not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, slots=True)
class Observability:
    """The five indices in use.

    Attributes:
        o1: (σ_1 σ_2 … σ_L)^(1/L) / √m. Borm & Menq 1989, "Experimental study of observability of parameter errors
            in robot calibration"; 1991, "Determination of optimal measurement configurations for robot
            calibration based on observability measure". The volume of the ellipsoid; D-optimality.
        o2: σ_L / σ_1. Driels & Pathre 1990, "Significance of observation strategy on the design of robot
            calibration experiments". The inverse condition number.
        o3: σ_L. Nahvi, Hollerbach & Hayward 1994, "Calibration of a parallel robot using multiple kinematic
            closed loops". What the least visible direction shows; E-optimality.
        o4: σ_L² / σ_1. Nahvi & Hollerbach 1996, "The noise amplification index for optimal pose selection in
            robot calibration". O2 and O3 at once.
        o5: 1 / (1/σ_1 + … + 1/σ_L). Sun & Hollerbach 2008, "Observability index selection for robot
            calibration". The harmonic mean over L; A-optimality's relative.
    """

    o1: float
    o2: float
    o3: float
    o4: float
    o5: float


def observability(singular_values: Float[np.ndarray, "seen"], configurations: int) -> Observability:
    """Returns the five indices of a set of configurations.

    Args:
        singular_values: of the scaled Jacobian, those that are not zero, in any order.
        configurations: m, how many were measured.
    """
    if not len(singular_values):
        return Observability(0.0, 0.0, 0.0, 0.0, 0.0)
    largest, smallest = float(np.max(singular_values)), float(np.min(singular_values))
    return Observability(
        o1=float(np.exp(np.mean(np.log(singular_values))) / np.sqrt(configurations)),
        o2=smallest / largest,
        o3=smallest,
        o4=smallest**2 / largest,
        o5=float(1.0 / np.sum(1.0 / singular_values)),
    )


def everett_count(revolute: int, prismatic: int) -> int:
    """Returns C = 4 R + 2 P + 6, the independent parameters of an arm whose whole pose is measured.

    Everett, Driels & Mooring 1987, "Kinematic modelling for robot calibration" (paper, eq. 13). The 6 place the
    base in the world, or the sensor on the last link.
    """
    return 4 * revolute + 2 * prismatic + 6
