"""A robot cell: an arm where it stands, the sensor it carries, and what that looks at."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int

from boresight.arm import Arm, Chain, Motion
from boresight.geometry import Frame, Plane
from boresight.sensing.sensor import Sensor
from boresight.units import Quantity

FRAME_NUMBERS = ("x", "y", "z", "roll", "pitch", "yaw")
"""The six numbers of a frame: shifts along the parent's axes, turns about the frame's own."""

AXES = "xyz"

SENSOR = "sensor"
"""Owner of the sensor's own numbers: `sensor.bias`, `sensor.scale`."""


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
    """Everything that decides what the sensor reads in a configuration.

    Attributes:
        arm: the arm.
        sensor: what it carries.
        base: `T_world_base`.
        mount: `T_flange_sensor`, the flange being the frame after the last link.
        targets: named planes in the world.
    """

    arm: Arm
    sensor: Sensor
    base: Frame = Frame()
    mount: Frame = Frame()
    targets: Mapping[str, Plane] = field(default_factory=dict)

    @cached_property
    def chain(self) -> Chain:
        """The elementary motions from the world to the sensor's frame."""
        return _frame_chain("base", self.base) + self.arm.chain + _frame_chain("mount", self.mount)

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """Every number that may be wrong: the chain's from the world outwards, the targets', the sensor's own."""
        moving = (Parameter(m.parameter, m.quantity) for m in self.chain.motions if m.parameter is not None)
        planes = (p for name, plane in self.targets.items() for p in _plane_parameters(name, plane))
        own = (Parameter(f"{SENSOR}.{name}", quantity) for name, quantity in self.sensor.numbers.items())
        return (*moving, *planes, *own)

    @cached_property
    def index(self) -> dict[str, int]:
        """The place of each parameter in `parameters`."""
        return {parameter.name: place for place, parameter in enumerate(self.parameters)}

    @cached_property
    def values(self) -> dict[str, float]:
        """The value of every parameter [m or rad], by name; turns of a frame as roll, pitch and yaw."""
        numbers = dict(_frame_values("base", self.base) | _frame_values("mount", self.mount))
        numbers |= {m.parameter: m.value for m in self.arm.chain.motions if m.parameter is not None}
        for name, plane in self.targets.items():
            numbers |= {f"{name}.normal_{axis}": n for axis, n in zip(AXES, plane.normal, strict=True)}
            numbers[f"{name}.offset"] = plane.offset
        numbers |= {f"{SENSOR}.{name}": getattr(self.sensor, name) for name in self.sensor.numbers}
        return numbers

    def poses(
        self, joints: Float[np.ndarray, "rows joints"], corrections: Float[np.ndarray, "parameters"] | None = None
    ) -> Float[np.ndarray, "rows 4 4"]:
        """Returns `T_world_sensor` at joint readings [rad or m]."""
        return self.chain.poses(joints, self._chain_part(corrections))

    def predict(
        self,
        joints: Float[np.ndarray, "rows joints"],
        target: Int[np.ndarray, "rows"],
        corrections: Float[np.ndarray, "parameters"] | None = None,
    ) -> Float[np.ndarray, "rows channels"]:
        """Returns what the sensor would read; NaN where it cannot see its target.

        Args:
            joints: joint readings [rad or m].
            target: for each row the index of its target, in the order of `targets`.
            corrections: added to the nominal values, in the order of `parameters`; none by default.
        """
        poses, sensor = self.poses(joints, corrections), self._adjusted_sensor(corrections)
        values = np.empty((len(joints), len(self.sensor.channels)))
        for rows, plane, _ in self._by_target(target, corrections):
            values[rows] = sensor.predict(poses[rows], plane)
        return values

    def linearise(
        self,
        joints: Float[np.ndarray, "rows joints"],
        target: Int[np.ndarray, "rows"],
        corrections: Float[np.ndarray, "parameters"] | None = None,
    ) -> tuple[Float[np.ndarray, "rows channels"], Float[np.ndarray, "rows channels parameters"]]:
        """Returns what the sensor would read and its exact derivative by every parameter; see `predict`."""
        motion = self.chain.linearise(joints, self._chain_part(corrections))
        sensor = self._adjusted_sensor(corrections)
        channels, moving, own = len(sensor.channels), len(self.chain.parameters), len(sensor.numbers)
        values = np.empty((len(joints), channels))
        jacobian = np.zeros((len(joints), channels, len(self.parameters)))
        for rows, plane, columns in self._by_target(target, corrections):
            response = sensor.respond(motion.poses[rows], plane)
            values[rows] = response.values
            jacobian[rows, :, :moving] = response.by_twist @ np.swapaxes(motion.twists[rows], 1, 2)
            jacobian[rows, :, jacobian.shape[2] - own :] = response.by_sensor
            if plane is not None:
                jacobian[rows, :, columns] = response.by_plane @ plane.derivative
        return values, jacobian

    def corrected(self, corrections: Mapping[str, float]) -> Cell:
        """Returns the cell with corrections [m or rad] applied to the named parameters (paper, eq. 10)."""
        unknown = set(corrections) - set(self.index)
        assert not unknown, f"no such parameters: {unknown}"
        return replace(
            self,
            arm=self.arm.corrected(corrections),
            base=_moved_frame("base", self.base, corrections),
            mount=_moved_frame("mount", self.mount, corrections),
            sensor=self.sensor.adjusted({n: corrections.get(f"{SENSOR}.{n}", 0.0) for n in self.sensor.numbers}),
            targets={name: _moved_plane(name, plane, corrections) for name, plane in self.targets.items()},
        )

    def under(self, gravity: tuple[float, float, float]) -> Cell:
        """Returns the cell whose arm feels gravity in a direction of the world, a unit vector."""
        x, y, z = (float(part) for part in self.base.matrix[:3, :3].T @ np.array(gravity))
        return replace(self, arm=replace(self.arm, gravity=(x, y, z)))

    def _adjusted_sensor(self, corrections: Float[np.ndarray, "parameters"] | None) -> Sensor:
        numbers = self.sensor.numbers
        if corrections is None or not numbers:
            return self.sensor
        own = corrections[len(corrections) - len(numbers) :]
        return self.sensor.adjusted({name: float(value) for name, value in zip(numbers, own, strict=True)})

    def _chain_part(self, corrections):
        return None if corrections is None else corrections[: len(self.chain.parameters)]

    def _by_target(self, target, corrections):
        """Yields (rows, plane, the plane's columns of the Jacobian) for each target in use."""
        if not self.sensor.needs_target:
            yield slice(None), None, slice(0, 0)
            return
        start = len(self.chain.parameters)
        for place, plane in enumerate(self.targets.values()):
            rows = np.flatnonzero(target == place)
            columns = slice(start + 3 * place, start + 3 * place + 3)
            if corrections is not None:
                first, second, offset = (float(c) for c in corrections[columns])
                plane = plane.moved((first, second), offset)
            if len(rows):
                yield rows, plane, columns


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


def _plane_parameters(name: str, plane: Plane) -> tuple[Parameter, ...]:
    first, second = (AXES[axis] for axis in plane.free_components)
    return (
        Parameter(f"{name}.normal_{first}", "number"),
        Parameter(f"{name}.normal_{second}", "number"),
        Parameter(f"{name}.offset", "length"),
    )


def _moved_plane(name: str, plane: Plane, corrections: Mapping[str, float]) -> Plane:
    first, second, offset = (corrections.get(p.name, 0.0) for p in _plane_parameters(name, plane))
    return plane.moved((first, second), offset) if any((first, second, offset)) else plane
