"""Members turned into links and planes: the pass over parameters, a tile of members at a time.

The inner loops run over the lanes of a tile; see `sweeping` for what makes them vector code. Beyond that, a loop of one
or two operations is unrolled into as many scalar ones before it can become vector code, so a loop here does all that a
motion or a plane needs, and a number that does not move is one that moves by nothing.
"""

from __future__ import annotations

import numpy as np

from boresight.kernels.carrying import along, completed, moved_offset, turned
from boresight.kernels.compiling import compiled
from boresight.kernels.programs import FIXED, LANES, POINT, TURN
from boresight.kernels.trigonometry import SMALL, sincos, small_sincos

_LANES = np.uint64(LANES)
_LINK, _PLANE, _SENSOR = (np.uint64(k * LANES) for k in (12, 4, 2))
_XX, _XY, _XZ, _YX, _YY, _YZ, _ZX, _ZY, _ZZ, _TX, _TY, _TZ = (np.uint64(k * LANES) for k in range(12))
_X, _Y, _Z, _F = (np.uint64(k * LANES) for k in range(4))


@compiled
def _moves(parameter):
    """Returns where to read the correction of a number, and what to multiply it by: 0 if it is fixed."""
    return (0, 0.0) if parameter == FIXED else (parameter, 1.0)


@compiled
def build_links(program, members, start, links, scratch):
    """Writes the constant transform of every segment for one tile.

    Args:
        program: the `Program`.
        members: (parameters, lanes) corrections, of one parameter at least.
        start: the tile's first lane.
        links: (segments * 12 * LANES,) out: R column by column, then t [m].
        scratch: (2 * LANES,) work space.
    """
    first = np.uint64(start)
    for segment in range(program.segment_start.shape[0] - 1):
        link = np.uint64(segment) * _LINK
        for i in range(_LANES):
            k = link + i
            links[k + _XX], links[k + _XY], links[k + _XZ] = 1.0, 0.0, 0.0
            links[k + _YX], links[k + _YY], links[k + _YZ] = 0.0, 1.0, 0.0
            links[k + _ZX], links[k + _ZY], links[k + _ZZ] = 0.0, 0.0, 1.0
            links[k + _TX], links[k + _TY], links[k + _TZ] = 0.0, 0.0, 0.0
        for motion in range(program.segment_start[segment], program.segment_start[segment + 1]):
            axis = program.motion_axis[motion]
            if program.motion_kind[motion] == TURN:
                _write_turn(program, motion, members, first, scratch)
                if axis == 0:
                    _turn_columns(links, link, _YX, _ZX, scratch)
                elif axis == 1:
                    _turn_columns(links, link, _ZX, _XX, scratch)
                else:
                    _turn_columns(links, link, _XX, _YX, scratch)
            else:
                value = program.motion_value[motion]
                row, share = _moves(program.motion_parameter[motion])
                if axis == 0:
                    _shift_along(links, link, _XX, value, share, members, row, first)
                elif axis == 1:
                    _shift_along(links, link, _YX, value, share, members, row, first)
                else:
                    _shift_along(links, link, _ZX, value, share, members, row, first)


@compiled
def _write_turn(program, motion, members, first, scratch):
    """Writes sine and cosine of a motion's angle.

    Of a small correction by angle addition from the nominal angle's, which is exact to 1e-15 and takes half the terms.
    """
    row, share = _moves(program.motion_parameter[motion])
    sine, cosine, value = program.motion_sine[motion], program.motion_cosine[motion], program.motion_value[motion]
    beyond = 0.0
    for i in range(_LANES):
        correction = share * members[row, first + i]
        beyond += 1.0 if correction * correction > SMALL * SMALL else 0.0
        s, c = small_sincos(correction)
        scratch[i], scratch[_LANES + i] = sine * c + cosine * s, cosine * c - sine * s
    if beyond > 0.0:
        for i in range(_LANES):
            scratch[i], scratch[_LANES + i] = sincos(value + share * members[row, first + i])


@compiled
def _turn_columns(links, link, u, v, scratch):
    """Turns two columns of a segment's rotation in their plane; vector code since u and v are known to the compiler."""
    for i in range(_LANES):
        k = link + i
        s, c = scratch[i], scratch[_LANES + i]
        links[k + u], links[k + v] = turned(s, c, links[k + u], links[k + v])
        k += _LANES
        links[k + u], links[k + v] = turned(s, c, links[k + u], links[k + v])
        k += _LANES
        links[k + u], links[k + v] = turned(s, c, links[k + u], links[k + v])


@compiled
def _shift_along(links, link, column, value, share, members, row, first):
    """Moves a segment's origin along one of its columns, known to the compiler, by a length [m] and its correction."""
    for i in range(_LANES):
        k = link + i
        length = value + share * members[row, first + i]
        links[k + _TX] += length * links[k + column]
        links[k + _TY] += length * links[k + column + _LANES]
        links[k + _TZ] += length * links[k + column + _LANES + _LANES]


@compiled
def build_planes(program, members, start, links, planes):
    """Writes every plane and point as seen from the first joint's axis, for one tile whose links are built."""
    first = np.uint64(start)
    for plane in range(program.plane.shape[0]):
        out = np.uint64(plane) * _PLANE
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
        shift = 1.0 if dropped == POINT else 0.0  # a point is shifted, a normal is not
        leans = dropped != POINT and share_x + share_y + share_z > 0.0
        sign = -1.0 if dropped != POINT and program.plane[plane, dropped] < 0.0 else 1.0
        for i in range(_LANES):
            k, lane = out + i, first + i
            x, y = x_0 + share_x * members[row_x, lane], y_0 + share_y * members[row_y, lane]
            z, f = z_0 + share_z * members[row_z, lane], f_0 + share_f * members[row_f, lane]
            if leans:
                x, y, z = completed(x, y, z, sign, dropped == 0, dropped == 1, dropped == 2)
            f = moved_offset(x, y, z, f, links[i + _TX], links[i + _TY], links[i + _TZ])
            x, y, z = x - shift * links[i + _TX], y - shift * links[i + _TY], z - shift * links[i + _TZ]
            planes[k + _X] = along(x, y, z, links[i + _XX], links[i + _XY], links[i + _XZ])
            planes[k + _Y] = along(x, y, z, links[i + _YX], links[i + _YY], links[i + _YZ])
            planes[k + _Z] = along(x, y, z, links[i + _ZX], links[i + _ZY], links[i + _ZZ])
            planes[k + _F] = f


@compiled
def build_sensor(program, members, start, sensor):
    """Writes every sensor's bias [m] and gain for one tile."""
    first = np.uint64(start)
    for slot in range(program.sensor_value.shape[0]):
        at = np.uint64(slot) * _SENSOR
        bias, gain = program.sensor_value[slot, 0], 1.0 + program.sensor_value[slot, 1]
        row, share = _moves(program.sensor_parameter[slot, 0])
        row_gain, share_gain = _moves(program.sensor_parameter[slot, 1])
        row_2, share_2 = _moves(program.sensor_parameter[slot, 2])  # a second correction of the bias
        for i in range(_LANES):
            lane = first + i
            sensor[at + i] = bias + share * members[row, lane] + share_2 * members[row_2, lane]
            sensor[at + _LANES + i] = gain + share_gain * members[row_gain, lane]
