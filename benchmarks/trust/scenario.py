"""What a scenario is: an arm, plates, what is known of them, a sensor, and what is wrong."""

from __future__ import annotations

from dataclasses import dataclass

from benchmarks.trust.cell import Plane
from benchmarks.trust.configurations import Beams
from benchmarks.trust.faults.fault import NONE, Fault
from benchmarks.trust.truth import USUAL, Errors

TILTED = {
    "deck": Plane.of((0.0, 1.0, 4.6), -0.69),
    "wall_x": Plane.of((-1.0, 0.15, 0.2), 1.6),
    "wall_y": Plane.of((0.1, -1.0, 0.15), 1.7),
}
"""Plates that no axis of an arm stands upright on."""

LEVEL = {"floor": Plane.of((0.0, 0.0, 1.0), 0.0), "wall": Plane.of((-1.0, 0.0, 0.0), 1.4)}
"""Plates that an arm's first axis stands upright on, or runs along: they hide parameters."""


@dataclass(frozen=True)
class Scenario:
    """A kind of campaign; everything in it is drawn afresh for each seed.

    Attributes:
        name: in words, unique.
        arm: name in `ARMS`.
        size: what its lengths are multiplied by.
        planes: how many plates.
        level: whether they are `LEVEL` rather than `TILTED`.
        estimated: whether plates are only roughly where they are stated, and the campaign frees them; it then fixes
            j1.theta and j1.d, which define the base frame.
        unknown: which of base and mount nobody has measured.
        sensor: `laser_ranger` (0.2 mm, the mean of ten) or `position` (0.05 mm).
        rows, validation: how many; no validation file with 0.
        postures: how many configurations the rows are taken at; all different by default.
        errors: of the nominal arm.
        stated: stated over true noise.
        beams: which are measured with.
        fixed: parameters that the campaign fixes, and that are exact but for the fault.
        fault: what is wrong.
    """

    name: str
    arm: str = "space arm"
    size: float = 1.0
    planes: int = 3
    level: bool = False
    estimated: bool = False
    unknown: tuple[str, ...] = ()
    sensor: str = "laser_ranger"
    rows: int = 100
    validation: int = 40
    postures: int | None = None
    errors: Errors = USUAL
    stated: float = 1.0
    beams: Beams = Beams()
    fixed: tuple[str, ...] = ()
    fault: Fault = NONE

    @property
    def noise(self) -> tuple[float, int]:
        """True standard deviation of one reading [m], and how many are averaged."""
        return (0.0002, 10) if self.sensor == "laser_ranger" else (0.00005, 1)

    @property
    def exact(self) -> tuple[str, ...]:
        """Parameters without an error of their own."""
        return self.fixed + (("j1.theta", "j1.d") if self.estimated else ())
