"""Members turned into links and planes: the pass over parameters, a tile of members at a time.

The inner loops run over the lanes of a tile; see `sweeping` for what makes them vector code. Beyond that, a loop of one
or two operations is unrolled into as many scalar ones before it can become vector code, so a loop here does all that a
motion or a plane needs, and a number that does not move is one that moves by nothing.
"""

from __future__ import annotations

import numpy as np

from boresight.kernels.carrying import along, completed, moved_offset, turned
from boresight.kernels.compiling import compiled
from boresight.kernels.lanes import lanes_of, link_offsets, plane_offsets
from boresight.kernels.programs import FIXED, ONE, POINT, TURN, ZERO
from boresight.kernels.trigonometry import SMALL, sincos, small_sincos

_LINK, _PLANE, _SENSOR = (np.uint64(numbers) for numbers in (12, 4, 2))
"""Numbers a lane of each."""


@compiled
def _moves(parameter):
    """Returns where to read the correction of a number, and what to multiply it by: 0 if it is fixed."""
    return (0, ZERO) if parameter == FIXED else (parameter, ONE)


@compiled
def build_links(program, members, start, links, scratch):
    """Writes the constant transform of every segment for one tile.

    Args:
        program: the `Program`.
        members: (parameters, lanes) corrections, of one parameter at least.
        start: the tile's first lane.
        links: (segments * 12 * lanes,) out: R column by column, then t [m].
        scratch: (2 * lanes,) work space.
    """
    first, lanes = np.uint64(start), lanes_of(links)
    xx, xy, xz, yx, yy, yz, zx, zy, zz, tx, ty, tz = link_offsets(links)
    for segment in range(program.segment_start.shape[0] - 1):
        link = np.uint64(segment) * _LINK * lanes
        for i in range(lanes):
            k = link + i
            links[k + xx], links[k + xy], links[k + xz] = ONE, ZERO, ZERO
            links[k + yx], links[k + yy], links[k + yz] = ZERO, ONE, ZERO
            links[k + zx], links[k + zy], links[k + zz] = ZERO, ZERO, ONE
            links[k + tx], links[k + ty], links[k + tz] = ZERO, ZERO, ZERO
        for motion in range(program.segment_start[segment], program.segment_start[segment + 1]):
            axis = program.motion_axis[motion]
            if program.motion_kind[motion] == TURN:
                _write_turn(program, motion, members, first, scratch)
                if axis == 0:
                    _turn_columns(links, link, yx, zx, scratch)
                elif axis == 1:
                    _turn_columns(links, link, zx, xx, scratch)
                else:
                    _turn_columns(links, link, xx, yx, scratch)
            else:
                value = program.motion_value[motion]
                row, share = _moves(program.motion_parameter[motion])
                if axis == 0:
                    _shift_along(links, link, xx, value, share, members, row, first)
                elif axis == 1:
                    _shift_along(links, link, yx, value, share, members, row, first)
                else:
                    _shift_along(links, link, zx, value, share, members, row, first)


@compiled
def _write_turn(program, motion, members, first, scratch):
    """Writes sine and cosine of a motion's angle.

    Of a small correction by angle addition from the nominal angle's, which is exact to 1e-15 and takes half the terms.
    """
    row, share = _moves(program.motion_parameter[motion])
    sine, cosine, value = program.motion_sine[motion], program.motion_cosine[motion], program.motion_value[motion]
    lanes, beyond = lanes_of(scratch), 0.0
    for i in range(lanes):
        correction = share * members[row, first + i]
        beyond += 1.0 if correction * correction > SMALL * SMALL else 0.0
        s, c = small_sincos(correction)
        scratch[i], scratch[lanes + i] = sine * c + cosine * s, cosine * c - sine * s
    if beyond > 0.0:
        for i in range(lanes):
            scratch[i], scratch[lanes + i] = sincos(value + share * members[row, first + i])


