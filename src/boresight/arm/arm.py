"""An arm: joints, their links, and where the tool is."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from boresight.arm.bending import HARMONICS, SAG, harmonic_motions, sag_motions
from boresight.arm.conventions import LINK_NUMBERS, Convention, JointType, link_motions
from boresight.arm.levers import DOWN, TIP_M, Levers, Triple
from boresight.arm.motions import Chain, Motion, fixed_motions
from boresight.geometry import Frame

_SHORT_M = 1e-3
"""A link shorter than this has no lever of its own [m]."""


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint and the link that follows it (standard D-H) or leads to it (modified D-H).

    Attributes:
        name: unique within the arm.
        type: revolute or prismatic.
        theta, alpha, beta: angles [rad]; a revolute joint's reading adds to theta.
        d, a: lengths [m]; a prismatic joint's reading adds to d.
        limits: lowest and highest reading [rad or m].
        follows: the joint that this one mimics, or None for a joint with a reading of its own.
        ratio: what the followed joint's reading is multiplied by.
        harmonics: heights [rad] of the waves `HARMONICS` that a revolute joint turns further by; none if empty.
        sag: by number of a link, from 1, how far a revolute joint turns [rad] when that link's end stands one metre
            out horizontally, square to the axis; none if empty.
    """

    name: str
    type: JointType = "revolute"
    theta: float = 0.0
    d: float = 0.0
    a: float = 0.0
    alpha: float = 0.0
    beta: float = 0.0
    limits: tuple[float, float] = (-math.pi, math.pi)
    follows: str | None = None
    ratio: float = 1.0
    harmonics: tuple[float, ...] = ()
    sag: tuple[tuple[int, float], ...] = ()

    @property
    def numbers(self) -> dict[str, float]:
        """The five numbers of the link, by name [rad or m]."""
        return {number: float(getattr(self, number)) for number in LINK_NUMBERS}

    def with_numbers(self, numbers: Mapping[str, float]) -> Joint:
        """Returns the joint with other numbers, all five by name [rad or m]."""
        theta, d, a, alpha, beta = (numbers[number] for number in LINK_NUMBERS)
        return replace(self, theta=theta, d=d, a=a, alpha=alpha, beta=beta)

    def corrected(self, corrections: Mapping[str, float]) -> Joint:
        """Returns the joint with corrections [rad or m] added to its parameters, by full name (`j2.beta`)."""

        def added(value: float, parameter: str) -> float:
            return value + corrections.get(f"{self.name}.{parameter}", 0.0)

        return replace(
            self.with_numbers({number: added(value, number) for number, value in self.numbers.items()}),
            harmonics=tuple(added(h, wave) for wave, h in zip(HARMONICS, self.harmonics, strict=False)),
            sag=tuple((link, added(turn, f"{SAG}{link}")) for link, turn in self.sag),
        )


