"""A laser tracker that reports where the tool frame's origin is, in the world."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from boresight.geometry import Plane
from boresight.kernels.programs import OFFSET
from boresight.sensing.sensor import Readout, Response
from boresight.units import Quantity

_AXIS_PLANES = (Plane((1.0, 0.0, 0.0), 0.0), Plane((0.0, 1.0, 0.0), 0.0), Plane((0.0, 0.0, 1.0), 0.0))


@dataclass(frozen=True, slots=True)
class Position:
    """The coordinates (x, y, z) [m] of the tool frame's origin in the world.

    Attributes:
        noise_std: standard deviation of one reading of each coordinate [m].
        repeats: readings averaged in a row.
    """

    type: ClassVar[str] = "position"
    channels: ClassVar[tuple[str, ...]] = ("x", "y", "z")
    needs_target: ClassVar[bool] = False
    readouts: ClassVar[tuple[Readout, ...]] = tuple(Readout(OFFSET, plane) for plane in _AXIS_PLANES)
    numbers: ClassVar[Mapping[str, Quantity]] = MappingProxyType({})

    noise_std: float
    repeats: int = 1

    def adjusted(self, corrections: Mapping[str, float]) -> Position:
        """Returns the sensor itself: it has no numbers of its own."""
        return self

    def predict(self, poses: Float[np.ndarray, "rows 4 4"], target: Plane | None) -> Float[np.ndarray, "rows 3"]:
        """Returns the tool's position [m] in the world."""
        return poses[:, :3, 3]

    def respond(self, poses: Float[np.ndarray, "rows 4 4"], target: Plane | None) -> Response:
        """Returns the positions and their derivatives: a twist (v, w) moves p by v + w × p."""
        p = poses[:, :3, 3]
        by_twist = np.zeros((len(p), 3, 6))
        by_twist[:, :, :3] = np.eye(3)
        by_twist[:, 0, 4], by_twist[:, 0, 5] = p[:, 2], -p[:, 1]
        by_twist[:, 1, 3], by_twist[:, 1, 5] = -p[:, 2], p[:, 0]
        by_twist[:, 2, 3], by_twist[:, 2, 4] = p[:, 1], -p[:, 0]
        return Response(p, by_twist, np.zeros((len(p), 3, 4)), np.zeros((len(p), 3, 0)))
