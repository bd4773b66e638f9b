"""How far an arm gets: what its links reach, and how far its slides carry them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from boresight.arm import Arm

DRAWN = 200
"""Configurations in which the links' reach is looked for."""

LONGEST_TRAVEL_M = 1000.0
"""Limits of a slide beyond this [m] stand for none; then its readings say how far it goes."""


@dataclass(frozen=True, slots=True)
class Extent:
    """How far an arm gets.

    Attributes:
        links: how far [m] the tool gets from the base by turning joints alone, no slide being out.
        travel: how far [m] slides carry it beside that, all together.
    """

    links: float
    travel: float

    @property
    def whole(self) -> float:
        """The farthest [m] that the tool can be from the base."""
        return self.links + self.travel


def extent_of(arm: Arm, readings: Sequence[Float[np.ndarray, "rows joints"]] = ()) -> Extent:
    """Returns how far an arm gets, its links over drawn configurations, its slides by limits.

    Args:
        arm: the nominal arm [m, rad].
        readings: of its joints [m, rad], for slides whose limits are none.
    """
    joints = tuple(replace(joint, d=0.0) if joint.type == "prismatic" else joint for joint in arm.joints)
    turning = np.array([joint.type == "revolute" for joint in arm.driven])
    random = np.random.Generator(np.random.Philox(0))
    drawn = np.where(turning, random.uniform(-math.pi, math.pi, (DRAWN, len(turning))), 0.0)
    with np.errstate(all="ignore"):
        ends = replace(arm, joints=joints).chain.poses(drawn)[:, :3, 3]
        links = float(np.max(np.linalg.norm(ends, axis=1), initial=0.0))
    farthest = {joint.name: _farthest(arm, place, readings) for place, joint in enumerate(arm.driven)}
    slides = (joint for joint in arm.joints if joint.type == "prismatic")
    return Extent(links, sum(abs(joint.ratio) * farthest[joint.follows or joint.name] for joint in slides))


def _farthest(arm: Arm, place: int, readings: Sequence[Float[np.ndarray, "rows joints"]]) -> float:
    """Returns the largest reading [rad or m] that a joint is meant to have."""
    limit = max(map(abs, arm.driven[place].limits))
    if limit <= LONGEST_TRAVEL_M:
        return limit
    read = max((float(np.max(np.abs(each[:, place]), initial=0.0)) for each in readings), default=0.0)
    return min(read, LONGEST_TRAVEL_M)
