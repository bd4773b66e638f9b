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
        precision: of the card's numbers; the processor's are double.
    """

    name: DeviceName = "cpu"
    precision: Precision = "double"

    def __post_init__(self) -> None:
        if self.name == "cpu" and self.precision != "double":
            raise ValueError("single precision is for the card: it needs device cuda")

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
        return f"{self.name}, {self.precision} precision" if self.on_card else self.name


CPU = Device()
