"""Members turned into links and planes: the pass over parameters, a tile of members at a time.

The inner loops run over the lanes of a tile; see `sweeping` for what makes them vector code.
"""

from __future__ import annotations

import numpy as np

from boresight.kernels.carrying import along, moved_offset, turned
from boresight.kernels.compiling import compiled
from boresight.kernels.programs import FIXED, LANES, POINT, TURN
from boresight.kernels.trigonometry import sincos

_LANES = np.uint64(LANES)
_LINK = np.uint64(12 * LANES)
_COLUMN = np.uint64(3 * LANES)
_ORIGIN = np.uint64(9 * LANES)


@compiled
def build_links(program, members, start, links, scratch):
    """Writes the constant transform of every segment for one tile.

    Args:
        program: the `Program`.
        members: (parameters, lanes) corrections.
        start: the tile's first lane.
        links: (segments * 12 * LANES,) out: R column by column, then t [m].
        scratch: (3 * LANES,) work space.
    """
    first = np.uint64(start)
    sine, cosine = _LANES, _LANES + _LANES
    for segment in range(program.segment_start.shape[0] - 1):
        link = np.uint64(segment) * _LINK
        for i in range(_LINK):
            links[link + i] = 0.0
        for i in range(_LANES):
            links[link + i] = links[link + i + _COLUMN + _LANES] = links[link + i + _ORIGIN - _LANES] = 1.0
        for motion in range(program.segment_start[segment], program.segment_start[segment + 1]):
            parameter, value = program.motion_parameter[motion], program.motion_value[motion]
            axis = program.motion_axis[motion]
            for i in range(_LANES):
                scratch[i] = value
            if parameter != FIXED:
                for i in range(_LANES):
                    scratch[i] += members[parameter, first + i]
            if program.motion_kind[motion] == TURN:
                for i in range(_LANES):
                    scratch[sine + i], scratch[cosine + i] = sincos(scratch[i])
                u = link + np.uint64((axis + 1) % 3) * _COLUMN
                v = link + np.uint64((axis + 2) % 3) * _COLUMN
                for _ in range(3):
                    for i in range(_LANES):
                        links[u + i], links[v + i] = turned(
                            scratch[sine + i], scratch[cosine + i], links[u + i], links[v + i]
                        )
                    u += _LANES
                    v += _LANES
            else:
                column, origin = link + np.uint64(axis) * _COLUMN, link + _ORIGIN
                for _ in range(3):
                    for i in range(_LANES):
                        links[origin + i] += scratch[i] * links[column + i]
                    column += _LANES
                    origin += _LANES


@compiled
def _moved_component(program, plane, component, members, start, out):
    """Writes one of n_x, n_y, n_z, f of a plane, nominal plus correction."""
    parameter = program.plane_parameter[plane, component]
    value = program.plane[plane, component]
    if parameter == FIXED:
        for i in range(LANES):
            out[i] = value
    else:
        correction = members[parameter, start : start + LANES]
        for i in range(LANES):
            out[i] = value + correction[i]


@compiled
def _complete(first, second, dropped, sign):
    """Writes the dropped component of a normal, which follows from |n| = 1 (paper, eq. 19).

    Where the other two alone are longer than 1, it is 0 and they are scaled back.
    """
    for i in range(LANES):
        squares = first[i] * first[i] + second[i] * second[i]
        scale = 1.0 / np.sqrt(max(squares, 1.0))
        dropped[i] = sign * np.sqrt(max(1.0 - squares, 0.0))
        first[i], second[i] = scale * first[i], scale * second[i]


@compiled
def _into_base(base, plane):
    """Carries a plane from the world to the first joint's axis, in place."""
    for i in range(LANES):
        x, y, z, f = plane[i], plane[LANES + i], plane[2 * LANES + i], plane[3 * LANES + i]
        plane[i] = along(x, y, z, base[i], base[LANES + i], base[2 * LANES + i])
        plane[LANES + i] = along(x, y, z, base[3 * LANES + i], base[4 * LANES + i], base[5 * LANES + i])
        plane[2 * LANES + i] = along(x, y, z, base[6 * LANES + i], base[7 * LANES + i], base[8 * LANES + i])
        plane[3 * LANES + i] = moved_offset(x, y, z, f, base[9 * LANES + i], base[10 * LANES + i], base[11 * LANES + i])


@compiled
def _point_into_base(base, point):
    """Carries a point from the world to the first joint's axis, in place."""
    for i in range(LANES):
        x = point[i] - base[9 * LANES + i]
        y = point[LANES + i] - base[10 * LANES + i]
        z = point[2 * LANES + i] - base[11 * LANES + i]
        point[i] = along(x, y, z, base[i], base[LANES + i], base[2 * LANES + i])
        point[LANES + i] = along(x, y, z, base[3 * LANES + i], base[4 * LANES + i], base[5 * LANES + i])
        point[2 * LANES + i] = along(x, y, z, base[6 * LANES + i], base[7 * LANES + i], base[8 * LANES + i])


@compiled
def build_planes(program, members, start, links, planes):
    """Writes every plane and point as seen from the first joint's axis, for one tile whose links are built."""
    base = links[: 12 * LANES]
    for plane in range(program.plane.shape[0]):
        out = planes[plane * 4 * LANES : (plane + 1) * 4 * LANES]
        for component in range(4):
            lanes = out[component * LANES : (component + 1) * LANES]
            _moved_component(program, plane, component, members, start, lanes)
        dropped = program.plane_dropped[plane]
        if dropped == POINT:
            _point_into_base(base, out)
            continue
        first, second = min((dropped + 1) % 3, (dropped + 2) % 3), max((dropped + 1) % 3, (dropped + 2) % 3)
        if program.plane_parameter[plane, first] != FIXED or program.plane_parameter[plane, second] != FIXED:
            _complete(
                out[first * LANES : (first + 1) * LANES],
                out[second * LANES : (second + 1) * LANES],
                out[dropped * LANES : (dropped + 1) * LANES],
                -1.0 if program.plane[plane, dropped] < 0.0 else 1.0,
            )
        _into_base(base, out)


@compiled
def build_sensor(program, members, start, sensor):
    """Writes every sensor's bias [m] and gain for one tile."""
    for slot in range(program.sensor_value.shape[0]):
        for number in range(3):
            place = 2 * slot + number % 2  # the third number is a second correction of the bias
            lanes = sensor[place * LANES : (place + 1) * LANES]
            parameter = program.sensor_parameter[slot, number]
            if number < 2:
                nominal = program.sensor_value[slot, number] + (1.0 if number == 1 else 0.0)
                for i in range(LANES):
                    lanes[i] = nominal
            if parameter != FIXED:
                correction = members[parameter, start : start + LANES]
                for i in range(LANES):
                    lanes[i] += correction[i]
