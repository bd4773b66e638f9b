"""An arm: joints, their links, and where the tool is."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from boresight.arm.conventions import LINK_NUMBERS, Convention, JointType, link_motions
from boresight.arm.motions import Chain, fixed_motions
from boresight.geometry import Frame


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

    @property
    def numbers(self) -> dict[str, float]:
        """The five numbers of the link, by name [rad or m]."""
        return {number: float(getattr(self, number)) for number in LINK_NUMBERS}

    def with_numbers(self, numbers: Mapping[str, float]) -> Joint:
        """Returns the joint with other numbers, all five by name [rad or m]."""
        theta, d, a, alpha, beta = (numbers[number] for number in LINK_NUMBERS)
        return replace(self, theta=theta, d=d, a=a, alpha=alpha, beta=beta)


@dataclass(frozen=True)
class Arm:
    """A serial arm in a D-H convention.

    Attributes:
        name: what it is called.
        joints: from the base outwards.
        convention: how the links' numbers are read.
        root: from the arm's base to the frame in which the first joint's numbers are read.
        tip: from the frame after the last joint's numbers to the arm's tool.
    """

    name: str
    joints: tuple[Joint, ...]
    convention: Convention = "standard-dh"
    root: Frame = Frame()
    tip: Frame = Frame()

    @cached_property
    def chain(self) -> Chain:
        """The arm's elementary motions from its base to its tool."""
        column = {joint.name: place for place, joint in enumerate(self.driven)}
        links = tuple(
            motion
            for joint in self.joints
            for motion in link_motions(
                self.convention,
                joint.type,
                column[joint.follows or joint.name],
                joint.name,
                joint.numbers,
                joint.ratio if joint.follows else 1.0,
            )
        )
        return Chain(fixed_motions(self.root) + links + fixed_motions(self.tip), len(self.driven))

    @property
    def driven(self) -> tuple[Joint, ...]:
        """The joints that have a reading of their own, from the base outwards: all but those that mimic one."""
        return tuple(joint for joint in self.joints if joint.follows is None)

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
        return replace(
            self,
            joints=tuple(
                joint.with_numbers(
                    {n: value + corrections.get(f"{joint.name}.{n}", 0.0) for n, value in joint.numbers.items()}
                )
                for joint in self.joints
            ),
        )
