"""A robot cell: an arm where it stands, the sensors it carries, and what they look at."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int

from boresight.arm import Arm, Chain, Linearisation, Motion
from boresight.geometry import Frame
from boresight.sensing.aims import Aim, default_aims
from boresight.sensing.readings import Readings
from boresight.sensing.sensor import Reference, Sensor, Target
from boresight.units import Quantity

FRAME_NUMBERS = ("x", "y", "z", "roll", "pitch", "yaw")
"""The six numbers of a frame: shifts along the parent's axes, turns about the frame's own."""

AXES = "xyz"

SENSOR, MOUNT = "sensor", "mount"
"""What a cell's only sensor and its only mount are called: `sensor.bias`, `mount.x`."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """A number of the cell that may be wrong.

    Attributes:
        name: `j2.beta`, `deck.normal_x`, `base.yaw`, ...
        quantity: length, angle or number.
    """

    name: str
    quantity: Quantity


@dataclass(frozen=True)
class Cell:
    """Everything that decides what the sensors read in a configuration.

    Attributes:
        arm: the arm.
        sensor: what it carries; several sensors by name.
        base: `T_world_base`.
        mount: `T_flange_sensor`, the flange being the frame after the last link; several markers by name.
        targets: named planes and points in the world.
        listed_aims: how rows can be taken; where empty, with each sensor on each mount at each of its targets.
        offsets: by parameter (`sensor.bias[monday]`) what a sensor's bias differs by [m] in a session of its own.
    """

    arm: Arm
    sensor: Sensor | Mapping[str, Sensor]
    base: Frame = Frame()
    mount: Frame | Mapping[str, Frame] = Frame()
    targets: Mapping[str, Target] = field(default_factory=dict)
    listed_aims: tuple[Aim, ...] = ()
    offsets: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def sensors(self) -> dict[str, Sensor]:
        """The sensors by name; the only one is called `sensor`."""
        return dict(self.sensor) if isinstance(self.sensor, Mapping) else {SENSOR: self.sensor}

    @cached_property
    def mounts(self) -> dict[str, Frame]:
        """The places on the flange by name; the only one is called `mount`. The first is the tool."""
        return dict(self.mount) if isinstance(self.mount, Mapping) else {MOUNT: self.mount}

    @cached_property
    def aims(self) -> tuple[Aim, ...]:
        """How rows can be taken; a row's `target` is its place among these."""
        return self.listed_aims or default_aims(self.sensors, self.mounts, self.targets)

    @cached_property
    def channels(self) -> int:
        """How many values a row has, that of the widest sensor."""
        return max(len(sensor.channels) for sensor in self.sensors.values())

    @cached_property
    def chains(self) -> dict[str, Chain]:
        """The elementary motions from the world to each mount."""
        trunk = _frame_chain("base", self.base) + self.arm.chain
        return {name: trunk + _frame_chain(name, frame) for name, frame in self.mounts.items()}

    @property
    def chain(self) -> Chain:
        """The elementary motions from the world to the tool: the first mount."""
        return next(iter(self.chains.values()))

    @cached_property
    def moving(self) -> tuple[str, ...]:
        """The parameters that move a mount, from the world outwards; they come first among `parameters`."""
        return tuple(dict.fromkeys(name for chain in self.chains.values() for name in chain.parameters))

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """Every number that may be wrong: the chains' from the world outwards, the targets', the sensors' own."""
        amounts = {m.parameter: m.quantity for chain in self.chains.values() for m in chain.motions}
        moving = (Parameter(name, amounts[name]) for name in self.moving)
        targets = (Parameter(f"{n}.{number}", q) for n, target in self.targets.items() for number, q in target.numbers)
        own = (Parameter(f"{n}.{number}", q) for n, s in self.sensors.items() for number, q in s.numbers.items())
        return (*moving, *targets, *own, *(Parameter(name, "length") for name in self.offsets))

    @cached_property
    def index(self) -> dict[str, int]:
        """The place of each parameter in `parameters`."""
        return {parameter.name: place for place, parameter in enumerate(self.parameters)}

    @cached_property
    def values(self) -> dict[str, float]:
        """The value of every parameter [m or rad], by name; turns of a frame as roll, pitch and yaw."""
        numbers: dict[str, float] = {}
        for name, frame in {"base": self.base, **self.mounts}.items():
            numbers |= _frame_values(name, frame)
        numbers |= {m.parameter: m.value for m in self.arm.chain.motions if m.parameter is not None}
        for name, target in self.targets.items():
            numbers |= {f"{name}.{number}": value for number, value in target.values.items()}
        for name, sensor in self.sensors.items():
            numbers |= {f"{name}.{number}": getattr(sensor, number) for number in sensor.numbers}
        return numbers | dict(self.offsets)

    def poses(
        self,
        joints: Float[np.ndarray, "rows joints"],
        corrections: Float[np.ndarray, "parameters"] | None = None,
        target: Int[np.ndarray, "rows"] | None = None,
    ) -> Float[np.ndarray, "rows 4 4"]:
        """Returns `T_world_sensor` at joint readings [rad or m], of each row's own mount where `target` tells it."""
        poses = np.empty((len(joints), 4, 4))
        for rows, chain, columns in self._by_mount(len(joints), target):
            poses[rows] = chain.poses(joints[rows], None if corrections is None else corrections[columns])
        return poses

    def linearised_poses(
        self,
        joints: Float[np.ndarray, "rows joints"],
        target: Int[np.ndarray, "rows"] | None = None,
        corrections: Float[np.ndarray, "parameters"] | None = None,
    ) -> Linearisation:
        """Returns `poses` and the twist of each row's mount by every moving parameter, zero by other mounts' own."""
        poses, twists = np.empty((len(joints), 4, 4)), np.zeros((len(joints), len(self.moving), 6))
        for rows, chain, columns in self._by_mount(len(joints), target):
            motion = chain.linearise(joints[rows], None if corrections is None else corrections[columns])
            poses[rows] = motion.poses
            twists[np.ix_(rows, columns)] = motion.twists
        return Linearisation(poses, twists)

    def predict(
        self,
        joints: Float[np.ndarray, "rows joints"],
        target: Int[np.ndarray, "rows"],
        corrections: Float[np.ndarray, "parameters"] | None = None,
        reference: Float[np.ndarray, "rows 3 3"] | None = None,
        since: Float[np.ndarray, "rows joints"] | None = None,
    ) -> Float[np.ndarray, "rows channels"]:
        """Returns what the sensors would read [m]; NaN where one cannot see its target, 0 where it has no such channel.

        Args:
            joints: joint readings [rad or m].
            target: for each row the index of its aim: of its target, in the order of `targets`, for one sensor.
            corrections: added to the nominal values, in the order of `parameters`; none by default.
            reference: measured orientations from which a pose's turn is read; the identity by default.
            since: the other configurations of distances between two; none by default.
        """
        poses = self.poses(joints, corrections, target)
        against = _against(reference, None if since is None else self.poses(since, corrections, target), len(joints))
        values = np.zeros((len(joints), self.channels))
        for rows, aim in self._by_aim(target):
            sensor, at = self._sensor(aim, corrections), self._target(aim, corrections)
            values[rows, : len(sensor.channels)] = sensor.predict(poses[rows], at, against[rows])
        return values

    def linearise(
        self,
        joints: Float[np.ndarray, "rows joints"],
        target: Int[np.ndarray, "rows"],
        corrections: Float[np.ndarray, "parameters"] | None = None,
        reference: Float[np.ndarray, "rows 3 3"] | None = None,
        since: Float[np.ndarray, "rows joints"] | None = None,
    ) -> tuple[Float[np.ndarray, "rows channels"], Float[np.ndarray, "rows channels parameters"]]:
        """Returns what the sensors would read and its exact derivative by every parameter; see `predict`."""
        motion = self.linearised_poses(joints, target, corrections)
        other = None if since is None else self.linearised_poses(since, target, corrections)
        against = _against(reference, None if other is None else other.poses, len(joints))
        values = np.zeros((len(joints), self.channels))
        jacobian = np.zeros((len(joints), self.channels, len(self.parameters)))
        for rows, aim in self._by_aim(target):
            sensor, at = self._sensor(aim, corrections), self._target(aim, corrections)
            response, channels = sensor.respond(motion.poses[rows], at, against[rows]), len(sensor.channels)
            values[rows, :channels] = response.values
            jacobian[rows, :channels, : len(self.moving)] = response.by_twist @ np.swapaxes(motion.twists[rows], 1, 2)
            if response.by_reference is not None and other is not None:
                twists = np.swapaxes(other.twists[rows], 1, 2)
                jacobian[rows, :channels, : len(self.moving)] += response.by_reference @ twists
            if aim.target is not None and at is not None:
                columns = self._target_columns(aim.target)
                jacobian[rows, :channels, columns] = response.by_target @ at.derivative
            for place, names in enumerate(self._own_names(aim)):
                for name in names:
                    jacobian[rows, :channels, self.index[name]] = response.by_sensor[:, :, place]
        return values, jacobian

    def errors(
        self, readings: Readings, corrections: Float[np.ndarray, "parameters"] | None = None
    ) -> Float[np.ndarray, "rows channels"]:
        """Returns predicted minus measured values [m]; NaN where a beam misses, 0 where there is no such channel."""
        at = readings
        return self.predict(at.joints, at.target, corrections, at.reference, at.since) - at.values

    def slopes(
        self, readings: Readings, corrections: Float[np.ndarray, "parameters"] | None = None
    ) -> Float[np.ndarray, "rows channels parameters"]:
        """Returns the exact derivative of `errors`; NaN where a beam misses."""
        at = readings
        return self.linearise(at.joints, at.target, corrections, at.reference, at.since)[1]

    def corrected(self, corrections: Mapping[str, float]) -> Cell:
        """Returns the cell with corrections [m or rad] applied to the named parameters (paper, eq. 10)."""
        unknown = set(corrections) - set(self.index)
        assert not unknown, f"no such parameters: {unknown}"
        mounts = {name: _moved_frame(name, frame, corrections) for name, frame in self.mounts.items()}
        sensors = {
            name: sensor.adjusted({n: corrections.get(f"{name}.{n}", 0.0) for n in sensor.numbers})
            for name, sensor in self.sensors.items()
        }
        return replace(
            self,
            arm=self.arm.corrected(corrections),
            base=_moved_frame("base", self.base, corrections),
            mount=mounts if isinstance(self.mount, Mapping) else mounts[MOUNT],
            sensor=sensors if isinstance(self.sensor, Mapping) else sensors[SENSOR],
            targets={name: _moved_target(name, target, corrections) for name, target in self.targets.items()},
            offsets={name: offset + corrections.get(name, 0.0) for name, offset in self.offsets.items()},
        )

    def under(self, gravity: tuple[float, float, float]) -> Cell:
        """Returns the cell whose arm feels gravity in a direction of the world, a unit vector."""
        x, y, z = (float(part) for part in self.base.matrix[:3, :3].T @ np.array(gravity))
        return replace(self, arm=replace(self.arm, gravity=(x, y, z)))

    def _sensor(self, aim: Aim, corrections: Float[np.ndarray, "parameters"] | None) -> Sensor:
        """Returns the sensor of an aim, its own numbers corrected and its session's offset added."""
        sensor, own = self.sensors[aim.sensor], {}
        for number, names in zip(sensor.numbers, self._own_names(aim), strict=True):
            own[number] = sum(self.offsets.get(name, 0.0) for name in names)
            if corrections is not None:
                own[number] += float(sum(corrections[self.index[name]] for name in names))
        return sensor.adjusted(own) if any(own.values()) else sensor

    def _own_names(self, aim: Aim) -> list[list[str]]:
        """Returns for each of the sensor's own numbers the parameters that add to it in an aim."""
        return [
            [name for name in (f"{aim.sensor}.{number}", aim.offset if number == "bias" else "") if name in self.index]
            for number in self.sensors[aim.sensor].numbers
        ]

    def _target(self, aim: Aim, corrections: Float[np.ndarray, "parameters"] | None) -> Target | None:
        if aim.target is None:
            return None
        target = self.targets[aim.target]
        return (
            target if corrections is None else target.corrected(corrections[self._target_columns(aim.target)].tolist())
        )

    def _target_columns(self, name: str) -> slice:
        numbers = self.targets[name].numbers
        first = self.index[f"{name}.{numbers[0][0]}"]
        return slice(first, first + len(numbers))

    def _by_aim(self, target: Int[np.ndarray, "rows"]) -> Iterator[tuple[Int[np.ndarray, "some"], Aim]]:
        """Yields (rows, aim) for each aim in use."""
        for place in np.unique(target).tolist():
            yield np.flatnonzero(target == place), self.aims[place]

    def _by_mount(
        self, count: int, target: Int[np.ndarray, "rows"] | None
    ) -> Iterator[tuple[Int[np.ndarray, "some"], Chain, Int[np.ndarray, "of_chain"]]]:
        """Yields (rows, chain, its parameters' places among the moving ones) for each mount in use."""
        only = len(self.mounts) == 1 or target is None
        mounts = np.array([list(self.mounts).index(aim.mount) for aim in self.aims])
        at = np.zeros(count, dtype=int) if only or target is None else mounts[target]
        for place, chain in enumerate(self.chains.values()):
            rows = np.flatnonzero(at == place)
            if len(rows):
                yield rows, chain, np.array([self.index[name] for name in chain.parameters])


