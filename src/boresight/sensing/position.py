"""A laser tracker that reports where the tool frame's origin is, in the world."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from boresight.kernels.programs import OFFSET
from boresight.sensing.sensor import Readout, Reference, Response, Target, TargetKind
from boresight.units import Quantity


@dataclass(frozen=True, slots=True)
class Position:
    """The coordinates (x, y, z) [m] of the tool frame's origin in the world, times 1 + scale.

    Attributes:
        noise_std: standard deviation of one reading of each coordinate [m].
        repeats: readings averaged in a row.
        scale: relative error of its unit of length, as a tracker has from the temperature of the air.
    """

    type: ClassVar[str] = "position"
    channels: ClassVar[tuple[str, ...]] = ("x", "y", "z")
    columns: ClassVar[tuple[str, ...]] = ("x", "y", "z")
    aims_at: ClassVar[TargetKind] = None
    readouts: ClassVar[tuple[Readout, ...]] = tuple(Readout(OFFSET, axis, axis) for axis in range(3))
    levers: ClassVar[tuple[None, ...]] = (None, None, None)
    numbers: ClassVar[Mapping[str, Quantity]] = MappingProxyType({"scale": "number"})

    noise_std: float
    repeats: int = 1
    scale: float = 0.0

    def adjusted(self, corrections: Mapping[str, float]) -> Position:
        """Returns the tracker with a correction added to its `scale`."""
        return replace(self, scale=self.scale + corrections.get("scale", 0.0))

    def predict(
        self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference
    ) -> Float[np.ndarray, "rows 3"]:
        """Returns the tool's position [m] in the world."""
        return (1.0 + self.scale) * poses[:, :3, 3]

    def respond(self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference) -> Response:
        """Returns the positions and their derivatives: a twist (v, w) moves p by v + w × p."""
        p, gain = poses[:, :3, 3], 1.0 + self.scale
        return Response(gain * p, gain * shifts_by_twist(p), np.zeros((len(p), 3, 0)), p[:, :, None])


def shifts_by_twist(p: Float[np.ndarray, "rows 3"]) -> Float[np.ndarray, "rows 3 6"]:
    """Returns the derivative of points p [m] by the twist (v, w) of the body they are fixed to: v + w × p."""
    by_twist = np.zeros((len(p), 3, 6))
    by_twist[:, :, :3] = np.eye(3)
    by_twist[:, 0, 4], by_twist[:, 0, 5] = p[:, 2], -p[:, 1]
    by_twist[:, 1, 3], by_twist[:, 1, 5] = -p[:, 2], p[:, 0]
    by_twist[:, 2, 3], by_twist[:, 2, 4] = p[:, 1], -p[:, 0]
    return by_twist
