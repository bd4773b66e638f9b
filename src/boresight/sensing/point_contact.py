"""A tip that touches a point, or a ball that sits in a socket: its position is the point's."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from boresight.geometry import Point
from boresight.sensing.position import shifts_by_twist
from boresight.sensing.sensor import Readout, Reference, Response, Target, TargetKind
from boresight.units import Quantity


@dataclass(frozen=True, slots=True)
class PointContact:
    """The vector p - c [m] from the point c that is touched to the tool frame's origin p: it is always zero.

    Attributes:
        noise_std: standard deviation [m] of each coordinate of that vector when contact is made.
        repeats: contacts averaged in a row.
    """

    type: ClassVar[str] = "point_contact"
    channels: ClassVar[tuple[str, ...]] = ("x", "y", "z")
    columns: ClassVar[tuple[str, ...]] = ()
    aims_at: ClassVar[TargetKind] = Point
    readouts: ClassVar[tuple[Readout, ...]] = ()
    levers: ClassVar[tuple[None, ...]] = (None, None, None)
    numbers: ClassVar[Mapping[str, Quantity]] = MappingProxyType({})

    noise_std: float
    repeats: int = 1

    def adjusted(self, corrections: Mapping[str, float]) -> PointContact:
        """Returns the sensor itself: it has no numbers of its own."""
        return self

    def predict(
        self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference
    ) -> Float[np.ndarray, "rows 3"]:
        """Returns the vectors [m] from the point to the tip, in the world."""
        assert isinstance(target, Point)
        return poses[:, :3, 3] - np.asarray(target.xyz)

    def respond(self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference) -> Response:
        """Returns the vectors and their derivatives: a twist (v, w) moves p by v + w × p."""
        count = len(poses)
        by_target = np.broadcast_to(-np.eye(3), (count, 3, 3))
        values = self.predict(poses, target, reference)
        return Response(values, shifts_by_twist(poses[:, :3, 3]), by_target, np.zeros((count, 3, 0)))
