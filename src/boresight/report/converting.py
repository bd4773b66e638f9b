"""An identified arm in another convention, checked to move as the arm itself does."""

from __future__ import annotations

import math

import numpy as np

from boresight.arm import Arm
from boresight.arm.common_normals import modified_dh, standard_dh
from boresight.arm.conventions import NEARLY_PARALLEL, Convention
from boresight.arm.screws import screws_of
from boresight.errors import InputError
from boresight.files.universal_robots import EXACT
from boresight.geometry import rotation_angle

CONFIGURATIONS = 200


def in_convention(arm: Arm, convention: Convention, like: Arm | None = None) -> Arm:
    """Returns the arm itself, or one in another convention that moves as it does.

    Args:
        arm: which.
        convention: standard or modified D-H.
        like: an arm in standard D-H whose choice among the directions of a common normal is taken; none by default.

    Raises:
        InputError: the other convention's numbers do not give the same poses.
    """
    if arm.convention == convention:
        return arm
    screws = screws_of(arm)
    found = standard_dh(screws, NEARLY_PARALLEL, like) if convention == "standard-dh" else modified_dh(screws)
    shift, turn = largest_difference(found, arm)
    if not (shift < EXACT * max(1.0, arm.reach) and turn < EXACT):
        raise InputError(
            f"{arm.name}: in {convention} its tool would be off by up to {shift:.2g} m and {turn:.2g} rad; export to "
            f"dh without --convention, which keeps {arm.convention}"
        )
    return found


def largest_difference(one: Arm, other: Arm) -> tuple[float, float]:
    """Returns the largest distance [m] and angle [rad] between two arms' tools within the limits."""
    joints = configurations(one)
    ours, theirs = one.forward_kinematics(joints), other.forward_kinematics(joints)
    shift = np.linalg.norm(ours[:, :3, 3] - theirs[:, :3, 3], axis=1)
    return float(shift.max()), float(rotation_angle(ours[:, :3, :3], theirs[:, :3, :3]).max())


def configurations(arm: Arm) -> np.ndarray:
    """Returns configurations [rad or m] (rows, joints) drawn evenly within an arm's limits, a turn without."""
    lowest, highest = np.where(np.isinf(arm.limits), [-math.pi, math.pi], arm.limits).T
    return np.random.Generator(np.random.Philox(0)).uniform(lowest, highest, (CONFIGURATIONS, len(lowest)))
