"""How the catalogue's tables are written: lengths in metres, angles in degrees, as their sources print them."""

from __future__ import annotations

import math
from collections.abc import Iterable

from boresight.arm.arm import Arm, Joint
from boresight.arm.conventions import Convention

Row = tuple[str, float, float, float, float, tuple[float, float]]
"""Name, theta [deg], d [m], a [m], alpha [deg], (lowest, highest) reading [deg]."""


def revolute_arm(name: str, rows: Iterable[Row], convention: Convention = "standard-dh") -> Arm:
    """Returns an arm of revolute joints from the rows of a printed D-H table."""
    return Arm(name, tuple(_revolute(*row) for row in rows), convention)


def _revolute(
    name: str, theta_deg: float, d: float, a: float, alpha_deg: float, limits_deg: tuple[float, float]
) -> Joint:
    lowest, highest = (math.radians(limit) for limit in limits_deg)
    return Joint(name, theta=math.radians(theta_deg), d=d, a=a, alpha=math.radians(alpha_deg), limits=(lowest, highest))
