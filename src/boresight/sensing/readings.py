"""What a sensor reported: configurations, values, and how certain each value is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int


@dataclass(frozen=True)
class Readings:
    """Measured values, a row a configuration.

    Attributes:
        joints: (rows, joints) joint readings [rad or m].
        values: (rows, channels) measured values, in the order of the sensor's channels; NaN where configurations
            were only planned and nothing was measured yet.
        std: (rows, channels) standard deviation of each value, as stated.
        target: (rows,) index of the target the sensor pointed at; 0 where it needs none.
        line: (rows,) the line of the file a row came from, for messages.
    """

    joints: Float[np.ndarray, "rows joints"]
    values: Float[np.ndarray, "rows channels"]
    std: Float[np.ndarray, "rows channels"]
    target: Int[np.ndarray, "rows"]
    line: Int[np.ndarray, "rows"]

    def __len__(self) -> int:
        """Number of rows."""
        return len(self.joints)

    @property
    def measured(self) -> bool:
        """Whether there are values, and not configurations alone."""
        return not np.isnan(self.values).any()

    def chosen(self, rows: Int[np.ndarray, "some"] | Bool[np.ndarray, "rows"]) -> Readings:
        """Returns the readings of some rows, by index or mask."""
        return Readings(self.joints[rows], self.values[rows], self.std[rows], self.target[rows], self.line[rows])
