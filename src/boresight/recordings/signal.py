"""A value over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True)
class Signal:
    """Samples in order of time, each time once.

    Attributes:
        time: (samples,) [s].
        values: (samples, channels).
    """

    time: Float[np.ndarray, " samples"]
    values: Float[np.ndarray, "samples channels"]

    @classmethod
    def of(cls, time: Float[np.ndarray, " samples"], values: Float[np.ndarray, "samples channels"]) -> Signal:
        """Returns a signal of samples in any order; of several at one time, the last that came counts."""
        # From the back, since unique keeps the first.
        kept, first = np.unique(time[::-1], return_index=True)
        return cls(kept, values[::-1][first])

    def __len__(self) -> int:
        """Number of samples."""
        return len(self.time)

    def between(self, start: float, end: float) -> slice:
        """Returns the samples from one time to another."""
        return slice(int(np.searchsorted(self.time, start)), int(np.searchsorted(self.time, end, side="right")))
