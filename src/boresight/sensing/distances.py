"""Distances between positions of a tracker: they do not depend on where the tracker stands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from boresight.sensing.sensor import Readout, Reference, Response, Target, TargetKind
from boresight.units import Quantity

_NEAREST = 1e-9
"""Closer than this [m] two positions have no direction between them."""


@dataclass(frozen=True, slots=True)
class Distances:
    """The distance [m] between the tool frame's origin in two configurations, from two readings of a position.

    Attributes:
        noise_std: standard deviation of one reading of a distance [m], sqrt(2) times that of a coordinate.
        repeats: readings averaged in a row.
    """

    type: ClassVar[str] = "distances"
    channels: ClassVar[tuple[str, ...]] = ("distance",)
    columns: ClassVar[tuple[str, ...]] = ("x", "y", "z")
    aims_at: ClassVar[TargetKind] = None
    readouts: ClassVar[tuple[Readout, ...]] = ()
    levers: ClassVar[tuple[None, ...]] = (None,)
    numbers: ClassVar[Mapping[str, Quantity]] = MappingProxyType({})

    noise_std: float
    repeats: int = 1

    def adjusted(self, corrections: Mapping[str, float]) -> Distances:
        """Returns the sensor itself: it has no numbers of its own."""
        return self

    def predict(
        self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference
    ) -> Float[np.ndarray, "rows 1"]:
        """Returns the distances [m] of the tool from where it is in the other configuration, `reference`."""
        return np.linalg.norm(poses[:, :3, 3] - reference[:, :3, 3], axis=1, keepdims=True)

    def respond(self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference) -> Response:
        """Returns the distances and their derivatives: with u from one end p' to the other p, u·(dp - dp')."""
        p, other = poses[:, :3, 3], reference[:, :3, 3]
        distance = np.linalg.norm(p - other, axis=1, keepdims=True)
        u = (p - other) / np.maximum(distance, _NEAREST)
        here, there = np.hstack([u, np.cross(p, u)]), np.hstack([u, np.cross(other, u)])
        nothing = np.zeros((len(p), 1, 0))
        return Response(distance, here[:, None, :], nothing, nothing, -there[:, None, :])
