"""Whether an arm's and a tool's numbers can be meant in the units they are read in, before any fit.

A number in another unit is a thousand times too large or too small, or 57 times. No fit recovers from that, and none is
tried: the file and the key are named. Bounds are wide, so that every cell that can be built passes: arms from
centimetres to tens of metres, rails, tools as long as the arm.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.files.extents import Extent
from boresight.files.problems import Problems
from boresight.sensing import Cell
from boresight.units import Units

SMALLEST_ARM_M, LARGEST_ARM_M = 0.01, 90.0
"""Least reach [m] of the arms that are believed, slides and all, and greatest of their links alone."""

ALONE_M, ALONE = 25.0, 30.0
"""A link longer than this [m], and than so many times all others and the slides' travel together, is in another
unit."""

TOOL = 20.0
"""A tool is not longer than so many times the arm's reach."""

TURN = 2.0 * math.pi + 0.02
"""No number of a link turns further [rad]."""

RIGHT_ANGLES, NEARLY = (0.5 * math.pi, math.pi), 2e-4
"""Degrees within this share of 1.5708 or 3.1416 are right angles in radians."""

NAMES = {"m": "metres", "mm": "millimetres", "rad": "radians", "deg": "degrees"}


@dataclass(frozen=True)
class Robot:
    """What the user calls the robot's file, and the units its numbers are in.

    Attributes:
        name: of the file.
        units: of a robot.yaml; None of a URDF or an arm of the catalogue, which are in metres and radians.
    """

    name: str
    units: Units | None


def check_arm(cell: Cell, extent: Extent, robot: Robot, campaign: str, problems: Problems) -> None:
    """Adds a fault where the arm's or the tool's numbers cannot be meant in their units.

    Args:
        cell: the nominal cell [m, rad].
        extent: of its arm.
        robot: its file.
        campaign: what the user calls the campaign's file.
        problems: where faults are added.
    """
    angle, length = _angle_fault(cell, robot), _length_fault(cell, extent, robot)
    problems.extend(fault for fault in (angle, length) if fault is not None)
    for name, frame in cell.mounts.items() if length is None else ():
        size = math.hypot(*frame.xyz)
        if size > max(TOOL * extent.whole, 1.0):
            problems.add(
                f"{campaign}: {name}.xyz: the sensor sits {size:.4g} m from the flange of an arm that reaches "
                f"{extent.whole:.3g} m; is it in another unit than `units:` says?"
            )


def fits_as_degrees(joints: Float[np.ndarray, "rows joints"], limits: Float[np.ndarray, "joints 2"]) -> bool:
    """Returns whether turning joints [rad] far beyond their limits would all be within them were they degrees."""
    degrees = np.radians(joints)
    return bool(beyond_limits(joints, limits).max() > math.pi and beyond_limits(degrees, limits).max() <= 0.0)


def beyond_limits(
    joints: Float[np.ndarray, "rows joints"], limits: Float[np.ndarray, "joints 2"]
) -> Float[np.ndarray, "rows joints"]:
    """Returns how far readings are beyond their limits [rad or m]; negative within."""
    return np.maximum(limits[:, 0] - joints, joints - limits[:, 1])


def _angle_fault(cell: Cell, robot: Robot) -> str | None:
    """Returns what is wrong with the first angle that cannot be meant in its unit."""
    units = robot.units or Units()
    for name, value in _angles(cell):
        written = value / units.radians
        if units.angle == "rad" and abs(value) > TURN:
            return (
                f"{robot.name}: {name}: got {written:.6g} radians, more than a turn; is it in degrees? "
                f"{_say(robot, 'angle: deg')}"
            )
        if units.angle == "deg" and any(abs(abs(written) - right) < NEARLY * right for right in RIGHT_ANGLES):
            return (
                f"{robot.name}: {name}: got {written:.6g} degrees, which is a right angle in radians; expected "
                f"{math.degrees(written):.6g}, or units: {{angle: rad}} where all angles are in radians"
            )
    return None


def _length_fault(cell: Cell, extent: Extent, robot: Robot) -> str | None:
    """Returns what is wrong with the arm's lengths, if they cannot be meant in their unit."""
    units = robot.units or Units()
    links = dict(_links(cell))
    longest = max(links, key=lambda name: links[name])
    others = sum(links.values()) - links[longest]
    # A boom or an offset as long as the travel of the slides beside it is what cranes and rails have.
    alone = others > 0.0 and links[longest] > max(ALONE_M, ALONE * (others + extent.travel))
    if extent.whole >= SMALLEST_ARM_M and extent.links <= LARGEST_ARM_M and not alone:
        return None
    if links[longest] > max(ALONE_M, ALONE * others):
        return (
            f"{robot.name}: {longest}: got {links[longest] / units.metres:.6g} {units.length}, "
            f"{links[longest] / max(others, 1e-3):,.0f} times all other links together; is it in another unit than the "
            "rest?"
        )
    large = extent.links > LARGEST_ARM_M
    reach, other = (extent.links, "mm") if large else (extent.whole, "m")
    return (
        f"{robot.name}: d and a, read in {NAMES[units.length]}, make an arm that reaches {reach:.4g} m; are they in "
        f"{NAMES[other]}? {_say(robot, f'length: {other}')}"
    )


def _angles(cell: Cell) -> Iterator[tuple[str, float]]:
    for joint in cell.arm.joints:
        for number in ("alpha", "theta", "beta"):
            yield f"{joint.name}.{number}", float(getattr(joint, number))


def _links(cell: Cell) -> Iterator[tuple[str, float]]:
    for joint in cell.arm.joints:
        for number in ("a", "d"):
            yield f"{joint.name}.{number}", abs(float(getattr(joint, number)))
    for name, frame in (("root.xyz", cell.arm.root), ("tip.xyz", cell.arm.tip)):
        yield name, math.hypot(*frame.xyz)


def _say(robot: Robot, unit: str) -> str:
    return "A URDF is in metres and radians" if robot.units is None else f"Say units: {{{unit}}} in that file"
