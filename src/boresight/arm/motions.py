"""Elementary motions, and chains of them: every arm, whatever its convention, is one.

A chain leads from a base to a tool by turns about and shifts along coordinate axes. A joint is such a motion
whose amount is read from an encoder; a geometric parameter is one whose amount may be wrong. A parameter
therefore moves the tool by a known twist, the motion's own axis as it stands in the base, and that is the
exact derivative of the tool's pose, for every convention at once.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from boresight.geometry import Frame
from boresight.units import Quantity


@dataclass(frozen=True, slots=True)
class Motion:
    """One turn about, or shift along, a coordinate axis of the frame reached so far.

    Attributes:
        turns: a turn [rad] if true, else a shift [m].
        axis: 0, 1, 2 for x, y, z.
        value: nominal amount [rad or m], added to a joint's reading where there is one.
        parameter: the name under which the amount can be corrected, or None.
        joint: the column of the joint readings that adds to the amount, or None.
        ratio: what the reading is multiplied by; 1 unless the joint mimics another.
    """

    turns: bool
    axis: int
    value: float = 0.0
    parameter: str | None = None
    joint: int | None = None
    ratio: float = 1.0

    @property
    def quantity(self) -> Quantity:
        """Whether the amount is an angle or a length."""
        return "angle" if self.turns else "length"


@dataclass(frozen=True, slots=True)
class Linearisation:
    """Tool poses and how every parameter moves them.

    Attributes:
        poses: (rows, 4, 4) `T_base_tool`.
        twists: (rows, parameters, 6) the tool's twist (v, w) a unit of each parameter, in the base frame and
            about the base's origin: a point x fixed to the tool moves by v + w × x.
    """

    poses: Float[np.ndarray, "rows 4 4"]
    twists: Float[np.ndarray, "rows parameters 6"]


@dataclass(frozen=True)
class Chain:
    """Elementary motions from a base to a tool, in order.

    Attributes:
        motions: from the base outwards.
        joints: number of joint readings a configuration has.
    """

    motions: tuple[Motion, ...]
    joints: int

    @cached_property
    def parameters(self) -> tuple[str, ...]:
        """The names of the amounts that can be corrected, from the base outwards."""
        return tuple(motion.parameter for motion in self.motions if motion.parameter is not None)

    def __add__(self, other: Chain) -> Chain:
        """Returns the chain that goes on with another whose joints, if any, share the readings."""
        return Chain(self.motions + other.motions, max(self.joints, other.joints))

    def corrected(self, corrections: Mapping[str, float]) -> Chain:
        """Returns the chain with corrections [rad or m] added to the named amounts."""
        return Chain(
            tuple(
                replace(motion, value=motion.value + corrections.get(motion.parameter or "", 0.0))
                for motion in self.motions
            ),
            self.joints,
        )

    def poses(
        self, joints: Float[np.ndarray, "rows joints"], corrections: Float[np.ndarray, "parameters"] | None = None
    ) -> Float[np.ndarray, "rows 4 4"]:
        """Returns `T_base_tool` for a batch of joint readings [rad or m] (paper, eq. 4).

        Args:
            joints: a row a configuration.
            corrections: added to the nominal amounts, in the order of `parameters`; none by default.
        """
        rotation, origin = _start(len(joints))
        for motion, amount in self._amounts(joints, corrections):
            _advance(motion, amount, rotation, origin)
        return _homogeneous(rotation, origin)

    def up_to_joints(self, joints: Float[np.ndarray, "rows joints"]) -> Float[np.ndarray, "rows moving 4 4"]:
        """Returns the frame in which each joint moves, joint by joint from the base outwards."""
        rotation, origin = _start(len(joints))
        frames = []
        for motion, amount in self._amounts(joints, None):
            if motion.joint is not None:
                frames.append(_homogeneous(rotation, origin))
            _advance(motion, amount, rotation, origin)
        return np.stack(frames, axis=1)

    def linearise(
        self, joints: Float[np.ndarray, "rows joints"], corrections: Float[np.ndarray, "parameters"] | None = None
    ) -> Linearisation:
        """Returns the tool poses and the twist of every parameter; see `poses` for the arguments."""
        rotation, origin = _start(len(joints))
        twists = np.zeros((len(joints), len(self.parameters), 6))
        column = 0
        for motion, amount in self._amounts(joints, corrections):
            if motion.parameter is not None:
                axis = rotation[:, :, motion.axis]
                if motion.turns:
                    twists[:, column, :3] = np.cross(origin, axis)
                    twists[:, column, 3:] = axis
                else:
                    twists[:, column, :3] = axis
                column += 1
            _advance(motion, amount, rotation, origin)
        return Linearisation(_homogeneous(rotation, origin), twists)

    def _amounts(self, joints, corrections):
        column = 0
        for motion in self.motions:
            amount = motion.value
            if motion.parameter is not None:
                if corrections is not None:
                    amount = amount + corrections[column]
                column += 1
            if motion.joint is not None:
                amount = amount + motion.ratio * joints[:, motion.joint]
            yield motion, amount


def fixed_motions(frame: Frame) -> tuple[Motion, ...]:
    """Returns the motions that lead to a frame and on; none for those that are nothing."""
    shifts = tuple(Motion(turns=False, axis=axis, value=frame.xyz[axis]) for axis in range(3) if frame.xyz[axis])
    turns = tuple(Motion(turns=True, axis=axis, value=frame.rpy[axis]) for axis in (2, 1, 0) if frame.rpy[axis])
    return shifts + turns


def _start(rows: int) -> tuple[np.ndarray, np.ndarray]:
    return np.tile(np.eye(3), (rows, 1, 1)), np.zeros((rows, 3))


def _advance(motion: Motion, amount: np.ndarray | float, rotation: np.ndarray, origin: np.ndarray) -> None:
    """Moves (R, p) on by one motion, in place: a turn mixes two columns of R, a shift adds one to p."""
    if motion.turns:
        i, j = (motion.axis + 1) % 3, (motion.axis + 2) % 3
        cosine, sine = np.cos(amount), np.sin(amount)
        if np.ndim(amount):
            cosine, sine = cosine[:, None], sine[:, None]
        u, v = rotation[:, :, i].copy(), rotation[:, :, j].copy()
        rotation[:, :, i] = cosine * u + sine * v
        rotation[:, :, j] = cosine * v - sine * u
    else:
        origin += np.asarray(amount)[..., None] * rotation[:, :, motion.axis]


def _homogeneous(rotation: np.ndarray, origin: np.ndarray) -> np.ndarray:
    T = np.zeros((len(rotation), 4, 4))
    T[:, :3, :3] = rotation
    T[:, :3, 3] = origin
    T[:, 3, 3] = 1.0
    return T
