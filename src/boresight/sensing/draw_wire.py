"""A draw-wire: the distance from the tool to a fixed point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from boresight.geometry import Point
from boresight.kernels.programs import DISTANCE
from boresight.sensing.sensor import Readout, Reference, Response, Target, TargetKind
from boresight.units import Quantity

_NEAREST = 1e-9
"""Closer than this [m] to its point a wire has no direction."""


@dataclass(frozen=True, slots=True)
class DrawWire:
    """A wire drawn from a fixed point to the tool frame's origin, h long: it reads (1 + scale) h + bias.

    Attributes:
        noise_std: standard deviation of one reading [m].
        repeats: readings averaged in a row.
        bias: what it reads at length zero [m].
        scale: relative error of its unit of length.
    """

    type: ClassVar[str] = "draw_wire"
    channels: ClassVar[tuple[str, ...]] = ("distance",)
    columns: ClassVar[tuple[str, ...]] = ("distance",)
    aims_at: ClassVar[TargetKind] = Point
    readouts: ClassVar[tuple[Readout, ...]] = (Readout(DISTANCE),)
    levers: ClassVar[tuple[None, ...]] = (None,)
    numbers: ClassVar[Mapping[str, Quantity]] = MappingProxyType({"bias": "length", "scale": "number"})

    noise_std: float
    repeats: int = 1
    bias: float = 0.0
    scale: float = 0.0

    def adjusted(self, corrections: Mapping[str, float]) -> DrawWire:
        """Returns the wire with corrections added to its `bias` [m] and `scale`."""
        bias, scale = corrections.get("bias", 0.0), corrections.get("scale", 0.0)
        return replace(self, bias=self.bias + bias, scale=self.scale + scale)

    def predict(
        self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference
    ) -> Float[np.ndarray, "rows 1"]:
        """Returns the lengths [m] it reads."""
        return (1.0 + self.scale) * np.linalg.norm(_wire(poses, target), axis=1, keepdims=True) + self.bias

    def respond(self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference) -> Response:
        """Returns the lengths and their derivatives.

        With u the unit vector from the point c to the tool p, a twist (v, w) changes the length by
        u·(v + w × p) = u·v + (p × u)·w, and dh/dc = -u.
        """
        wire = _wire(poses, target)
        length = np.linalg.norm(wire, axis=1, keepdims=True)
        gain = 1.0 + self.scale
        u = gain * wire / np.maximum(length, _NEAREST)
        by_twist = np.hstack([u, np.cross(poses[:, :3, 3], u)])
        by_sensor = np.hstack([np.ones_like(length), length])
        return Response(gain * length + self.bias, by_twist[:, None, :], -u[:, None, :], by_sensor[:, None, :])


def _wire(poses: Float[np.ndarray, "rows 4 4"], target: Target | None) -> Float[np.ndarray, "rows 3"]:
    """Returns the vectors [m] from the fixed point to the tool."""
    assert isinstance(target, Point)
    return poses[:, :3, 3] - np.asarray(target.xyz)
