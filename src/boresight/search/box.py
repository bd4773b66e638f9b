"""The box a search stays in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True)
class Box:
    """Lower and upper bounds of every parameter.

    Attributes:
        lower: (parameters,) lower bounds, each below its upper bound.
        upper: (parameters,) upper bounds.
    """

    lower: Float[np.ndarray, "parameters"]
    upper: Float[np.ndarray, "parameters"]

    def __post_init__(self) -> None:
        assert self.lower.shape == self.upper.shape
        assert np.all(self.lower < self.upper), "every lower bound lies below its upper bound"

    def __len__(self) -> int:
        """Number of parameters."""
        return len(self.lower)

    @property
    def width(self) -> Float[np.ndarray, "parameters"]:
        """Upper minus lower bound of every parameter."""
        return self.upper - self.lower
