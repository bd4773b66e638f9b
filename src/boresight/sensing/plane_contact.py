"""A tip that touches a plane: its distance from the plane is zero."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from boresight.geometry import Plane
from boresight.kernels.programs import OFFSET
from boresight.sensing.sensor import Readout, Reference, Response, Target, TargetKind
from boresight.units import Quantity


@dataclass(frozen=True, slots=True)
class PlaneContact:
    """The signed distance n·p + f [m] of the tool frame's origin p from the plane it touches: it is always zero.

    Attributes:
        noise_std: standard deviation [m] of that distance when contact is felt.
        repeats: contacts averaged in a row.
    """

    type: ClassVar[str] = "plane_contact"
    channels: ClassVar[tuple[str, ...]] = ("contact",)
    columns: ClassVar[tuple[str, ...]] = ()
    aims_at: ClassVar[TargetKind] = Plane
    readouts: ClassVar[tuple[Readout, ...]] = (Readout(OFFSET),)
    levers: ClassVar[tuple[None, ...]] = (None,)
    numbers: ClassVar[Mapping[str, Quantity]] = MappingProxyType({})

    noise_std: float
    repeats: int = 1

    def adjusted(self, corrections: Mapping[str, float]) -> PlaneContact:
        """Returns the sensor itself: it has no numbers of its own."""
        return self

    def predict(
        self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference
    ) -> Float[np.ndarray, "rows 1"]:
        """Returns the signed distances [m] of the tip from the plane."""
        assert isinstance(target, Plane)
        return target.height(poses[:, :3, 3])[:, None]

    def respond(self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference) -> Response:
        """Returns the distances and their derivatives: a twist (v, w) changes n·p by n·v + (p × n)·w, and so on."""
        assert isinstance(target, Plane)
        p, normal = poses[:, :3, 3], np.broadcast_to(target.normal, (len(poses), 3))
        by_twist = np.hstack([normal, np.cross(p, normal)])
        by_target = np.hstack([p, np.ones((len(p), 1))])
        values = target.height(p)[:, None]
        return Response(values, by_twist[:, None, :], by_target[:, None, :], np.zeros((len(p), 1, 0)))
