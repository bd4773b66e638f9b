"""A laser ranger: the distance along its beam to a plane (paper, eq. 6 to 9)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from boresight.geometry import Plane, range_to_plane
from boresight.kernels.programs import RANGE
from boresight.sensing.sensor import Readout, Reference, Response, Target, TargetKind
from boresight.units import Quantity


@dataclass(frozen=True, slots=True)
class LaserRanger:
    """A ranger whose beam leaves the tool frame's origin along its +z: it reads (1 + scale) h + bias.

    Attributes:
        noise_std: standard deviation of one reading [m].
        repeats: readings averaged in a row.
        bias: what it reads at distance zero [m].
        scale: relative error of its unit of length.
    """

    type: ClassVar[str] = "laser_ranger"
    channels: ClassVar[tuple[str, ...]] = ("range",)
    columns: ClassVar[tuple[str, ...]] = ("range",)
    aims_at: ClassVar[TargetKind] = Plane
    readouts: ClassVar[tuple[Readout, ...]] = (Readout(RANGE),)
    levers: ClassVar[tuple[None, ...]] = (None,)
    numbers: ClassVar[Mapping[str, Quantity]] = MappingProxyType({"bias": "length", "scale": "number"})

    noise_std: float
    repeats: int = 1
    bias: float = 0.0
    scale: float = 0.0

    def adjusted(self, corrections: Mapping[str, float]) -> LaserRanger:
        """Returns the ranger with corrections added to its `bias` [m] and `scale`."""
        bias, scale = corrections.get("bias", 0.0), corrections.get("scale", 0.0)
        return replace(self, bias=self.bias + bias, scale=self.scale + scale)

    def predict(
        self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference
    ) -> Float[np.ndarray, "rows 1"]:
        """Returns the ranges [m] it reads to the plane; NaN where the beam looks away from it."""
        return (1.0 + self.scale) * self._distance(poses, target) + self.bias

    def respond(self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference) -> Response:
        """Returns the ranges and their derivatives.

        With x = p + h b where the beam meets the plane, a twist (v, w) of the tool moves x by v + w × x, and
        n·x + f must stay 0, so dh = -(n·v + (x × n)·w) / (n·b): the plane's wrench at the hit point. In the
        same way dh/dn = -x / (n·b) and dh/df = -1 / (n·b).
        """
        assert isinstance(target, Plane)
        normal = np.asarray(target.normal)
        beam = poses[:, :3, 2]
        distance = self._distance(poses, target)
        hit = poses[:, :3, 3] + distance * beam
        slope = -(1.0 + self.scale) / (beam @ normal)[:, None]
        by_twist = slope * np.hstack([np.broadcast_to(normal, hit.shape), np.cross(hit, normal)])
        by_target = slope * np.hstack([hit, np.ones((len(hit), 1))])
        by_sensor = np.hstack([np.ones_like(distance), distance])
        values = (1.0 + self.scale) * distance + self.bias
        return Response(values, by_twist[:, None, :], by_target[:, None, :], by_sensor[:, None, :])

    def _distance(self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None) -> Float[np.ndarray, "rows 1"]:
        assert isinstance(target, Plane)
        return range_to_plane(poses[:, :3, 3], poses[:, :3, 2], target)[:, None]
