"""What may be wrong beside what is estimated, and how far: default priors, and standard deviations that files state.

A parameter that is not estimated is not thereby known. Unless the campaign fixes it, every independent link parameter
has a prior; base, mount, planes, points and the sensor's own numbers have one where the campaign states it.
"""

from __future__ import annotations

import math

from boresight.arm import Arm
from boresight.calibration.campaign import Campaign, Freedom
from boresight.calibration.freedom import link_candidates, usual_within
from boresight.sensing import Cell


def unestimated(campaign: Campaign, cell: Cell, freedoms: tuple[Freedom, ...]) -> dict[str, float]:
    """Returns the prior standard deviation [m, rad or 1] of each parameter that may be wrong and is not estimated.

    Args:
        campaign: what was asked for, and what is stated of the rest.
        cell: its cell, with unknown frames where they were found.
        freedoms: the estimated parameters.
    """
    usual, held = default_priors(cell.arm), campaign.fixed | {freedom.parameter for freedom in freedoms}
    links = {name: usual[name] for name in link_candidates(cell.arm) if name not in held}
    estimated = {freedom.parameter for freedom in freedoms}
    stated = {name: std for name, std in campaign.priors.items() if name in cell.index and name not in estimated}
    every = links | stated
    return {name: every[name] for name in cell.index if name in every}


def default_priors(arm: Arm) -> dict[str, float]:
    """Returns the default prior standard deviation of every link parameter that can be independent [m or rad]."""
    within = usual_within(arm)
    return {
        name: within["length" if name.rpartition(".")[2] in ("a", "d") else "angle"] / math.sqrt(3.0)
        for name in link_candidates(arm)
    }


def assumed(campaign: Campaign, cell: Cell) -> tuple[str, ...]:
    """Returns the link parameters that are taken as known because the campaign fixes them."""
    return tuple(name for name in link_candidates(cell.arm) if name in campaign.fixed)
