"""Plates and frames that are not where, or not what, the files say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from benchmarks.trust.cell import Cell, Plane
from benchmarks.trust.faults.fault import Fault
from benchmarks.trust.kinematics import frame


def wavy(amplitude: float) -> Fault:
    """Returns plates that are not flat [m]."""
    return Fault(("*flat*", "*wav*"), r"flat|wav[ey]", truth=lambda cell, random: replace(cell, waviness=amplitude))


def plate_off(name: str, amount: float) -> Fault:
    """Returns a plate that stands elsewhere along its normal [m]."""

    def truth(cell: Cell, random: np.random.Generator) -> Cell:
        plane = cell.planes[name]
        return replace(cell, planes={**cell.planes, name: Plane(plane.normal, plane.offset + amount * cell.size)})

    return Fault((f"{name}.offset", name), rf"{name}\.offset|`?{name}`?.*(offset|stands)", truth=truth)


def plate_tilted(name: str, angle: float) -> Fault:
    """Returns a plate that is turned about a point in front of the arm, about a drawn axis in it [rad]."""

    def truth(cell: Cell, random: np.random.Generator) -> Cell:
        plane = cell.planes[name]
        point = -plane.offset * plane.normal
        axis = np.cross(plane.normal, random.normal(size=3))
        normal = plane.normal + np.tan(angle) * axis / np.linalg.norm(axis)
        normal = normal / np.linalg.norm(normal)
        return replace(cell, planes={**cell.planes, name: Plane(normal, float(-normal @ point))})

    return Fault((f"{name}.normal*", name), rf"{name}\.normal|`?{name}`?.*(normal|tilt)", truth=truth)


def normal_flipped(name: str) -> Fault:
    """Returns files in which a plane's normal has the other sign, and its offset has not."""
    return _stated_plane(name, lambda plane: Plane(-plane.normal, plane.offset))


def offset_flipped(name: str) -> Fault:
    """Returns files in which a plane's offset has the other sign."""
    return _stated_plane(name, lambda plane: Plane(plane.normal, -plane.offset))


def _stated_plane(name: str, change: Callable[[Plane], Plane]) -> Fault:
    def stated(cell: Cell) -> Cell:
        return replace(cell, planes={**cell.planes, name: change(cell.planes[name])})

    return Fault(
        (f"{name} flipped", f"{name}.offset", f"{name}.normal*"),
        rf"{name}\b.*(flip|sign|offset|normal)|look away from their planes",
        stated=stated,
    )


def base_off(length: float, angle: float) -> Fault:
    """Returns an arm that stands elsewhere than its base is said to, each number by a draw of this size [m, rad]."""

    def truth(cell: Cell, random: np.random.Generator) -> Cell:
        off = frame(tuple(random.normal(0.0, length, 3)), tuple(random.normal(0.0, angle, 3)))
        return replace(cell, base=cell.base @ off)

    return Fault(("base", "base.*"), r"\bbase\b", truth=truth)


def mount_off(length: float, angle: float) -> Fault:
    """Returns a sensor that sits elsewhere than its mount is said to, each number by a draw of this size [m, rad]."""

    def truth(cell: Cell, random: np.random.Generator) -> Cell:
        off = frame(tuple(random.normal(0.0, length, 3)), tuple(random.normal(0.0, angle, 3)))
        return replace(cell, mount=cell.mount @ off)

    return Fault(("mount", "mount.*"), r"\bmount\b", truth=truth)


def base_tilted(angle: float) -> Fault:
    """Returns a first axis that is tilted against the frame that base is stated in [rad]."""
    return Fault(
        ("base", "base.*"),
        r"\bbase\b",
        truth=lambda cell, random: replace(cell, base=cell.base @ frame(rpy=(angle, 0.7 * angle, 0.0))),
    )