@compiled
def _turn_columns(links, link, u, v, scratch):
    """Turns two columns of a segment's rotation in their plane; vector code since u and v are known to the compiler."""
    lanes = lanes_of(links)
    for i in range(lanes):
        k = link + i
        s, c = scratch[i], scratch[lanes + i]
        links[k + u], links[k + v] = turned(s, c, links[k + u], links[k + v])
        k += lanes
        links[k + u], links[k + v] = turned(s, c, links[k + u], links[k + v])
        k += lanes
        links[k + u], links[k + v] = turned(s, c, links[k + u], links[k + v])


@compiled
def _shift_along(links, link, column, value, share, members, row, first):
    """Moves a segment's origin along one of its columns, known to the compiler, by a length [m] and its correction."""
    lanes = lanes_of(links)
    tx, ty, tz = link_offsets(links)[9:]
    for i in range(lanes):
        k = link + i
        length = value + share * members[row, first + i]
        links[k + tx] += length * links[k + column]
        links[k + ty] += length * links[k + column + lanes]
        links[k + tz] += length * links[k + column + lanes + lanes]


@compiled
def build_planes(program, members, start, links, planes):
    """Writes every plane and point as seen from the first joint's axis, for one tile whose links are built."""
    first, lanes = np.uint64(start), lanes_of(planes)
    nx, ny, nz, at_f = plane_offsets(planes)
    xx, xy, xz, yx, yy, yz, zx, zy, zz, tx, ty, tz = link_offsets(links)
    for plane in range(program.plane.shape[0]):
        out = np.uint64(plane) * _PLANE * lanes
        (row_x, share_x), (row_y, share_y) = (
            _moves(program.plane_parameter[plane, 0]),
            _moves(program.plane_parameter[plane, 1]),
        )
        (row_z, share_z), (row_f, share_f) = (
            _moves(program.plane_parameter[plane, 2]),
            _moves(program.plane_parameter[plane, 3]),
        )
        x_0, y_0, z_0, f_0 = (
            program.plane[plane, 0],
            program.plane[plane, 1],
            program.plane[plane, 2],
            program.plane[plane, 3],
        )
        dropped = program.plane_dropped[plane]
        shift = ONE if dropped == POINT else ZERO  # a point is shifted, a normal is not
        leans = dropped != POINT and share_x + share_y + share_z > ZERO
        sign = -ONE if dropped != POINT and program.plane[plane, dropped] < ZERO else ONE
        for i in range(lanes):
            k, lane = out + i, first + i
            x, y = x_0 + share_x * members[row_x, lane], y_0 + share_y * members[row_y, lane]
            z, f = z_0 + share_z * members[row_z, lane], f_0 + share_f * members[row_f, lane]
            if leans:
                x, y, z = completed(x, y, z, sign, dropped == 0, dropped == 1, dropped == 2)
            f = moved_offset(x, y, z, f, links[i + tx], links[i + ty], links[i + tz])
            x, y, z = x - shift * links[i + tx], y - shift * links[i + ty], z - shift * links[i + tz]
            planes[k + nx] = along(x, y, z, links[i + xx], links[i + xy], links[i + xz])
            planes[k + ny] = along(x, y, z, links[i + yx], links[i + yy], links[i + yz])
            planes[k + nz] = along(x, y, z, links[i + zx], links[i + zy], links[i + zz])
            planes[k + at_f] = f


@compiled
def build_sensor(program, members, start, sensor):
    """Writes every sensor's bias [m] and gain for one tile."""
    first, lanes = np.uint64(start), lanes_of(sensor)
    for slot in range(program.sensor_value.shape[0]):
        at = np.uint64(slot) * _SENSOR * lanes
        bias, gain = program.sensor_value[slot, 0], ONE + program.sensor_value[slot, 1]
        row, share = _moves(program.sensor_parameter[slot, 0])
        row_gain, share_gain = _moves(program.sensor_parameter[slot, 1])
        row_2, share_2 = _moves(program.sensor_parameter[slot, 2])  # a second correction of the bias
        for i in range(lanes):
            lane = first + i
            sensor[at + i] = bias + share * members[row, lane] + share_2 * members[row_2, lane]
            sensor[at + lanes + i] = gain + share_gain * members[row_gain, lane]
