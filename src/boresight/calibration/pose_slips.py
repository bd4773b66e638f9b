"""Slips of trackers' positions and orientations, each made undone.

A quaternion with its scalar last in the columns of one that has it first, orientations or whole poses of the world in
the tool's frame, angles applied in the other order, coordinates of a left-handed frame.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float

from boresight.geometry import matrix_quaternion, matrix_rpy, quaternion_matrix, rpy_matrix
from boresight.sensing import Cell, Readings

SCALAR_LAST, SCALAR_FIRST = [3, 0, 1, 2], [1, 2, 3, 0]
"""Where w, x, y and z stand among the four columns that were read as w, x, y, z."""


def pose_slips(cell: Cell, readings: Readings) -> Iterator[tuple[str, str, Readings]]:
    """Yields each slip of positions and poses: its name, what to do, and the readings without it.

    Args:
        cell: nominal.
        readings: as given.
    """
    types = np.array([cell.sensors[aim.sensor].type for aim in cell.aims])[readings.target]
    turned, placed = types == "pose", np.isin(types, ["position", "pose"])
    if turned.any():
        yield from _of_orientations(readings, turned)
    if placed.any():
        yield from _of_coordinates(readings, placed, turned)


def _of_orientations(readings: Readings, turned: Bool[np.ndarray, " rows"]) -> Iterator[tuple[str, str, Readings]]:
    assert readings.reference is not None
    R, p = readings.reference, readings.values[:, :3]
    quaternion = matrix_quaternion(R)
    for order, words in (
        (SCALAR_LAST, "The quaternions have their scalar last: the columns qw, qx, qy, qz hold x, y, z, w"),
        (SCALAR_FIRST, "The quaternions have their scalar first: the columns qx, qy, qz, qw hold w, x, y, z"),
    ):
        yield "quaternion order", words, _changed(readings, turned, quaternion_matrix(quaternion[:, order]))
    inverse = np.swapaxes(R, 1, 2)
    yield (
        "orientations inverted",
        "The orientations are those of the world in the tool's frame: negate qx, qy and qz, or transpose the rotations",
        _changed(readings, turned, inverse),
    )
    yield (
        "poses inverted",
        "The poses are those of the world in the tool's frame: invert them",
        _changed(readings, turned, inverse, -np.einsum("nij,nj->ni", inverse, p)),
    )
    yield (
        "order of angles",
        "Roll, pitch and yaw turn about axes that move with the tool, in this order, and not about fixed ones",
        _changed(readings, turned, np.array([_about_moving_axes(*matrix_rpy(each)) for each in R])),
    )


def _about_moving_axes(roll: float, pitch: float, yaw: float) -> Float[np.ndarray, "3 3"]:
    return rpy_matrix((roll, 0.0, 0.0)) @ rpy_matrix((0.0, pitch, 0.0)) @ rpy_matrix((0.0, 0.0, yaw))


def _of_coordinates(
    readings: Readings, placed: Bool[np.ndarray, " rows"], turned: Bool[np.ndarray, " rows"]
) -> Iterator[tuple[str, str, Readings]]:
    for words, mirror in _mirrors():
        p = readings.values[:, :3] @ mirror.T
        yield (
            "left-handed coordinates",
            f"The positions are those of a left-handed frame: {words}",
            _changed(readings, placed, None, p),
        )
        if turned.any():
            assert readings.reference is not None
            R = mirror @ readings.reference @ mirror.T
            yield (
                "left-handed coordinates",
                f"Positions and orientations are those of a left-handed frame: {words}, orientations with them",
                _changed(readings, placed, R, p),
            )


def _mirrors() -> Iterator[tuple[str, Float[np.ndarray, "3 3"]]]:
    for place, name in enumerate("xyz"):
        yield f"column {name} with the other sign", np.diag(np.where(np.arange(3) == place, -1.0, 1.0))
    for first, second in ((0, 1), (1, 2), (0, 2)):
        exchanged = np.eye(3)
        exchanged[[first, second]] = exchanged[[second, first]]
        yield f"columns {'xyz'[first]} and {'xyz'[second]} exchanged", exchanged


def _changed(
    readings: Readings,
    rows: Bool[np.ndarray, " rows"],
    reference: Float[np.ndarray, "rows 3 3"] | None,
    positions: Float[np.ndarray, "rows 3"] | None = None,
) -> Readings:
    """Returns the readings with other orientations and positions in some rows."""
    values = readings.values
    if positions is not None:
        values = values.copy()
        values[rows, :3] = positions[rows]
    if reference is None or readings.reference is None:
        return replace(readings, values=values)
    return replace(readings, values=values, reference=np.where(rows[:, None, None], reference, readings.reference))
