"""Chains of joints as URDF describes them: each joint's frame in the one before, and its axis in that frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from boresight.arm.arm import Arm
from boresight.arm.common_normals import axis_frame, link_transform, standard_dh
from boresight.arm.conventions import NEARLY_PARALLEL
from boresight.arm.screws import Screw, Screws
from boresight.geometry import Frame, inverse, rpy_near

LinkType = Literal["revolute", "prismatic", "fixed"]

ROUNDING = 1e-15
"""Numbers [m or rad] of an origin that differ by less are the same."""

UNLIMITED = (-math.inf, math.inf)
"""The limits of a joint that has none."""


@dataclass(frozen=True, slots=True)
class SerialJoint:
    """A joint between two links.

    Attributes:
        name: unique within the chain.
        type: revolute, prismatic or fixed.
        origin: `T_parent_joint`: the joint's frame, and the child link's at zero, in the parent link's.
        axis: unit vector in the joint's frame.
        limits: lowest and highest reading [rad or m].
        follows: the joint on the chain that this one mimics, or None.
        ratio: what the followed joint's reading is multiplied by.
        offset: added to that [rad or m].
    """

    name: str
    type: LinkType
    origin: Frame = Frame()
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    limits: tuple[float, float] = UNLIMITED
    follows: str | None = None
    ratio: float = 1.0
    offset: float = 0.0

    def placed(self, origin: Frame) -> SerialJoint:
        """Returns the joint with another origin."""
        return replace(self, origin=origin)


@dataclass(frozen=True)
class SerialChain:
    """Joints from a base link to a tip link.

    Attributes:
        name: of the robot.
        base, tip: names of the links at the ends.
        joints: from the base outwards, fixed ones too.
    """

    name: str
    base: str
    tip: str
    joints: tuple[SerialJoint, ...]

    @property
    def moving(self) -> tuple[SerialJoint, ...]:
        """The joints that move."""
        return tuple(joint for joint in self.joints if joint.type != "fixed")

    @property
    def ends_with_a_fixed_joint(self) -> bool:
        """Whether the tip's place on the last moving link is a number that can be corrected."""
        return self.joints[-1].type == "fixed"

    @property
    def arm(self) -> Arm:
        """The arm in standard D-H, with beta where axes are nearly parallel, from base link to tip link."""
        return standard_dh(self.screws, NEARLY_PARALLEL)

    @property
    def screws(self) -> Screws:
        """The arm as a product of exponentials, from base link to tip link."""
        places = _places(self)
        moving = [(joint, T) for joint, T in zip(self.joints, places, strict=True) if joint.type != "fixed"]
        return Screws(self.name, tuple(_screw(joint, T) for joint, T in moving), _beyond(self.joints[-1], places[-1]))


def chain_of(arm: Arm, base: str = "base_link", tip: str = "tool0") -> SerialChain:
    """Returns an arm as a chain whose joints all turn about or slide along z, the tool behind a fixed joint.

    Joint k's origin holds a, alpha, beta of the link before and its own theta and d, as in modified D-H.

    Args:
        arm: in standard D-H.
        base: the base link's name.
        tip: the tip link's name.
    """
    assert arm.convention == "standard-dh"
    joints, before = [], arm.root.matrix
    for joint in arm.joints:
        origin = Frame.of(before @ link_transform(joint.theta, joint.d, 0.0, 0.0, 0.0))
        joints.append(
            SerialJoint(joint.name, joint.type, origin, limits=joint.limits, follows=joint.follows, ratio=joint.ratio)
        )
        before = link_transform(0.0, 0.0, joint.a, joint.alpha, joint.beta)
    end = f"{tip}_joint"
    while any(joint.name == end for joint in joints):
        end += "_"
    return SerialChain(arm.name, base, tip, (*joints, SerialJoint(end, "fixed", Frame.of(before @ arm.tip.matrix))))


