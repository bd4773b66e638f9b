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
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from boresight.geometry import Frame
from boresight.units import Quantity

if TYPE_CHECKING:
    from boresight.arm.levers import Levers


@runtime_checkable
class Factor(Protocol):
    """What a configuration multiplies a motion's amount by."""

    @property
    def joint(self) -> int:
        """The column of the joint readings whose axis the motion turns about."""
        ...

    @property
    def link(self) -> int | None:
        """The link whose weight it is the lever of, or None."""
        ...

    def of(
        self, joints: Float[np.ndarray, "rows joints"], moments: Float[np.ndarray, "rows joints links"] | None
    ) -> Float[np.ndarray, "rows"]:
        """Returns it for every row, from the readings [rad or m] and the moments of gravity [m] where there are any."""
        ...


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
        factor: what the amount is multiplied by in each configuration, or None.
    """

    turns: bool
    axis: int
    value: float = 0.0
    parameter: str | None = None
    joint: int | None = None
    ratio: float = 1.0
    factor: Factor | None = None

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


@dataclass(frozen=True, slots=True)
class Walk:
    """What is passed on the way from the base to the tool.

    Attributes:
        axes: (rows, joints, 3) the joints' axes.
        origins: (rows, joints, 3) where they are [m].
        ends: (rows, joints, 3) where each joint's link ends [m]: at the next joint, or with the chain.
        twists: (rows, parameters, 6) as in `Linearisation`.
    """

    axes: Float[np.ndarray, "rows joints 3"]
    origins: Float[np.ndarray, "rows joints 3"]
    ends: Float[np.ndarray, "rows joints 3"]
    twists: Float[np.ndarray, "rows parameters 6"]


@dataclass(frozen=True)
class Chain:
    """Elementary motions from a base to a tool, in order.

    Attributes:
        motions: from the base outwards.
        joints: number of joint readings a configuration has.
        levers: what gravity takes hold of, where some motion's factor asks for it.
    """

    motions: tuple[Motion, ...]
    joints: int
    levers: Levers | None = None

    @cached_property
    def parameters(self) -> tuple[str, ...]:
        """The names of the amounts that can be corrected, from the base outwards."""
        return tuple(motion.parameter for motion in self.motions if motion.parameter is not None)

    def __add__(self, other: Chain) -> Chain:
        """Returns the chain that goes on with another whose joints, if any, share the readings."""
        return Chain(self.motions + other.motions, max(self.joints, other.joints), self.levers or other.levers)

    def corrected(self, corrections: Mapping[str, float]) -> Chain:
        """Returns the chain with corrections [rad or m] added to the named amounts."""
        return Chain(
            tuple(
                replace(motion, value=motion.value + corrections.get(motion.parameter or "", 0.0))
                for motion in self.motions
            ),
            self.joints,
            None if self.levers is None else self.levers.corrected(corrections),
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
        for motion, amount, _ in self._amounts(joints, corrections):
            _advance(motion, amount, rotation, origin)
        return _homogeneous(rotation, origin)

    def up_to_joints(self, joints: Float[np.ndarray, "rows joints"]) -> Float[np.ndarray, "rows moving 4 4"]:
        """Returns the frame in which each joint moves, joint by joint from the base outwards."""
        rotation, origin = _start(len(joints))
        frames = []
        for motion, amount, _ in self._amounts(joints, None):
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
        turns = np.zeros((len(joints), self.joints, 6))
        column = 0
        for motion, amount, factor in self._amounts(joints, corrections):
            if motion.parameter is not None:
                _set_twist(twists[:, column], motion, factor, rotation, origin)
                column += 1
            if motion.joint is not None and self.levers is not None:
                _set_twist(turns[:, motion.joint], motion, None, rotation, origin)
            _advance(motion, amount, rotation, origin)
        if self.levers is not None:
            slopes = self.levers.slopes(joints, self._rigid_part(corrections), self._sag(corrections))
            twists[:, self._rigid] += np.einsum("rjm,rjd->rmd", slopes, turns, optimize=True)
        return Linearisation(_homogeneous(rotation, origin), twists)

    def walk(
        self, joints: Float[np.ndarray, "rows joints"], corrections: Float[np.ndarray, "parameters"] | None = None
    ) -> Walk:
        """Returns the joints' axes, the links' ends and every parameter's twist; see `poses` for the arguments."""
        rotation, origin = _start(len(joints))
        twists = np.zeros((len(joints), len(self.parameters), 6))
        axes, origins = [], []
        column = 0
        for motion, amount, factor in self._amounts(joints, corrections):
            if motion.joint is not None:
                axes.append(rotation[:, :, motion.axis].copy())
                origins.append(origin.copy())
            if motion.parameter is not None:
                _set_twist(twists[:, column], motion, factor, rotation, origin)
                column += 1
            _advance(motion, amount, rotation, origin)
        ends = [*origins[1:], origin]
        return Walk(np.stack(axes, axis=1), np.stack(origins, axis=1), np.stack(ends, axis=1), twists)

    def bends(self, joints: Float[np.ndarray, "rows joints"]) -> Float[np.ndarray, "rows moving"]:
        """Returns how much further than its reading says each joint turns [rad], all amounts as they are.

        A column each motion that is a joint's, from the base outwards: an arm's joints, those that mimic others too.
        """
        further: list[Any] = []
        for motion, amount, _ in self._amounts(joints, None):
            if motion.joint is not None:
                further.append(np.zeros(len(joints)))
            elif motion.factor is not None:
                further[-1] = further[-1] + amount
        return np.stack(further, axis=1)

    @cached_property
    def _rigid(self) -> list[int]:
        """The columns of the levers' own parameters among this chain's."""
        assert self.levers is not None
        return [self.parameters.index(name) for name in self.levers.chain.parameters]

    def _rigid_part(self, corrections):
        return None if corrections is None else corrections[self._rigid]

    def _sag(self, corrections) -> Float[np.ndarray, "joints links"]:
        """Returns how far each joint turns for a metre of each link's lever [rad]."""
        sag, column = np.zeros((self.joints, self.joints)), 0
        for motion in self.motions:
            if motion.factor is not None and motion.factor.link is not None:
                correction = 0.0 if corrections is None else corrections[column]
                sag[motion.factor.joint, motion.factor.link] = motion.value + correction
            column += motion.parameter is not None
        return sag

    def _amounts(self, joints, corrections):
        """Yields each motion, its amount, and what a unit of its parameter adds to that."""
        moments = None
        if self.levers is not None:
            moments = self.levers.moments(joints, self._rigid_part(corrections))
        column = 0
        for motion in self.motions:
            amount: Any = motion.value
            if motion.parameter is not None:
                if corrections is not None:
                    amount = amount + corrections[column]
                column += 1
            factor = None if motion.factor is None else motion.factor.of(joints, moments)
            if factor is not None:
                amount = amount * factor
            if motion.joint is not None:
                amount = amount + motion.ratio * joints[:, motion.joint]
            yield motion, amount, factor


