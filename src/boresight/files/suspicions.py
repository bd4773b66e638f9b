"""What looks odd in readings that can be read: copies, joints beyond their limits, the wrong unit of angle."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np

from boresight.arm import Joint
from boresight.errors import InputError
from boresight.files.plausible_units import beyond_limits, fits_as_degrees
from boresight.files.problems import printable
from boresight.sensing import Cell, Readings
from boresight.units import Units

_TWO_TURNS = 4.0 * math.pi
"""No revolute joint reads more than this [rad]; in degrees almost every one does."""

_ENOUGH_ROWS = 10
"""With fewer rows, angles that are all small may simply be small."""

_LINES_NAMED = 6

_FAR_BEYOND = 20.0
"""A slide's reading beyond its limits by so many times their size [1] is no careless limit."""


def suspicions(readings: Readings, cell: Cell, units: Units, name: str) -> tuple[str, ...]:
    """Returns what looks odd about the readings of a file, a sentence each.

    Raises:
        InputError: joints are in degrees where radians were said, or a slide's are a thousandfold.
    """
    _check_slides(readings, cell, units, name)
    copies = _copies(readings, name)
    angles = _wrong_angles(readings, cell, units, name)
    # In the wrong unit every joint is beyond its limits: one sentence says it better than six.
    beyond = [] if angles else _beyond_limits(readings, cell, units, name)
    still = _never_turns(readings, name)
    return tuple(printable(warning) for warning in (*copies, *angles, *beyond, *still))


def _never_turns(readings: Readings, name: str) -> list[str]:
    """Poses that are all turned alike, as from a tracker that reports positions alone."""
    poses = readings.reference
    if poses is None or len(readings) < 2 or not np.ptp(readings.joints, axis=0).any():
        return []
    if np.ptp(poses, axis=0).max() > 1e-9:
        return []
    return [
        f"{name}: every pose has the same orientation though the joints move; if the tracker measures positions alone, "
        "say sensor: {type: position} in the campaign"
    ]


def _copies(readings: Readings, name: str) -> list[str]:
    """Rows that are the same to the bit."""
    rows = np.column_stack([readings.joints, readings.values, readings.target])
    # A key a row, in which copies agree: of a million rows nearly all are done with once the keys are sorted.
    factors = np.random.default_rng(0).integers(2**64, size=rows.shape[1], dtype=np.uint64)
    keys = rows.view(np.uint64) @ factors
    _, inverse, found = np.unique(keys, return_inverse=True, return_counts=True)
    candidates = np.flatnonzero(found[inverse] > 1)
    exact = [rows[row].tobytes() for row in candidates]
    counts = Counter(exact)
    copies = len(exact) - len(counts)
    if not copies:
        return []
    lines = [str(readings.line[row]) for row, key in zip(candidates, exact, strict=True) if counts[key] > 1]
    more = f" and {len(lines) - _LINES_NAMED} more" if len(lines) > _LINES_NAMED else ""
    named = f"{', '.join(lines[:_LINES_NAMED])}{more}"
    return [
        f"{name}: {copies} {'row is an exact copy' if copies == 1 else 'rows are exact copies'} of others "
        f"(lines {named}); all are kept and count as separate readings"
    ]


def _wrong_angles(readings: Readings, cell: Cell, units: Units, name: str) -> list[str]:
    turning = np.array([joint.type == "revolute" for joint in cell.arm.driven])
    if not turning.any():
        return []
    size = np.abs(readings.joints[:, turning]).max(axis=0)
    joint = np.array(cell.arm.joint_names)[turning][size.argmax()]
    if units.angle == "rad" and fits_as_degrees(readings.joints[:, turning], cell.arm.limits[turning]):
        raise InputError(
            printable(
                f"{name}: joint {joint} reads up to {size.max():.4g}, too much for radians and within its limits as "
                "degrees: say units: {angle: deg} in the campaign"
            )
        )
    if units.angle == "rad" and size.max() > _TWO_TURNS:
        return [
            f"{name}: joint {joint} reads up to {size.max():.4g}, too much for radians: "
            "if the file is in degrees, say units: {angle: deg} in the campaign"
        ]
    in_file = size / units.radians
    if units.angle == "deg" and len(readings) >= _ENOUGH_ROWS and 0.0 < in_file.max() <= 2.0 * math.pi:
        return [
            f"{name}: no joint reads more than {in_file.max():.4g} degrees: "
            "if the file is in radians, say units: {angle: rad} in the campaign"
        ]
    return []


def _check_slides(readings: Readings, cell: Cell, units: Units, name: str) -> None:
    """Raises an `InputError` where a slide is far beyond its limits, and within them were it in millimetres."""
    within = beyond_limits(1e-3 * readings.joints, cell.arm.limits).max(axis=0) <= 0.0
    for place, joint in enumerate(cell.arm.driven):
        size = float(np.abs(readings.joints[:, place]).max())
        if joint.type == "prismatic" and within[place] and size > _FAR_BEYOND * max(map(abs, joint.limits)):
            low, high = (limit / units.metres for limit in joint.limits)
            raise InputError(
                printable(
                    f"{name}: joint {joint.name} reads up to {size / units.metres:.6g} {units.length}, far beyond its "
                    f"limits {low:.6g} to {high:.6g} {units.length}, and a thousandth of it is within them: is the "
                    f"column in another unit? Call it `{joint.name} [mm]` if it is in millimetres"
                )
            )


def _beyond_limits(readings: Readings, cell: Cell, units: Units, name: str) -> list[str]:
    excess = beyond_limits(readings.joints, cell.arm.limits)
    rows, joints = excess.argmax(axis=0), range(len(cell.arm.driven))
    counts = (excess > 1e-9).sum(axis=0)  # a limit of 170 degrees does not survive the way to radians to the bit
    return [
        _beyond(cell.arm.driven[j], readings.joints[rows[j], j], readings.line[rows[j]], counts[j], units, name)
        for j in joints
        if counts[j]
    ]


def _beyond(joint: Joint, worst: float, line: int, count: int, units: Units, name: str) -> str:
    scale, unit = (units.radians, units.angle) if joint.type == "revolute" else (units.metres, units.length)
    low, high = (limit / scale for limit in joint.limits)
    others = f" ({count} rows in all)" if count > 1 else ""
    return (
        f"{name}: joint {joint.name} reads {worst / scale:.6g} {unit} on line {line}, "
        f"beyond its limits {low:.6g} to {high:.6g} {unit}{others}"
    )