def corrected_chain(chain: SerialChain, nominal: Arm, identified: Arm) -> SerialChain:
    """Returns the chain with new origins, so that it moves as the identified arm does.

    How far along and about its axis a joint's frame stands moves nothing by itself; it is kept, but for the joint's
    own theta and d. So a joint's origin changes only with its own theta and d, and a, alpha and beta of the link
    before; those of the last link move the last fixed joint. All other origins stay the same objects. Where
    the arms differ before the first axis or behind the last link, as conversions between conventions may leave them,
    the first joint and the last fixed one take it up.

    Args:
        chain: as it was read.
        nominal: its arm, `chain.arm`.
        identified: the same with other numbers.
    """
    old = _places(chain)
    moving = [place for place, joint in enumerate(chain.joints) if joint.type != "fixed"]
    frames, changed = _new_frames(chain, [old[place] for place in moving], nominal, identified)
    new, at, T = list(chain.joints), dict(zip(moving, range(len(moving)), strict=True)), np.eye(4)
    if changed[-1]:
        assert chain.ends_with_a_fixed_joint, "no joint behind the last moving one can hold the tip's correction"
        at[len(chain.joints) - 1] = len(moving)
    for place, joint in enumerate(chain.joints):
        if place in at and changed[at[place]]:
            new[place] = joint.placed(_near(inverse(T) @ frames[at[place]], joint.origin))
        T = _beyond(joint, T @ new[place].origin.matrix)
    return replace(chain, joints=tuple(new))


def _near(T: Float[np.ndarray, "4 4"], old: Frame) -> Frame:
    """Returns a transform as the frame nearest to an old one, of whose numbers those stay that only rounding moves."""
    parts = (T[:3, 3], old.xyz), (rpy_near(T[:3, :3], old.rpy), old.rpy)
    (x, y, z), rpy = (
        [float(a) if abs(a - b) > ROUNDING else b for a, b in zip(now, was, strict=True)] for now, was in parts
    )
    return Frame((x, y, z), (rpy[0], rpy[1], rpy[2]))


def _new_frames(
    chain: SerialChain, old: Sequence[Float[np.ndarray, "4 4"]], nominal: Arm, identified: Arm
) -> tuple[list[Float[np.ndarray, "4 4"]], list[bool]]:
    """Returns where every moving joint's frame, and at last the tip, stand at zero readings, and which are new."""
    frames, changed = [], []
    before, after, link_changed = nominal.root.matrix, identified.root.matrix, nominal.root != identified.root
    for joint, T, was, now in zip(chain.moving, old, nominal.joints, identified.joints, strict=True):
        slip = link_transform(now.theta - was.theta, now.d - was.d, 0.0, 0.0, 0.0)
        turn = np.eye(4)
        turn[:3, :3] = axis_frame(joint.axis)
        stand = inverse(before) @ T @ turn  # along and about the axis only
        frames.append(after @ slip @ stand @ inverse(turn))
        changed.append(link_changed or (was.theta, was.d) != (now.theta, now.d))
        link_changed = (was.a, was.alpha, was.beta) != (now.a, now.alpha, now.beta)
        before = before @ link_transform(was.theta, was.d, was.a, was.alpha, was.beta)
        after = after @ link_transform(now.theta, now.d, now.a, now.alpha, now.beta)
    return [*frames, after @ identified.tip.matrix], [*changed, link_changed or nominal.tip != identified.tip]


def _places(chain: SerialChain) -> list[Float[np.ndarray, "4 4"]]:
    """Returns every joint's frame in the base link, all readings zero, the joint itself not yet moved by its offset."""
    places, T = [], np.eye(4)
    for joint in chain.joints:
        places.append(T @ joint.origin.matrix)
        T = _beyond(joint, places[-1])
    return places


def _beyond(joint: SerialJoint, T: Float[np.ndarray, "4 4"]) -> Float[np.ndarray, "4 4"]:
    """Returns the child link's frame at zero readings: a joint that mimics another may stand off by its offset."""
    if not joint.offset:
        return T
    turn, moved = np.eye(4), np.eye(4)
    turn[:3, :3] = axis_frame(joint.axis)
    revolute = joint.type == "revolute"
    moved = link_transform(joint.offset if revolute else 0.0, 0.0 if revolute else joint.offset, 0.0, 0.0, 0.0)
    return T @ turn @ moved @ inverse(turn)


def _screw(joint: SerialJoint, T: Float[np.ndarray, "4 4"]) -> Screw:
    x, y, z = (float(value) for value in T[:3, :3] @ joint.axis)
    px, py, pz = (float(value) for value in T[:3, 3])
    assert joint.type != "fixed"
    return Screw(joint.name, joint.type, (x, y, z), (px, py, pz), joint.limits, joint.follows, joint.ratio)
