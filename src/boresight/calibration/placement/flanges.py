"""Where the flange was in each row, whatever it carries."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from boresight.geometry import inverse
from boresight.sensing import Cell, Readings


def flanges(cell: Cell, readings: Readings) -> Float[np.ndarray, "rows 4 4"]:
    """Returns `T_world_flange` of each row, geometry and base as the cell has them."""
    behind = np.array([inverse(cell.mounts[aim.mount].matrix) for aim in cell.aims]).reshape(-1, 4, 4)
    return np.asarray(cell.poses(readings.joints, target=readings.target) @ behind[readings.target])
