"""Where a search runs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

DeviceName = Literal["cpu", "cuda"]
Precision = Literal["double", "single"]


@dataclass(frozen=True, slots=True)
class Device:
    """Where an evolution runs, and in what numbers.

    Attributes:
        name: this machine's processor, or its NVIDIA card.
        precision: of its numbers; least squares, which follows, is in double precision in any case.
    """

    name: DeviceName = "cpu"
    precision: Precision = "double"

    @property
    def on_card(self) -> bool:
        """Whether it is the card."""
        return self.name == "cuda"

    @property
    def real(self) -> type[np.floating[Any]]:
        """The type of its numbers."""
        return np.float64 if self.precision == "double" else np.float32

    def __str__(self) -> str:
        """Returns it in words."""
        return self.name if self == CPU else f"{self.name}, {self.precision} precision"


CPU = Device()
