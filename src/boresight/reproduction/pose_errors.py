"""How far the tool is from where it is thought to be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.geometry import rotation_angle


@dataclass(frozen=True)
class PoseErrors:
    """Errors of the tool's pose at some configurations.

    Attributes:
        position_mm: (rows,) lengths of the position errors.
        orientation_mrad: (rows,) angles of the orientation errors. The paper takes the root of the sum of three squared
            components, which for small angles is the same.
    """

    position_mm: Float[np.ndarray, "rows"]
    orientation_mrad: Float[np.ndarray, "rows"]

    @classmethod
    def between(cls, found: Float[np.ndarray, "rows 4 4"], real: Float[np.ndarray, "rows 4 4"]) -> PoseErrors:
        """Returns the errors of found poses."""
        shift = np.linalg.norm(found[:, :3, 3] - real[:, :3, 3], axis=1)
        return cls(1e3 * shift, 1e3 * rotation_angle(found[:, :3, :3], real[:, :3, :3]))

    @property
    def position_rms_mm(self) -> float:
        """Root mean square of the position errors."""
        return rms(self.position_mm)

    @property
    def orientation_rms_mrad(self) -> float:
        """Root mean square of the orientation errors."""
        return rms(self.orientation_mrad)


def rms(values: Float[np.ndarray, "rows"]) -> float:
    """Returns the root of the mean square."""
    return float(np.sqrt(np.mean(values**2)))