def fixed_motions(frame: Frame) -> tuple[Motion, ...]:
    """Returns the motions that lead to a frame and on; none for those that are nothing."""
    shifts = tuple(Motion(turns=False, axis=axis, value=frame.xyz[axis]) for axis in range(3) if frame.xyz[axis])
    turns = tuple(Motion(turns=True, axis=axis, value=frame.rpy[axis]) for axis in (2, 1, 0) if frame.rpy[axis])
    return shifts + turns


def _start(rows: int) -> tuple[np.ndarray, np.ndarray]:
    return np.tile(np.eye(3), (rows, 1, 1)), np.zeros((rows, 3))


def _set_twist(
    twist: np.ndarray, motion: Motion, factor: np.ndarray | None, rotation: np.ndarray, origin: np.ndarray
) -> None:
    """Sets a column of twists to what a unit of a motion does to everything after it."""
    axis = rotation[:, :, motion.axis]
    if factor is not None:
        axis = axis * factor[:, None]
    if motion.turns:
        (x, y, z), (u, v, w) = origin.T, axis.T
        # Component by component: np.cross takes five times as long for a few hundred rows.
        twist[:, 0], twist[:, 1], twist[:, 2] = y * w - z * v, z * u - x * w, x * v - y * u
        twist[:, 3:] = axis
    else:
        twist[:, :3] = axis


def _advance(motion: Motion, amount: np.ndarray | float, rotation: np.ndarray, origin: np.ndarray) -> None:
    """Moves (R, p) on by one motion, in place: a turn mixes two columns of R, a shift adds one to p."""
    of_rows = isinstance(amount, np.ndarray)
    if not of_rows and amount == 0.0:  # about half of an arm's numbers
        return
    if motion.turns:
        i, j = (motion.axis + 1) % 3, (motion.axis + 2) % 3
        cosine, sine = np.cos(amount), np.sin(amount)
        if of_rows:
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
