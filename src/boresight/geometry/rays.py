"""Where a beam meets a plane."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from boresight.geometry.planes import Plane


def range_to_plane(
    origin: Float[np.ndarray, "*batch 3"], direction: Float[np.ndarray, "*batch 3"], plane: Plane
) -> Float[np.ndarray, "*batch"]:
    """Returns the distance [m] along unit beams to a plane (paper, eq. 9); NaN where a beam looks away."""
    height = plane.height(origin)
    approach = direction @ np.asarray(plane.normal)
    hits = height * approach < 0.0
    return np.where(hits, -height / np.where(hits, approach, 1.0), np.nan)
