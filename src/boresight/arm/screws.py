"""Arms as products of exponentials: where each joint's axis lies at zero readings, and where the tool is.

`T(q) = exp(S_1 q_1) … exp(S_n q_n) T(0)` (Brockett 1984). It needs no convention of links, so every description
of an arm leads here and from here to every other.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from boresight.arm.arm import Arm
from boresight.arm.conventions import JointType


@dataclass(frozen=True, slots=True)
class Screw:
    """A joint as the twist that it makes.

    Attributes:
        name: unique within the arm.
        type: revolute or prismatic.
        axis: unit vector along the axis, in the arm's base at zero readings.
        point: a point of a revolute joint's axis [m], in the base at zero readings; of no meaning for a prismatic one.
        limits: lowest and highest reading [rad or m].
        follows: the joint that this one mimics, or None.
        ratio: what the reading is multiplied by.
    """

    name: str
    type: JointType
    axis: tuple[float, float, float]
    point: tuple[float, float, float]
    limits: tuple[float, float]
    follows: str | None = None
    ratio: float = 1.0

    @property
    def twist(self) -> Float[np.ndarray, "6"]:
        """(v, w): a point x fixed to what the joint carries moves by v + w × x a unit of the joint [m and rad]."""
        if self.type == "prismatic":
            return np.array([*self.axis, 0.0, 0.0, 0.0])
        return np.concatenate([np.cross(self.point, self.axis), self.axis])


@dataclass(frozen=True)
class Screws:
    """An arm as a product of exponentials.

    Attributes:
        name: what it is called.
        joints: from the base outwards.
        home: `T_base_tool` at zero readings.
    """

    name: str
    joints: tuple[Screw, ...]
    home: Float[np.ndarray, "4 4"]

    def forward_kinematics(self, joints: Float[np.ndarray, "rows joints"]) -> Float[np.ndarray, "rows 4 4"]:
        """Returns `T_base_tool` for a batch of readings [rad or m], a column a joint that mimics no other."""
        column = {joint.name: place for place, joint in enumerate(j for j in self.joints if j.follows is None)}
        T = np.tile(np.eye(4), (len(joints), 1, 1))
        for joint in self.joints:
            reading = joints[:, column[joint.follows or joint.name]]
            T = T @ _exponential(joint, joint.ratio * reading if joint.follows else reading)
        return T @ self.home

    def seen_from(self, T: Float[np.ndarray, "4 4"]) -> Screws:
        """Returns the same arm in another base: `T_other_base`."""
        joints = tuple(
            replace(
                joint,
                axis=_triple(T[:3, :3] @ joint.axis),
                point=_triple(T[:3, :3] @ joint.point + T[:3, 3]),
            )
            for joint in self.joints
        )
        return Screws(self.name, joints, T @ self.home)


def screws_of(arm: Arm) -> Screws:
    """Returns an arm's joints as screws, and its tool at zero readings."""
    zero = np.zeros((1, len(arm.driven)))
    before = arm.chain.up_to_joints(zero)[0]
    return Screws(
        arm.name,
        tuple(
            Screw(
                joint.name, joint.type, _triple(T[:3, 2]), _triple(T[:3, 3]), joint.limits, joint.follows, joint.ratio
            )
            for joint, T in zip(arm.joints, before, strict=True)
        ),
        arm.forward_kinematics(zero)[0],
    )


def _exponential(joint: Screw, amount: Float[np.ndarray, "rows"]) -> Float[np.ndarray, "rows 4 4"]:
    """Returns the motion of everything beyond a joint, in the base (Rodrigues' formula)."""
    T = np.tile(np.eye(4), (len(amount), 1, 1))
    axis, point = np.array(joint.axis), np.array(joint.point)
    if joint.type == "prismatic":
        T[:, :3, 3] = amount[:, None] * axis
        return T
    cross = np.cross(np.eye(3), axis)
    T[:, :3, :3] += np.sin(amount)[:, None, None] * cross + (1.0 - np.cos(amount))[:, None, None] * (cross @ cross)
    T[:, :3, 3] = point - T[:, :3, :3] @ point
    return T


def _triple(vector: Float[np.ndarray, "3"]) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in vector)
    return x, y, z
