"""What every sensor is: a function of the tool's pose and a target, with its derivative.

A new sensor is one file with one class like these. Because its derivative is taken with respect to a twist
of the tool, every geometric parameter works with it; because its readout is stated as planes to carry, it
runs in the compiled search.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from boresight.geometry import Plane
from boresight.units import Quantity


@dataclass(frozen=True, slots=True)
class Response:
    """Predicted readings of one target, and what changes them.

    Attributes:
        values: (rows, channels) predicted readings; NaN where the sensor cannot see the target.
        by_twist: (rows, channels, 6) derivative by the tool's twist (v, w) about the world's origin.
        by_plane: (rows, channels, 4) derivative by the target plane's (n_x, n_y, n_z, f); zeros without one.
        by_sensor: (rows, channels, numbers) derivative by the sensor's own numbers.
    """

    values: Float[np.ndarray, "rows channels"]
    by_twist: Float[np.ndarray, "rows channels 6"]
    by_plane: Float[np.ndarray, "rows channels 4"]
    by_sensor: Float[np.ndarray, "rows channels numbers"]


@dataclass(frozen=True, slots=True)
class Readout:
    """One channel as the compiled loop sees it: what is read off a plane carried to the sensor's frame.

    Attributes:
        kind: `boresight.kernels.programs.RANGE` or `OFFSET`.
        plane: a plane fixed in the world, or None for the row's own target.
    """

    kind: int
    plane: Plane | None = None


@runtime_checkable
class Sensor(Protocol):
    """A kind of sensor; its own frame is the tool frame (beam along +z where it has one).

    Attributes:
        type: its name in campaign files.
        channels: names of the values it reports, as columns of an observations file.
        needs_target: whether it must point at a named target.
        readouts: the compiled form of each channel.
        numbers: the sensor's own numbers that may be wrong, as parameters `sensor.<name>`, with their quantities.
    """

    type: ClassVar[str]
    channels: ClassVar[tuple[str, ...]]
    needs_target: ClassVar[bool]
    readouts: ClassVar[tuple[Readout, ...]]
    numbers: ClassVar[Mapping[str, Quantity]]

    @property
    def noise_std(self) -> float:
        """Standard deviation of one reading of one channel [m]."""
        ...

    @property
    def repeats(self) -> int:
        """Readings averaged in a row, unless the row says otherwise."""
        ...

    def adjusted(self, corrections: Mapping[str, float]) -> Sensor:
        """Returns the sensor with corrections added to its own numbers, by name."""
        ...

    def predict(self, poses: Float[np.ndarray, "rows 4 4"], target: Plane | None) -> Float[np.ndarray, "rows channels"]:
        """Returns what it would read at tool poses `T_world_sensor`; NaN where it cannot see the target."""
        ...

    def respond(self, poses: Float[np.ndarray, "rows 4 4"], target: Plane | None) -> Response:
        """Returns what it would read and the exact derivatives."""
        ...
