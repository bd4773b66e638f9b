"""Readings as equations in the unknown frames: a point or an axis that the arm carries must lie on a plane.

With the flange at (R, p) in the arm's base, a mount at (R_m, t_m) on it and the base at (R_b, t_b) in the world, a
ranger's beam of length h ends on a plane n·x + f = 0 where

    n · [R_b (p + R t_m + h R R_m z) + t_b] + f = 0.

A contact is the same with h = 0, a position the same with three planes across the world's axes, and an orientation
says it of each of the sensor's axes alone. Whatever the turns, the shifts enter linearly; so do the sensor's axes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from boresight.calibration.placement.flanges import flanges
from boresight.geometry import Plane, Point, inverse
from boresight.sensing import Cell, Readings
from boresight.sensing.laser_ranger import LaserRanger
from boresight.sensing.plane_contact import PlaneContact
from boresight.sensing.point_contact import PointContact
from boresight.sensing.pose import Pose
from boresight.sensing.position import Position

BEAM = 2
"""The sensor's axis along which a beam leaves."""


@dataclass(frozen=True)
class Equations:
    """`normal · [R_b (carried (p + R t_m) + length R R_m axis) + carried t_b] + constant = 0`, each in metres.

    Attributes:
        normal: (equations, 3) in the world.
        rotation: (equations, 3, 3) of the flange in the arm's base.
        origin: (equations, 3) of the flange in the arm's base [m].
        carried: (equations,) 1 for a point, 0 for an axis alone.
        length: (equations,) along the sensor's axis [m].
        axis: (equations,) which of the sensor's axes, 0 to 2.
        mount: (equations,) which of the cell's mounts.
        constant: (equations,) [m].
        row: (equations,) the reading each belongs to.
    """

    normal: Float[np.ndarray, "equations 3"]
    rotation: Float[np.ndarray, "equations 3 3"]
    origin: Float[np.ndarray, "equations 3"]
    carried: Float[np.ndarray, " equations"]
    length: Float[np.ndarray, " equations"]
    axis: Int[np.ndarray, " equations"]
    mount: Int[np.ndarray, " equations"]
    constant: Float[np.ndarray, " equations"]
    row: Int[np.ndarray, " equations"]

    def __len__(self) -> int:
        """Number of equations."""
        return len(self.normal)


def equations_of(cell: Cell, readings: Readings) -> Equations | None:
    """Returns the equations of readings, with the arm as the cell has it; None where a sensor has no such form.

    Args:
        cell: its base and mounts do not count.
        readings: measured values.
    """
    mounts, parts = list(cell.mounts), []
    in_base = inverse(cell.base.matrix) @ flanges(cell, readings)
    for place in np.unique(readings.target).tolist():
        aim, rows = cell.aims[place], np.flatnonzero(readings.target == place)
        sensor, target = cell.sensors[aim.sensor], None if aim.target is None else cell.targets[aim.target]
        values = readings.values[rows]
        flange = in_base[rows]
        if isinstance(sensor, LaserRanger) and isinstance(target, Plane):
            lengths = (values[:, 0] - sensor.bias) / (1.0 + sensor.scale)
            part = _on_plane(flange, target, lengths)
        elif isinstance(sensor, PlaneContact) and isinstance(target, Plane):
            part = _on_plane(flange, target, np.zeros(len(rows)))
        elif isinstance(sensor, PointContact) and isinstance(target, Point):
            part = _at_points(flange, np.tile(target.xyz, (len(rows), 1)))
        elif isinstance(sensor, Position | Pose):
            part = _at_points(flange, values[:, :3] / (1.0 + sensor.scale))
            if isinstance(sensor, Pose) and readings.reference is not None:
                part = _joined([part, _along_axes(flange, readings.reference[rows], sensor.lever)])
        else:
            return None
        part["mount"] = np.full(len(part["normal"]), mounts.index(aim.mount))
        part["row"] = rows[part["row"]]
        parts.append(part)
    return Equations(**_joined(parts))


def _joined(parts: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def _on_plane(flange: np.ndarray, plane: Plane, lengths: np.ndarray) -> dict[str, np.ndarray]:
    count = len(flange)
    return {
        "normal": np.tile(plane.normal, (count, 1)),
        "rotation": flange[:, :3, :3],
        "origin": flange[:, :3, 3],
        "carried": np.ones(count),
        "length": lengths,
        "axis": np.full(count, BEAM),
        "constant": np.full(count, plane.offset),
        "row": np.arange(count),
    }


def _at_points(flange: np.ndarray, points: np.ndarray) -> dict[str, np.ndarray]:
    count = len(flange)
    return {
        "normal": np.tile(np.eye(3), (count, 1)),
        "rotation": np.repeat(flange[:, :3, :3], 3, axis=0),
        "origin": np.repeat(flange[:, :3, 3], 3, axis=0),
        "carried": np.ones(3 * count),
        "length": np.zeros(3 * count),
        "axis": np.full(3 * count, BEAM),
        "constant": -points.ravel(),
        "row": np.repeat(np.arange(count), 3),
    }


def _along_axes(flange: np.ndarray, orientations: np.ndarray, lever: float) -> dict[str, np.ndarray]:
    """Returns each component of each measured axis, `lever` [m] long."""
    count = len(flange)
    return {
        "normal": np.tile(np.repeat(np.eye(3), 3, axis=0), (count, 1)),
        "rotation": np.repeat(flange[:, :3, :3], 9, axis=0),
        "origin": np.repeat(flange[:, :3, 3], 9, axis=0),
        "carried": np.zeros(9 * count),
        "length": np.full(9 * count, lever),
        "axis": np.tile(np.arange(3), 3 * count),
        "constant": -lever * orientations.ravel(),
        "row": np.repeat(np.arange(count), 9),
    }
