"""What turns a joint beside its reading: harmonics of gears and encoders, and gravity.

Eccentric gears and code discs turn a joint by a wave of its own angle, once a turn and twice a turn, which is how
they are eccentric and oval: `cos1`, `sin1`, `cos2`, `sin2` [rad] of the joint's reading. Gravity turns a joint that
gives way: `sag3` [rad] of the lever of link 3 (`boresight.arm.levers`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.arm.motions import Motion

HARMONICS = ("cos1", "sin1", "cos2", "sin2")
"""The waves of a joint's own angle."""

SAG = "sag"
"""What a joint's yielding is called, the number of the link after it."""


def is_further(parameter: str) -> bool:
    """Returns whether a parameter, by full name, turns a joint beside its reading."""
    number = parameter.rpartition(".")[2]
    return number in HARMONICS or number.startswith(SAG)


@dataclass(frozen=True, slots=True)
class Harmonic:
    """A wave of a joint's reading.

    Attributes:
        joint: the column of the joint readings.
        order: waves a turn.
        sine: a sine if true, else a cosine.
    """

    joint: int
    order: int
    sine: bool
    link: None = None

    def of(
        self, joints: Float[np.ndarray, "rows joints"], moments: Float[np.ndarray, "rows joints links"] | None
    ) -> Float[np.ndarray, "rows"]:
        """Returns the wave's height for every row."""
        angle = self.order * joints[:, self.joint]
        return np.sin(angle) if self.sine else np.cos(angle)


@dataclass(frozen=True, slots=True)
class Lever:
    """The lever of a link about a joint.

    Attributes:
        joint: the column of the joint readings.
        link: the link's place, from 0.
    """

    joint: int
    link: int

    def of(
        self, joints: Float[np.ndarray, "rows joints"], moments: Float[np.ndarray, "rows joints links"] | None
    ) -> Float[np.ndarray, "rows"]:
        """Returns the moment [m] of a unit weight at the link's end for every row."""
        assert moments is not None
        return moments[:, self.joint, self.link]


def harmonic_motions(joint: int, name: str, heights: tuple[float, ...]) -> tuple[Motion, ...]:
    """Returns the turns about a joint's z of its four waves [rad], in the order of `HARMONICS`."""
    return tuple(
        Motion(True, 2, height, f"{name}.{wave}", factor=Harmonic(joint, int(wave[-1]), wave.startswith("sin")))
        for wave, height in zip(HARMONICS, heights, strict=True)
    )


def sag_motions(joint: int, name: str, sag: tuple[tuple[int, float], ...]) -> tuple[Motion, ...]:
    """Returns the turns about a joint's z under links, by number from 1, each with its turn [rad] for a metre out."""
    return tuple(Motion(True, 2, turn, f"{name}.{SAG}{link}", factor=Lever(joint, link - 1)) for link, turn in sag)
