"""The direction that no range can see: the base turned about z0, and the plane turned with it.

For T' = Rz(φ) T and n' = Rz(φ) n, f' = f, every range h = -(f + n·p) / (n·b) is the same, whatever φ. In the paper's
parameters φ is `j1.theta`, and n turns by `normal_x` (n_y follows): 26 parameters have rank 25.
"""

from __future__ import annotations

import math

import numpy as np
from jaxtyping import Float

from boresight.geometry.rotations import axis_rotation

Poses = Float[np.ndarray, "rows 4 4"]


def turned_about_base(poses: Poses, angle_rad: float) -> Poses:
    """Returns poses turned about the base's z axis."""
    turned = poses.copy()
    turned[:, :3] = axis_rotation(2, angle_rad) @ poses[:, :3]
    return turned


def azimuth_between(found: Poses, real: Poses) -> float:
    """Returns the turn about the base's z [rad] that brings the found positions nearest to the real ones.

    In closed form: it minimises the sum of squared distances, Σ |Rz(φ) p - p'|².
    """
    p, q = found[:, :2, 3], real[:, :2, 3]
    sine = np.sum(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0])
    return math.atan2(float(sine), float(np.sum(p * q)))


def without_azimuth(found: Poses, real: Poses) -> Poses:
    """Returns the found poses with the one turn removed that the ranges say nothing about."""
    return turned_about_base(found, azimuth_between(found, real))
