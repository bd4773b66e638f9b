"""A tracker of six degrees of freedom: where the tool frame is and how it is turned, in the world."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from boresight.geometry import rotation_vector, vector_slope
from boresight.kernels.programs import COMPONENT, OFFSET
from boresight.sensing.position import shifts_by_twist
from boresight.sensing.sensor import Readout, Reference, Response, Target, TargetKind
from boresight.units import Quantity


@dataclass(frozen=True, slots=True)
class Pose:
    """The tool frame's origin (x, y, z) and the turn from its measured to its predicted orientation, all in m.

    The turn is the rotation vector of R_measured' R_predicted, times `lever`; it is zero where they agree, so its
    measured value always is. In the compiled search, which has no measured orientation to turn back by, the nine
    components of R stand in for it: for a turn by φ their squared differences sum to 8 sin²(φ/2), twice φ² for a small
    one.

    Attributes:
        noise_std: standard deviation of one reading of each coordinate [m].
        noise_angle_std: standard deviation of one reading of the orientation about each axis [rad].
        repeats: readings averaged in a row.
        scale: relative error of its unit of length: (x, y, z) are read times 1 + scale.
    """

    type: ClassVar[str] = "pose"
    channels: ClassVar[tuple[str, ...]] = ("x", "y", "z", "turn_x", "turn_y", "turn_z")
    columns: ClassVar[tuple[str, ...]] = ("x", "y", "z", "qw", "qx", "qy", "qz")
    aims_at: ClassVar[TargetKind] = None
    numbers: ClassVar[Mapping[str, Quantity]] = MappingProxyType({"scale": "number"})

    noise_std: float
    noise_angle_std: float
    repeats: int = 1
    scale: float = 0.0

    @property
    def lever(self) -> float:
        """The length [m] of the lever on which angles are as noisy as lengths."""
        return self.noise_std / self.noise_angle_std

    @property
    def levers(self) -> tuple[float | None, ...]:
        """None for each coordinate, then the lever for each turn."""
        return (None, None, None, self.lever, self.lever, self.lever)

    @property
    def readouts(self) -> tuple[Readout, ...]:
        """The three coordinates, and each component of the three world axes as the tool sees them."""
        shifts = tuple(Readout(OFFSET, axis, axis) for axis in range(3))
        half_square = 0.5 * self.lever**2
        return shifts + tuple(Readout(COMPONENT + k, 3 + k, axis, half_square) for axis in range(3) for k in range(3))

    def adjusted(self, corrections: Mapping[str, float]) -> Pose:
        """Returns the tracker with a correction added to its `scale`."""
        return replace(self, scale=self.scale + corrections.get("scale", 0.0))

    def predict(
        self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference
    ) -> Float[np.ndarray, "rows 6"]:
        """Returns the tool's position and its turn away from the measured orientation [m]."""
        return np.hstack([(1.0 + self.scale) * poses[:, :3, 3], self.lever * _turn(poses, reference)])

    def respond(self, poses: Float[np.ndarray, "rows 4 4"], target: Target | None, reference: Reference) -> Response:
        """Returns positions and turns with their derivatives: a twist (v, w) turns R_measured' R by R_measured' w."""
        p, turn = poses[:, :3, 3], _turn(poses, reference)
        by_twist = np.zeros((len(p), 6, 6))
        by_twist[:, :3] = (1.0 + self.scale) * shifts_by_twist(p)
        by_twist[:, 3:, 3:] = self.lever * vector_slope(turn) @ np.swapaxes(reference[:, :3, :3], 1, 2)
        by_sensor = np.hstack([p, np.zeros_like(p)])[:, :, None]
        values = np.hstack([(1.0 + self.scale) * p, self.lever * turn])
        return Response(values, by_twist, np.zeros((len(p), 6, 0)), by_sensor)


def _turn(poses: Float[np.ndarray, "rows 4 4"], reference: Reference) -> Float[np.ndarray, "rows 3"]:
    """Returns the rotation vectors [rad] from measured to predicted orientations, in the measured tool's axes."""
    return rotation_vector(np.swapaxes(reference[:, :3, :3], 1, 2) @ poses[:, :3, :3])
