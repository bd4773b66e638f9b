"""Whether poses and joint readings for an arm can be meant in the units they are read in."""

from __future__ import annotations

import math

import numpy as np
from jaxtyping import Float

from boresight.arm import Arm
from boresight.files.extents import extent_of
from boresight.files.plausible_units import fits_as_degrees
from boresight.files.problems import Problems
from boresight.units import Units

FAR, NEAR = 25.0, 5e-3
"""Half of the positions are no more than so many times the arm's reach away, and some at least this share of what its
links reach."""


def check_joints(
    joints: Float[np.ndarray, "rows joints"], arm: Arm, units: Units, name: str, problems: Problems
) -> None:
    """Adds a fault where turning joints [rad] are beyond their limits, and within them were they degrees."""
    turning = np.array([joint.type == "revolute" for joint in arm.driven])
    if units.angle != "rad" or not turning.any():
        return
    limits, values = arm.limits[turning], joints[:, turning]
    largest = float(np.max(np.abs(values)))
    if fits_as_degrees(values, limits) or largest > 4.0 * math.pi > math.radians(largest):
        worst = np.unravel_index(int(np.argmax(np.abs(values))), values.shape)
        joint = np.array(arm.joint_names)[turning][worst[1]]
        problems.add(
            f"{name}: joint {joint} reads {values[worst]:.4g}, too much for radians; if the file is in degrees, say "
            "--angle deg"
        )


def check_turns(turns: Float[np.ndarray, "rows 3"], units: Units, name: str, problems: Problems) -> None:
    """Adds a fault where rotation vectors [rad] are longer than a turn."""
    longest = float(np.max(np.linalg.norm(turns, axis=1)))
    if units.angle == "rad" and longest > 2.0 * math.pi + 0.02:
        problems.add(
            f"{name}: the rotation vector rx, ry, rz is up to {longest:.4g} rad long, more than a turn; if it is in "
            "degrees, say --angle deg"
        )


def check_positions(
    positions: Float[np.ndarray, "rows 3"], arm: Arm, units: Units, name: str, problems: Problems
) -> None:
    """Adds a fault where positions [m] are far beyond the arm's reach, or all next to its base."""
    away, reach = np.linalg.norm(positions, axis=1), arm.reach
    other = "mm" if units.length == "m" else "m"
    if np.median(away) > FAR * reach or np.max(away) < NEAR * extent_of(arm).links:
        problems.add(
            f"{name}: x, y, z: positions {np.median(away) / units.metres:.4g} {units.length} from the base of an arm "
            f"that reaches {reach / units.metres:.4g} {units.length} at most; if they are in {other}, say --length "
            f"{other}"
        )
