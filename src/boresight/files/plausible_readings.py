"""Whether readings can be meant in the units they are read in: held against the arm and its targets, before any fit.

Of each file the likeliest fault is told, with its columns or the key of the campaign that they do not go with. Bounds
are wide: plates and trackers may be far away, a range may be short.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from boresight.files.extents import Extent
from boresight.files.plausible_units import SMALLEST_ARM_M
from boresight.geometry import Plane
from boresight.sensing import Cell, DrawWire, LaserRanger, PlaneContact, Pose, Position, Readings
from boresight.units import Units

FARTHEST, NEAREST, NEAREST_M = 60.0, 2e-3, 0.01
"""Distances are not more than so many times the arm's reach, and not all of them less than so small a share of what its
links reach, nor than this [m]: a slide or a boom may carry a sensor of short range far."""

OFF = 25.0
"""Nominal predictions are not so many times too large or too small."""

CLOSE = 0.3
"""A target nearer than this share of the arm's reach is told by nothing: errors of the arm may be as large."""

MOVED = 0.1
"""Positions tell something where the tool moves more than this share of the arm's reach."""

ROWS = 500
"""Rows that stand for many."""

ENOUGH = 10
"""Rows that are needed to say of joints that they hardly move."""

FITTING = 0.1
"""Joints are in radians where nominal errors fall to this share by reading them so."""


def readings_fault(
    cell: Cell, extent: Extent, readings: Readings, unknown: frozenset[str], units: Units, robot: str
) -> str | None:
    """Returns what is wrong where readings cannot be meant in their units, a sentence that begins with the columns.

    Args:
        cell: the nominal cell [m, rad], unknown frames at neutral values.
        extent: of its arm.
        readings: of one file [m, rad].
        unknown: parameters of frames that nobody has measured.
        units: that the file was read in.
        robot: what the user calls the robot's file.
    """
    rows = np.unique(np.linspace(0, len(readings) - 1, min(len(readings), ROWS)).astype(int))
    if not readings.measured:
        return None
    with np.errstate(all="ignore"):
        return next(_faults(cell, extent, readings.chosen(rows), unknown, units, robot), None)


def _faults(
    cell: Cell, extent: Extent, readings: Readings, unknown: frozenset[str], units: Units, robot: str
) -> Iterator[str]:
    for place in np.unique(readings.target).tolist():
        aim, own = cell.aims[place], readings.chosen(readings.target == place)
        sensor = cell.sensors[aim.sensor]
        known = not {f"{frame}.{n}" for frame in ("base", aim.mount) for n in ("x", "roll")} & unknown
        columns = ", ".join(sensor.columns[:3])
        yield from _radians(cell, own, columns, known, units)
        if isinstance(sensor, LaserRanger | DrawWire):
            yield from _distances(own.values[:, 0], columns, extent, units)
        if isinstance(sensor, Position | Pose):
            yield from _positions(cell, own, columns, extent, units, robot)
        if known and aim.target is not None and not any(name.startswith(f"{aim.target}.") for name in unknown):
            yield from _target(cell, own, aim.target, extent.whole, units)


def _distances(values: Float[np.ndarray, " rows"], columns: str, extent: Extent, units: Units) -> Iterator[str]:
    far = np.quantile(values, 0.9) > FARTHEST * max(extent.whole, SMALLEST_ARM_M)
    if far or 0.0 < np.max(values) < min(NEAREST * extent.links, NEAREST_M):
        yield (
            f"{columns}: got {_span(values, units)} before an arm that reaches {extent.whole / units.metres:.4g} "
            f"{units.length}; is it in another unit than the campaign's `units:`?"
        )


def _positions(cell: Cell, readings: Readings, columns: str, extent: Extent, units: Units, robot: str) -> Iterator[str]:
    """Yields a fault where positions are spread far more, or far less, than the arm can have moved its tool."""
    reach = extent.links if extent.links >= SMALLEST_ARM_M else extent.whole
    theirs, ours = _spread(readings.values[:, :3]), _spread(_ends(cell, readings))
    if max(theirs, ours) > MOVED * reach and not ours / OFF < theirs < ours * OFF:
        yield (
            f"{columns}: got positions {theirs / units.metres:.4g} {units.length} from their middle, where the arm of "
            f"{robot} moves its tool {ours / units.metres:.4g} {units.length}; are they in another unit than the "
            "campaign's `units:`?"
        )


def _target(cell: Cell, readings: Readings, target: str, reach: float, units: Units) -> Iterator[str]:
    """Yields a fault where a target stands far more, or far less, away from the tool than was read."""
    poses, at = cell.poses(readings.joints, target=readings.target), cell.targets[target]
    sensor = cell.sensors[cell.aims[int(readings.target[0])].sensor]
    read = np.abs(readings.values[:, 0])
    if isinstance(at, Plane):
        away, key = np.abs(at.height(poses[:, :3, 3])), f"targets.{target}.offset"
        read = np.zeros(len(away)) if isinstance(sensor, PlaneContact) else read * np.abs(poses[:, :3, 2] @ at.normal)
    else:
        away, key = np.linalg.norm(poses[:, :3, 3] - np.asarray(at.xyz), axis=1), f"targets.{target}.position"
    nominal, measured = float(np.median(away)), float(np.median(read))
    if nominal > OFF * max(measured, CLOSE * reach):
        base = math.hypot(*cell.base.xyz)
        key = "base.xyz" if base > 0.5 * nominal else key
        yield (
            f"got {measured / units.metres:.4g} {units.length} to `{target}`, which the campaign puts "
            f"{nominal / units.metres:.4g} {units.length} away; is {key} in another unit than `units:` says?"
        )


def _radians(cell: Cell, readings: Readings, columns: str, known: bool, units: Units) -> Iterator[str]:
    """Yields a fault where joints that are read in degrees explain the readings in radians alone."""
    turning = np.array([joint.type == "revolute" for joint in cell.arm.driven])
    written = np.abs(readings.joints[:, turning]) / units.radians
    if units.angle != "deg" or len(readings) < ENOUGH or not written.size or written.max() > 2.0 * math.pi:
        return
    joints = np.where(turning, readings.joints / units.radians, readings.joints)
    other = replace(readings, joints=joints, since=None if readings.since is None else readings.since / units.radians)
    if known:
        first, second = (_typical(cell.errors(each)[each.read]) for each in (readings, other))
    elif columns.startswith("x, y, z"):
        measured = _spread(readings.values[:, :3])
        first, second = (abs(_spread(_ends(cell, each)) - measured) for each in (readings, other))
    else:
        return
    if second < FITTING * first:
        yield (
            f"joints: none reads more than {written.max():.4g} degrees, and as radians they fit: say units: {{angle: "
            "rad} in the campaign"
        )


def _ends(cell: Cell, readings: Readings) -> Float[np.ndarray, "rows 3"]:
    return cell.poses(readings.joints, target=readings.target)[:, :3, 3]


def _spread(points: Float[np.ndarray, "rows 3"]) -> float:
    """Returns the median distance of points from their middle [m]."""
    return float(np.median(np.linalg.norm(points - np.median(points, axis=0), axis=1)))


def _typical(errors: Float[np.ndarray, " values"]) -> float:
    """Returns the median size of errors; infinite where most beams miss."""
    return float(np.median(np.nan_to_num(np.abs(errors), nan=np.inf)))


def _span(values: Float[np.ndarray, " rows"], units: Units) -> str:
    return f"{np.min(values) / units.metres:.4g} to {np.max(values) / units.metres:.4g} {units.length}"
