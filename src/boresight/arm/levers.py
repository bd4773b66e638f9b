"""How far out gravity takes hold: the levers that turn an arm's joints, and what moves them.

A joint gives way in proportion to the moment about its axis. That moment is a sum over the links beyond it, each
link's weight at some point along it. Neither the weights nor the stiffness need be known, only their product: the
*sag* of a joint under a link [rad], which is how far the joint turns when that link's end stands one metre out,
horizontally and square to the axis. Points along a link lie on the line between two ends, so ends alone span them.

Levers are those of the rigid arm: that a bent arm's levers are a little shorter is of second order (a joint that
gives way by 1 mrad changes them by a thousandth).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from boresight.arm.motions import Chain, Walk

Triple = tuple[float, float, float]

DOWN: Triple = (0.0, 0.0, -1.0)
"""Gravity's direction in the base of an arm that stands level."""

TIP_M = 0.1
"""How far beyond the last frame, along its z, the last link's end is taken to be [m]: about where a tool's weight is.
Some conventions have all of the last link's length in the tool, and with it any lever of it."""


@dataclass(frozen=True)
class Levers:
    """The moments about a rigid arm's joints of a unit weight at each link's end.

    Attributes:
        chain: the rigid arm, from its base to the tip of its last link.
        gravity: its direction in the arm's base, a unit vector.
    """

    chain: Chain
    gravity: Triple = DOWN

    def corrected(self, corrections: Mapping[str, float]) -> Levers:
        """Returns the levers of the corrected arm."""
        return replace(self, chain=self.chain.corrected(corrections))

    def moments(
        self, joints: Float[np.ndarray, "rows joints"], corrections: Float[np.ndarray, "rigid"] | None = None
    ) -> Float[np.ndarray, "rows joints links"]:
        """Returns z_i · ((p_j - o_i) × g) [m] for joint i and the end p_j of link j, 0 where j comes before i.

        Args:
            joints: a row a configuration [rad or m].
            corrections: added to the rigid chain's amounts, in the order of its `parameters`.
        """
        walk = self.chain.walk(joints, corrections)
        across = self._across(walk)
        moments = (
            np.einsum("rid,rjd->rij", across, walk.ends) - np.einsum("rid,rid->ri", across, walk.origins)[..., None]
        )
        return np.where(self._beyond, moments, 0.0)

    def slopes(
        self,
        joints: Float[np.ndarray, "rows joints"],
        corrections: Float[np.ndarray, "rigid"] | None,
        sag: Float[np.ndarray, "joints links"],
    ) -> Float[np.ndarray, "rows joints rigid"]:
        """Returns the derivative of every joint's turn, the sum of moments times `sag`, by the rigid parameters.

        A parameter before the joint turns axis and levers alike; one beyond it moves the ends that come after it.
        """
        walk = self.chain.walk(joints, corrections)
        shift, turn = walk.twists[..., :3], walk.twists[..., 3:]
        gravity, across = np.array(self.gravity), self._across(walk)
        moves_end = self._moved_by(self._end_places)
        slopes = np.zeros((len(joints), *sag.shape[:1], shift.shape[1]))
        for joint in np.flatnonzero(np.any(sag != 0.0, axis=1)):
            weight = np.where(self._beyond[joint], sag[joint], 0.0)
            lever = np.einsum("j,rjd->rd", weight, walk.ends) - weight.sum() * walk.origins[:, joint]
            torque = np.cross(walk.axes[:, joint], lever)
            before = np.einsum("rmd,rd->rm", turn, np.cross(torque, gravity))
            moved = moves_end * weight
            turned = np.matmul(moved, np.cross(walk.ends, across[:, joint, None]))
            after = np.einsum("rmd,rmd->rm", turn, turned) + np.einsum(
                "rmd,rd,m->rm", shift, across[:, joint], moved.sum(axis=1)
            )
            slopes[:, joint] = np.where(self._moved_by(self._joint_places)[:, joint], before, after)
        return slopes

    def _across(self, walk: Walk) -> Float[np.ndarray, "rows joints 3"]:
        """Returns g × z_i: the direction in which a lever counts about each joint."""
        return np.cross(np.array(self.gravity), walk.axes)

    @cached_property
    def _beyond(self) -> Bool[np.ndarray, "joints joints"]:
        count = self.chain.joints
        return np.triu(np.ones((count, count), dtype=bool))

    def _moved_by(self, places: Int[np.ndarray, "things"]) -> Bool[np.ndarray, "rigid things"]:
        """Returns whether each parameter's motion comes before each of some places in the chain."""
        own = np.array([place for place, motion in enumerate(self.chain.motions) if motion.parameter is not None])
        return own[:, None] < places[None, :]

    @cached_property
    def _joint_places(self) -> Int[np.ndarray, "joints"]:
        return np.array([place for place, motion in enumerate(self.chain.motions) if motion.joint is not None])

    @cached_property
    def _end_places(self) -> Int[np.ndarray, "joints"]:
        return np.append(self._joint_places[1:], len(self.chain.motions))
