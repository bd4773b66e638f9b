"""Planes n·x + f = 0 with unit normal (paper, eq. 7), and the three numbers that can be wrong about one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from boresight.units import Quantity

FLAT = 0.2
"""Below this |n_y|, n_y is kept and the largest of n_x and n_z follows from |n| = 1 instead; the paper's plane
has 0.212. A small component cannot follow: errors of the others would be magnified by its inverse."""

_STEEPEST = 1e-3

_AXES = "xyz"


@dataclass(frozen=True)
class Plane:
    """The plane n·x + f = 0, |n| = 1, n_z > 0 (else n_y > 0, else n_x > 0).

    Attributes:
        normal: (n_x, n_y, n_z), unit length.
        offset: f [m]; the plane passes |f| from the origin.
        dropped: the component (0, 1, 2) that follows from the other two when they are corrected.
    """

    normal: tuple[float, float, float]
    offset: float
    dropped: int = 1

    @classmethod
    def of(cls, normal: tuple[float, float, float], offset: float) -> Plane:
        """Returns the plane of any multiple of (n, f), normalised; (23) is (0, 1, 4.6), -0.69.

        The dropped component is y, as in the paper, unless |n_y| is below `FLAT`: then it is the largest.

        Raises:
            ValueError: the normal is zero or not finite.
        """
        length = math.hypot(*normal)
        if not (math.isfinite(length) and length > 1e-12 and math.isfinite(offset)):
            raise ValueError(f"a plane's normal must be finite and not zero, got {normal} with offset {offset}")
        x, y, z = (component / length for component in normal)
        sign = next((math.copysign(1.0, c) for c in (z, y, x) if abs(c) > 1e-12), 1.0)
        dropped = 1 if abs(y) > FLAT else (0 if abs(x) > abs(z) else 2)
        return cls((sign * x, sign * y, sign * z), sign * offset / length, dropped)

    @property
    def free_components(self) -> tuple[int, int]:
        """The two components of the normal that can be corrected."""
        first, second = (axis for axis in range(3) if axis != self.dropped)
        return first, second

    @property
    def numbers(self) -> tuple[tuple[str, Quantity], ...]:
        """The names of the three numbers that can be corrected, and what they measure."""
        first, second = (_AXES[axis] for axis in self.free_components)
        return (f"normal_{first}", "number"), (f"normal_{second}", "number"), ("offset", "length")

    @property
    def values(self) -> dict[str, float]:
        """The plane's four numbers by name, the offset in m."""
        return {f"normal_{axis}": n for axis, n in zip(_AXES, self.normal, strict=True)} | {"offset": self.offset}

    def corrected(self, corrections: Sequence[float]) -> Plane:
        """Returns the plane with corrections added, in the order of `numbers` (paper, eq. 19)."""
        first, second, offset = (float(correction) for correction in corrections)
        return self.moved((first, second), offset)

    def moved(self, normal: tuple[float, float], offset: float) -> Plane:
        """Returns the plane with its two free components and its offset [m] corrected (paper, eq. 19)."""
        n = list(self.normal)
        for axis, correction in zip(self.free_components, normal, strict=True):
            n[axis] += correction
        i, j = self.free_components
        squares = n[i] ** 2 + n[j] ** 2
        scale = 1.0 / math.sqrt(max(squares, 1.0))
        n[i], n[j] = n[i] * scale, n[j] * scale
        n[self.dropped] = math.copysign(math.sqrt(max(1.0 - squares, 0.0)), self.normal[self.dropped])
        return Plane((n[0], n[1], n[2]), self.offset + offset, self.dropped)

    @cached_property
    def derivative(self) -> Float[np.ndarray, "4 3"]:
        """d(n_x, n_y, n_z, f) by d(first free component, second, offset), at this plane."""
        derivative = np.zeros((4, 3))
        dropped = math.copysign(max(abs(self.normal[self.dropped]), _STEEPEST), self.normal[self.dropped])
        for column, axis in enumerate(self.free_components):
            derivative[axis, column] = 1.0
            derivative[self.dropped, column] = -self.normal[axis] / dropped
        derivative[3, 2] = 1.0
        return derivative

    def height(self, points: Float[np.ndarray, "*batch 3"]) -> Float[np.ndarray, "*batch"]:
        """Returns the signed distance [m] of points from the plane, positive on the normal's side."""
        return np.asarray(points @ np.asarray(self.normal) + self.offset)
