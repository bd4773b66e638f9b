"""Points fixed in the world, and the three numbers that can be wrong about one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from boresight.geometry.frames import Triple
from boresight.units import Quantity

_AXES = "xyz"


@dataclass(frozen=True)
class Point:
    """A point in the world.

    Attributes:
        xyz: where it is [m].
    """

    xyz: Triple

    @property
    def numbers(self) -> tuple[tuple[str, Quantity], ...]:
        """The names of the three numbers that can be corrected, and what they measure."""
        return tuple((axis, "length") for axis in _AXES)

    @property
    def values(self) -> dict[str, float]:
        """The point's numbers [m] by name."""
        return dict(zip(_AXES, self.xyz, strict=True))

    def corrected(self, corrections: Sequence[float]) -> Point:
        """Returns the point with corrections [m] added, in the order of `numbers`."""
        x, y, z = (float(a + b) for a, b in zip(self.xyz, corrections, strict=True))
        return Point((x, y, z))

    @cached_property
    def derivative(self) -> Float[np.ndarray, "3 3"]:
        """d(x, y, z) by d(`numbers`)."""
        return np.eye(3)
