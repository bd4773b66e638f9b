"""What the compiled loops work on: an arm, its planes and its readings, as flat arrays.

A `Program` says how a member's numbers become links and planes; `Rows` are the readings. Both are built
once a calibration (`boresight.sensing.compiled`) and never change.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from boresight.kernels.lanes import tile

_CACHE_LINE = 64

TURN, SHIFT = 0, 1
"""An elementary motion turns about, or shifts along, one coordinate axis."""

RANGE, OFFSET, DISTANCE, COMPONENT = 0, 1, 2, 3
"""A readout is the range along the sensor's +z to the carried plane; or the plane's offset, the signed distance of
the sensor's origin from the plane; or the distance of the sensor's origin from the carried point; or, `COMPONENT` and
the two numbers after it, the x, y or z component of the carried plane's normal."""

ZERO, ONE, TWO = np.float32(0.0), np.float32(1.0), np.float32(2.0)
"""In single precision, where they are exact: beside a double they change nothing, beside a single they keep it one."""

FIXED = -1
"""In place of a parameter's row: this number does not move."""

POINT = -1
"""In place of a dropped component: this is a point and not a plane."""

MISSED = 1e4
"""The error [m] charged for a beam that looks away from its plane: missing one reading fewer is worth more
than anything the other ranges can do."""


WORST = 1e300
"""The cost of what was not evaluated, or is not a number: compiled comparisons are not made for infinities."""


class Program(NamedTuple):
    """How a member, a column of a (parameters, members) array of corrections, becomes links and planes.

    Segment 0 leads from the world to the first joint's axis, segment i from joint i's axis to the next, the last
    joint's to the sensor; where there are several mounts, one more segment each leads from it to the others. Within a
    segment, motions run in order.

    Attributes:
        segment_start: (joints + mounts + 1,) first motion of each segment, and their number.
        motion_kind: (motions,) `TURN` or `SHIFT`.
        motion_axis: (motions,) 0, 1, 2 for x, y, z.
        motion_value: (motions,) nominal angle [rad] or length [m].
        motion_sine, motion_cosine: (motions,) of it.
        motion_parameter: (motions,) row of the member's correction, or `FIXED`.
        prismatic: (joints,) whether the joint shifts along z rather than turning about it.
        plane: (planes, 4) nominal unit normal and offset [m] in the world, or a point's x, y, z [m] and 0.
        plane_parameter: (planes, 4) rows of the corrections of n_x, n_y, n_z and the offset, or of x, y and z, or
            `FIXED`.
        plane_dropped: (planes,) the component of the normal that follows from the other two; `POINT` for a point.
        sensor_value: (sensors, 2) nominal bias [m] and relative scale error of each sensor in each session.
        sensor_parameter: (sensors, 3) rows of their corrections and of a second one of the bias, or `FIXED`.
        prior_weight: (parameters,) weight of each squared correction in the cost.
        loss: squared residual [m²] beyond which the cost grows with the residual rather than with its square
            (pseudo-Huber), or 0 for plain squares.
    """

    segment_start: np.ndarray
    motion_kind: np.ndarray
    motion_axis: np.ndarray
    motion_value: np.ndarray
    motion_sine: np.ndarray
    motion_cosine: np.ndarray
    motion_parameter: np.ndarray
    prismatic: np.ndarray
    plane: np.ndarray
    plane_parameter: np.ndarray
    plane_dropped: np.ndarray
    sensor_value: np.ndarray
    sensor_parameter: np.ndarray
    prior_weight: np.ndarray
    loss: float


class Rows(NamedTuple):
    """The scalar readings, one a row.

    Attributes:
        first: (rows, joints) cos q of a revolute joint, the displacement [m] of a prismatic one.
        second: (rows, joints) sin q of a revolute joint, unused of a prismatic one.
        plane: (rows,) the plane or point a reading is about.
        mount: (rows,) the mount whose segment comes last.
        sensor: (rows,) the sensor, in its session, that reads.
        readout: (rows,) `RANGE`, `OFFSET`, `DISTANCE`, or `COMPONENT` and the two after it.
        reading: (rows,) measured value [m, or 1 of a component].
        weight: (rows,) weight of the squared residual in the cost.
    """

    first: np.ndarray
    second: np.ndarray
    plane: np.ndarray
    mount: np.ndarray
    sensor: np.ndarray
    readout: np.ndarray
    reading: np.ndarray
    weight: np.ndarray


class Workspace(NamedTuple):
    """Memory of one thread, allocated once a search.

    Attributes:
        links: (segments * 12 * lanes,) link constants of a tile: R column by column, then t [m].
        planes: (planes * 4 * lanes,) planes of a tile, as seen from the first joint's axis.
        state: (8 * lanes,) the carried planes (n_x, n_y, n_z, f) of two readings of a tile.
        costs: (lanes,) cost of a tile, in double precision.
        sensor: (sensors * 2 * lanes,) bias [m] and gain of a tile's sensors.
        scratch: (2 * lanes,) sines and cosines of a motion.
    """

    links: np.ndarray
    planes: np.ndarray
    state: np.ndarray
    costs: np.ndarray
    sensor: np.ndarray
    scratch: np.ndarray


def aligned(*shape: int, dtype: type = np.float64) -> np.ndarray:
    """Returns uninitialised memory that starts on a cache line: vectors that straddle lines halved the speed."""
    size = int(np.prod(shape)) * np.dtype(dtype).itemsize
    memory = np.empty(size + _CACHE_LINE, dtype=np.uint8)
    start = -memory.ctypes.data % _CACHE_LINE
    return memory[start : start + size].view(dtype).reshape(shape)


def workspace(program: Program) -> Workspace:
    """Returns fresh memory for the loops over a program, in its precision."""
    segments, real = len(program.segment_start) - 1, program.plane.dtype.type
    lanes = tile(real)
    return Workspace(
        links=aligned(segments * 12 * lanes, dtype=real),
        planes=aligned(max(len(program.plane), 1) * 4 * lanes, dtype=real),
        state=aligned(8 * lanes, dtype=real),
        costs=aligned(lanes),
        sensor=aligned(len(program.sensor_value) * 2 * lanes, dtype=real),
        scratch=aligned(2 * lanes, dtype=real),
    )


def in_precision(numbers: Any, real: type[np.floating]) -> Any:
    """Returns a named tuple whose floating-point numbers are in a precision."""

    def cast(value: Any) -> Any:
        if isinstance(value, np.ndarray):
            return value.astype(real) if value.dtype.kind == "f" else value
        return real(value) if isinstance(value, float) else value

    return type(numbers)(*map(cast, numbers))
