"""An arm: joints, their links, and where the tool is."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from boresight.arm.conventions import LINK_NUMBERS, Convention, JointType, link_motions
from boresight.arm.motions import Chain


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint and the link that follows it (standard D-H) or leads to it (modified D-H).

    Attributes:
        name: unique within the arm.
        type: revolute or prismatic.
        theta, alpha, beta: angles [rad]; a revolute joint's reading adds to theta.
        d, a: lengths [m]; a prismatic joint's reading adds to d.
        limits: lowest and highest reading [rad or m].
    """

    name: str
    type: JointType = "revolute"
    theta: float = 0.0
    d: float = 0.0
    a: float = 0.0
    alpha: float = 0.0
    beta: float = 0.0
    limits: tuple[float, float] = (-math.pi, math.pi)


@dataclass(frozen=True)
class Arm:
    """A serial arm in a D-H convention.

    Attributes:
        name: what it is called.
        joints: from the base outwards.
        convention: how the links' numbers are read.
    """

    name: str
    joints: tuple[Joint, ...]
    convention: Convention = "standard-dh"

    @cached_property
    def chain(self) -> Chain:
        """The arm's elementary motions from its base to its tool."""
        motions = tuple(
            motion
            for index, joint in enumerate(self.joints)
            for motion in link_motions(
                self.convention, joint.type, index, joint.name, {n: getattr(joint, n) for n in LINK_NUMBERS}
            )
        )
        return Chain(motions, len(self.joints))

    @property
    def joint_names(self) -> tuple[str, ...]:
        """The joints' names from the base outwards."""
        return tuple(joint.name for joint in self.joints)

    @property
    def limits(self) -> Float[np.ndarray, "joints 2"]:
        """Lowest and highest reading of every joint [rad or m]."""
        return np.array([joint.limits for joint in self.joints])

    @property
    def reach(self) -> float:
        """An upper bound [m] on the distance of the tool from the base."""
        sliding = sum(max(map(abs, joint.limits)) for joint in self.joints if joint.type == "prismatic")
        return sum(abs(joint.a) + abs(joint.d) for joint in self.joints) + sliding

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
                replace(
                    joint,
                    **{n: getattr(joint, n) + corrections.get(f"{joint.name}.{n}", 0.0) for n in LINK_NUMBERS},
                )
                for joint in self.joints
            ),
        )
