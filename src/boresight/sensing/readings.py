"""What was reported: configurations, values, and how certain each value is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int


@dataclass(frozen=True)
class Readings:
    """Measured values, a row a configuration.

    Where sensors of one campaign have different numbers of channels, rows are as wide as the widest; a value that
    its row's sensor does not have is 0 and has an infinite standard deviation, and counts for nothing anywhere.

    Attributes:
        joints: (rows, joints) joint readings [rad or m].
        values: (rows, channels) measured values [m], in the order of the sensor's channels; NaN where configurations
            were only planned and nothing was measured yet.
        std: (rows, channels) standard deviation of each value [m], as stated.
        target: (rows,) how a row was taken: the index of its aim, which is that of its target where one sensor is
            aimed at several.
        line: (rows,) the line of the file a row came from, for messages.
        reference: (rows, 3, 3) measured orientations, the identity where there is none; None where no row has one.
        session: (rows,) names of the blocks that rows belong to; None where nobody told.
        since: (rows, joints) the other configuration of a distance between two, the row's own where it is of another
            sensor; None where no row is one.
    """

    joints: Float[np.ndarray, "rows joints"]
    values: Float[np.ndarray, "rows channels"]
    std: Float[np.ndarray, "rows channels"]
    target: Int[np.ndarray, "rows"]
    line: Int[np.ndarray, "rows"]
    reference: Float[np.ndarray, "rows 3 3"] | None = None
    session: np.ndarray | None = None
    since: Float[np.ndarray, "rows joints"] | None = None

    def __len__(self) -> int:
        """Number of rows."""
        return len(self.joints)

    @property
    def measured(self) -> bool:
        """Whether there are values, and not configurations alone."""
        return not np.isnan(self.values).any()

    @cached_property
    def read(self) -> Bool[np.ndarray, "rows channels"]:
        """Which values their rows' sensors have."""
        return np.isfinite(self.std)

    @property
    def count(self) -> int:
        """Number of values that were read."""
        return int(np.count_nonzero(self.read))

    @cached_property
    def channels(self) -> Int[np.ndarray, "rows"]:
        """How many values each row has."""
        return np.count_nonzero(self.read, axis=1)

    @property
    def usual_std(self) -> float:
        """The median stated standard deviation of a value [m]."""
        return float(np.median(self.std[self.read]))

    @property
    def usual_row_std(self) -> float:
        """The median over rows of the length of a row's stated standard deviations [m]."""
        return float(np.median(np.linalg.norm(np.where(self.read, self.std, 0.0), axis=1)))

    def chosen(self, rows: Int[np.ndarray, "some"] | Bool[np.ndarray, "rows"] | slice) -> Readings:
        """Returns the readings of some rows, by index, mask or slice."""
        reference = None if self.reference is None else self.reference[rows]
        session = None if self.session is None else self.session[rows]
        return Readings(
            self.joints[rows],
            self.values[rows],
            self.std[rows],
            self.target[rows],
            self.line[rows],
            reference,
            session,
            None if self.since is None else self.since[rows],
        )
