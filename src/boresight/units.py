"""Units of lengths and angles at the edge; inside, everything is metres and radians."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

LengthUnit = Literal["m", "mm"]
AngleUnit = Literal["rad", "deg"]
Quantity = Literal["length", "angle", "number"]
"""What a parameter measures: a length [m], an angle [rad], or a pure number."""

UNIT_OF: dict[Quantity, str] = {"length": "m", "angle": "rad", "number": "1"}
"""The unit of each quantity inside the package and in its results."""


@dataclass(frozen=True, slots=True)
class Units:
    """The units a file is written in."""

    length: LengthUnit = "m"
    angle: AngleUnit = "rad"

    @property
    def metres(self) -> float:
        """Metres in one unit of length."""
        return 1.0 if self.length == "m" else 1e-3

    @property
    def radians(self) -> float:
        """Radians in one unit of angle."""
        return 1.0 if self.angle == "rad" else math.pi / 180.0

    def scale(self, quantity: Quantity) -> float:
        """Returns the factor from this file's unit to the package's."""
        return {"length": self.metres, "angle": self.radians, "number": 1.0}[quantity]


def in_millimetres(length_m: float) -> str:
    """Returns a length [m] in words a person compares at a glance: mm with three digits that matter."""
    millimetres = length_m * 1e3
    if millimetres == 0.0 or not math.isfinite(millimetres):
        return f"{millimetres:g} mm"
    decimals = max(0, 2 - math.floor(math.log10(abs(millimetres))))
    return f"{millimetres:.{min(decimals, 6)}f} mm"