@dataclass(frozen=True)
class Arm:
    """A serial arm in a D-H convention.

    Attributes:
        name: what it is called.
        joints: from the base outwards.
        convention: how the links' numbers are read.
        root: from the arm's base to the frame in which the first joint's numbers are read.
        tip: from the frame after the last joint's numbers to the arm's tool.
        gravity: its direction in the arm's base, a unit vector; matters where some joint sags.
    """

    name: str
    joints: tuple[Joint, ...]
    convention: Convention = "standard-dh"
    root: Frame = Frame()
    tip: Frame = Frame()
    gravity: Triple = DOWN

    @cached_property
    def chain(self) -> Chain:
        """The arm's elementary motions from its base to its tool."""
        motions = tuple(motion for place in range(len(self.joints)) for motion in self._motions(place))
        levers = Levers(self._rigid, self.gravity) if any(joint.sag for joint in self.joints) else None
        return Chain(fixed_motions(self.root) + motions + fixed_motions(self.tip), len(self.driven), levers)

    @property
    def _rigid(self) -> Chain:
        """The chain of an arm that does not give way, to the tip of its last link."""
        motions = tuple(motion for place in range(len(self.joints)) for motion in self._link_motions(place))
        end = (*fixed_motions(self.tip), Motion(turns=False, axis=2, value=TIP_M))
        return Chain((*fixed_motions(self.root), *motions, *end), len(self.driven))

    @property
    def driven(self) -> tuple[Joint, ...]:
        """The joints that have a reading of their own, from the base outwards: all but those that mimic one."""
        return tuple(joint for joint in self.joints if joint.follows is None)

    @cached_property
    def _column(self) -> dict[str, int]:
        """The column of the readings that each joint with one of its own has."""
        return {joint.name: place for place, joint in enumerate(self.driven)}

    def bends(self, joints: Float[np.ndarray, "rows joints"]) -> Float[np.ndarray, "rows joints"]:
        """Returns how much further than its reading each joint turns [rad], of those that have one."""
        own = [place for place, joint in enumerate(self.joints) if joint.follows is None]
        return self.chain.bends(joints)[:, own]

    @property
    def rigid(self) -> Arm:
        """The arm whose joints turn by their readings alone."""
        return replace(self, joints=tuple(replace(joint, harmonics=(), sag=()) for joint in self.joints))

    @property
    def is_bent(self) -> bool:
        """Whether something turns a joint beside its reading."""
        return any(joint.harmonics or joint.sag for joint in self.joints)

    def _link_motions(self, place: int) -> tuple[Motion, ...]:
        joint = self.joints[place]
        column = self._column[joint.follows or joint.name]
        ratio = joint.ratio if joint.follows else 1.0
        return link_motions(self.convention, joint.type, column, joint.name, joint.numbers, ratio)

    def _motions(self, place: int) -> tuple[Motion, ...]:
        """Returns a joint's motions, what turns it further beside its own turn."""
        joint, links = self.joints[place], self._link_motions(place)
        if not joint.harmonics and not joint.sag:
            return links
        column = self._column[joint.name]
        further = harmonic_motions(column, joint.name, joint.harmonics) if joint.harmonics else ()
        further += sag_motions(column, joint.name, joint.sag)
        turn = next(i for i, motion in enumerate(links) if motion.joint is not None) + 1
        return links[:turn] + further + links[turn:]

    def with_harmonics(self) -> Arm:
        """Returns the arm whose revolute joints have harmonics, new ones of no height; mimicking ones have none."""
        none = (0.0,) * len(HARMONICS)
        return replace(
            self,
            joints=tuple(
                replace(joint, harmonics=joint.harmonics or none)
                if joint.type == "revolute" and joint.follows is None
                else joint
                for joint in self.joints
            ),
        )

    def weightless(self) -> Arm:
        """Returns the arm as it is where there is no gravity."""
        return replace(self, joints=tuple(replace(joint, sag=()) for joint in self.joints))

    def with_sag(self) -> Arm:
        """Returns the arm whose revolute joints all may sag under every link that has a length, new ones by nothing.

        An arm with joints that mimic others is returned as it is: what holds such a joint up is another link.
        """
        if len(self.driven) < len(self.joints):
            return self
        joints = tuple(
            replace(joint, sag=self._sag(place)) if joint.type == "revolute" else joint
            for place, joint in enumerate(self.joints)
        )
        return replace(self, joints=joints)

    def _sag(self, place: int) -> tuple[tuple[int, float], ...]:
        """Returns how a joint sags under every link from its own on that has a length, and those it has already."""
        known = dict(self.joints[place].sag)
        beyond = range(place + 1, len(self.joints) + 1)
        return tuple((link, known.get(link, 0.0)) for link in beyond if link in known or self._has_length(link))

    def _has_length(self, link: int) -> bool:
        """Returns whether a link, by number from 1, leads from its joint to another place; the last one has its tip."""
        if link == len(self.joints):
            return True
        joint = self.joints[link - 1 if self.convention == "standard-dh" else link]
        return joint.type == "prismatic" or math.hypot(joint.a, joint.d) > _SHORT_M

    @property
    def joint_names(self) -> tuple[str, ...]:
        """The names of the joints that are read, from the base outwards."""
        return tuple(joint.name for joint in self.driven)

    @property
    def limits(self) -> Float[np.ndarray, "joints 2"]:
        """Lowest and highest reading of every joint that is read [rad or m]."""
        return np.array([joint.limits for joint in self.driven])

    @property
    def reach(self) -> float:
        """An upper bound [m] on the distance of the tool from the base."""
        # A joint without limits that a sliding one follows: a turn either way will do.
        most = {j.name: 2.0 * math.pi if math.isinf(j.limits[0]) else max(map(abs, j.limits)) for j in self.driven}
        sliding = sum(
            abs(joint.ratio) * most[joint.follows or joint.name] for joint in self.joints if joint.type == "prismatic"
        )
        ends = math.hypot(*self.root.xyz) + math.hypot(*self.tip.xyz)
        return ends + sum(abs(joint.a) + abs(joint.d) for joint in self.joints) + sliding

    def forward_kinematics(self, joints: Float[np.ndarray, "rows joints"]) -> Float[np.ndarray, "rows 4 4"]:
        """Returns `T_base_tool` for a batch of joint readings [rad or m] (paper, eq. 4 and 5)."""
        return self.chain.poses(joints)

    def corrected(self, corrections: Mapping[str, float]) -> Arm:
        """Returns the arm with corrections [rad or m] added to the named parameters (paper, eq. 10).

        Args:
            corrections: by parameter name (`j2.beta`); names of other things than this arm's are ignored.
        """
        return replace(self, joints=tuple(joint.corrected(corrections) for joint in self.joints))
