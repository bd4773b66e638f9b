"""A base that was estimated away from where the campaign states it: what the arm's own files then lack."""

from __future__ import annotations

import numpy as np

from boresight.calibration.campaign import Campaign
from boresight.sensing import Cell
from boresight.units import in_millimetres


def moved_base_in_words(campaign: Campaign, identified: Cell) -> tuple[str, ...]:
    """Returns a sentence where the base was estimated and had a stated place; none where it was unknown or stays.

    Args:
        campaign: with its readings.
        identified: the cell after calibration.
    """
    stated = campaign.cell.base
    if campaign.readings is None or identified.base == stated:
        return ()
    if any(name.startswith("base.") for name in campaign.unknown):
        return ()
    poses = identified.arm.forward_kinematics(campaign.readings.joints)
    shift = (identified.base.matrix - stated.matrix) @ poses[:, :, 3:]
    farthest = float(np.linalg.norm(shift[:, :3, 0], axis=1).max())
    return (
        "`base` was estimated: robot-calibrated files and exports hold the arm from its base on. With the base where "
        f"the campaign states it, their tool would be off by up to {in_millimetres(farthest)}; result.json has the "
        "frame as estimated.",
    )
