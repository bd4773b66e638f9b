"""What every sensor is: a function of the tool's pose and a target, with its derivative.

A new sensor is one file with one class like these. Because its derivative is taken with respect to a twist
of the tool, every geometric parameter works with it; because its readouts are stated as planes or points to
carry, it runs in the compiled search.

Every value is a length [m]. An orientation is read as arcs: its rotation vector times a lever on which the
sensor's angles are as noisy as its lengths, so that errors, noise and costs compare whatever a sensor reads.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from boresight.geometry import Plane, Point
from boresight.units import Quantity

Target = Plane | Point
"""What a sensor can be aimed at."""

TargetKind = type[Plane] | type[Point] | None
"""The kind of target a sensor must be aimed at, if any."""

Reference = Float[np.ndarray, "rows 4 4"]
"""What a row is read against: the measured orientation of a pose, the other end of a distance; else the identity."""


@dataclass(frozen=True, slots=True)
class Response:
    """Predicted readings of one target, and what changes them.

    Attributes:
        values: (rows, channels) predicted readings [m]; NaN where the sensor cannot see the target.
        by_twist: (rows, channels, 6) derivative by the tool's twist (v, w) about the world's origin.
        by_target: (rows, channels, numbers) derivative by a plane's (n_x, n_y, n_z, f) or a point's (x, y, z); no
            numbers without a target.
        by_sensor: (rows, channels, numbers) derivative by the sensor's own numbers.
        by_reference: (rows, channels, 6) derivative by the twist of the tool at the other end of a distance, or None.
    """

    values: Float[np.ndarray, "rows channels"]
    by_twist: Float[np.ndarray, "rows channels 6"]
    by_target: Float[np.ndarray, "rows channels of_target"]
    by_sensor: Float[np.ndarray, "rows channels of_sensor"]
    by_reference: Float[np.ndarray, "rows channels 6"] | None = None


@dataclass(frozen=True, slots=True)
class Readout:
    """One number as the compiled loop sees it: what is read off something carried to the sensor's frame.

    Attributes:
        kind: one of `boresight.kernels.programs`: `RANGE`, `OFFSET`, `DISTANCE`, `COMPONENT` and the two after it.
        channel: the channel it belongs to, which gives its weight; and its reading, unless it is a component.
        axis: the plane of the world at right angles to this axis is carried; None for the row's own target.
        weight: factor on the channel's weight.
    """

    kind: int
    channel: int = 0
    axis: int | None = None
    weight: float = 1.0


@runtime_checkable
class Sensor(Protocol):
    """A kind of sensor; its own frame is the tool frame (beam along +z where it has one).

    Attributes:
        type: its name in campaign files.
        channels: names of the values it reports.
        columns: names of their columns in an observations file.
        aims_at: the kind of target it must be aimed at, or None.
        numbers: the sensor's own numbers that may be wrong, as parameters `sensor.<name>`, with their quantities.
    """

    type: ClassVar[str]
    channels: ClassVar[tuple[str, ...]]
    columns: ClassVar[tuple[str, ...]]
    aims_at: ClassVar[TargetKind]
    numbers: ClassVar[Mapping[str, Quantity]]

    @property
    def noise_std(self) -> float:
        """Standard deviation of one reading of one channel [m]."""
        ...

    @property
    def repeats(self) -> int:
        """Readings averaged in a row, unless the row says otherwise."""
        ...

    @property
    def readouts(self) -> tuple[Readout, ...]:
        """The compiled form of the channels; none where the compiled search does not have it."""
        ...

    @property
    def levers(self) -> tuple[float | None, ...]:
        """For each channel None where it is a length, else the lever [m] on which its angle is read."""
        ...

    def adjusted(self, corrections: Mapping[str, float]) -> Sensor:
        """Returns the sensor with corrections added to its own numbers, by name."""
        ...

    def predict(
        self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference
    ) -> Float[np.ndarray, "rows channels"]:
        """Returns what it would read at tool poses `T_world_sensor`; NaN where it cannot see the target."""
        ...

    def respond(self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference) -> Response:
        """Returns what it would read and the exact derivatives."""
        ...