def _against(
    orientation: Float[np.ndarray, "rows 3 3"] | None, others: Float[np.ndarray, "rows 4 4"] | None, rows: int
) -> Reference:
    """Returns what rows are read against: other poses where there are any, with measured orientations."""
    against = np.tile(np.eye(4), (rows, 1, 1)) if others is None else others.copy()
    if orientation is not None:
        against[:, :3, :3] = orientation
    return against


def _moved_target(name: str, target: Target, corrections: Mapping[str, float]) -> Target:
    moved = [corrections.get(f"{name}.{number}", 0.0) for number, _ in target.numbers]
    return target.corrected(moved) if any(moved) else target


def _frame_chain(name: str, frame: Frame) -> Chain:
    """A frame's motions: shifts that can be corrected, its fixed orientation, and turns that can be."""
    shifts = tuple(
        Motion(turns=False, axis=axis, value=frame.xyz[axis], parameter=f"{name}.{AXES[axis]}") for axis in range(3)
    )
    fixed = tuple(Motion(turns=True, axis=axis, value=frame.rpy[axis]) for axis in (2, 1, 0) if frame.rpy[axis])
    turns = tuple(
        Motion(turns=True, axis=axis, parameter=f"{name}.{number}")
        for axis, number in ((2, "yaw"), (1, "pitch"), (0, "roll"))
    )
    return Chain(shifts + fixed + turns, 0)


def _frame_values(name: str, frame: Frame) -> dict[str, float]:
    return {f"{name}.{number}": value for number, value in zip(FRAME_NUMBERS, frame.xyz + frame.rpy, strict=True)}


def _moved_frame(name: str, frame: Frame, corrections: Mapping[str, float]) -> Frame:
    numbers = [corrections.get(f"{name}.{number}", 0.0) for number in FRAME_NUMBERS]
    if not any(numbers):
        return frame
    return frame.moved((numbers[0], numbers[1], numbers[2]), (numbers[3], numbers[4], numbers[5]))
