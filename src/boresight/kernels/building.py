"""Members turned into links and planes: the pass over parameters, a tile of members at a time.

The inner loops run over the lanes of a tile; everything they touch is a slice that starts at lane 0, since
an index that might be negative, to the compiler's knowledge, turns vector loads into gathers (7x slower).
"""

from __future__ import annotations

import numpy as np

from boresight.kernels.carrying import along, moved_offset, turned
from boresight.kernels.compiling import compiled
from boresight.kernels.programs import FIXED, LANES, TURN
from boresight.kernels.trigonometry import sincos


@compiled
def _clear(link):
    for entry in range(12):
        value = 1.0 if entry in (0, 4, 8) else 0.0
        lane = link[entry * LANES : (entry + 1) * LANES]
        for i in range(LANES):
            lane[i] = value


@compiled
def _turn(link, axis, value, correction):
    """Turns a segment's frames about one of their axes: mixes the other two columns."""
    u_start, v_start = 3 * ((axis + 1) % 3) * LANES, 3 * ((axis + 2) % 3) * LANES
    u, v = link[u_start : u_start + 3 * LANES], link[v_start : v_start + 3 * LANES]
    for i in range(LANES):
        s, c = sincos(value + correction[i])
        for k in range(3):
            u[k * LANES + i], v[k * LANES + i] = turned(s, c, u[k * LANES + i], v[k * LANES + i])


@compiled
def _shift(link, axis, value, correction):
    """Shifts a segment's frames along one of their axes."""
    start = 3 * axis * LANES
    column, origin = link[start : start + 3 * LANES], link[9 * LANES : 12 * LANES]
    for k in range(3):
        for i in range(LANES):
            origin[k * LANES + i] += (value + correction[i]) * column[k * LANES + i]


@compiled
def build_links(program, members, start, zero, links):
    """Writes the constant transform of every segment for one tile.

    Args:
        program: the `Program`.
        members: (parameters, lanes) corrections.
        start: the tile's first lane.
        zero: (LANES,) zeros, the correction of a fixed motion.
        links: (segments * 12 * LANES,) out.
    """
    for segment in range(program.segment_start.shape[0] - 1):
        link = links[segment * 12 * LANES : (segment + 1) * 12 * LANES]
        _clear(link)
        for motion in range(program.segment_start[segment], program.segment_start[segment + 1]):
            parameter = program.motion_parameter[motion]
            correction = zero if parameter == FIXED else members[parameter, start : start + LANES]
            axis, value = program.motion_axis[motion], program.motion_value[motion]
            if program.motion_kind[motion] == TURN:
                _turn(link, axis, value, correction)
            else:
                _shift(link, axis, value, correction)


@compiled
def moved_plane(program, members, lane, plane):
    """Returns (n_x, n_y, n_z, f) of one plane for one member, of unit normal.

    Two components move and the dropped one follows from |n| = 1 (paper, eq. 19), keeping its sign; where the
    two alone are longer than 1, it is 0 and they are scaled back.
    """
    nominal, parameter = program.plane[plane], program.plane_parameter[plane]
    dropped = program.plane_dropped[plane]
    x, y, z, f = nominal[0], nominal[1], nominal[2], nominal[3]
    if parameter[3] != FIXED:
        f += members[parameter[3], lane]
    if parameter[0] == FIXED and parameter[1] == FIXED and parameter[2] == FIXED:
        return x, y, z, f
    x = 0.0 if dropped == 0 else x + (members[parameter[0], lane] if parameter[0] != FIXED else 0.0)
    y = 0.0 if dropped == 1 else y + (members[parameter[1], lane] if parameter[1] != FIXED else 0.0)
    z = 0.0 if dropped == 2 else z + (members[parameter[2], lane] if parameter[2] != FIXED else 0.0)
    squares = x * x + y * y + z * z
    rest = np.sqrt(max(1.0 - squares, 0.0))
    if nominal[dropped] < 0.0:
        rest = -rest
    scale = 1.0 / np.sqrt(max(squares, 1.0))
    x = rest if dropped == 0 else x * scale
    y = rest if dropped == 1 else y * scale
    z = rest if dropped == 2 else z * scale
    return x, y, z, f


@compiled
def build_planes(program, members, start, links, planes):
    """Writes every plane as seen from the first joint's axis, for one tile."""
    base = links[: 12 * LANES]
    for plane in range(program.plane.shape[0]):
        out = planes[plane * 4 * LANES : (plane + 1) * 4 * LANES]
        for i in range(LANES):
            x, y, z, f = moved_plane(program, members, start + i, plane)
            for k in range(3):
                axis = 3 * k * LANES + i
                out[k * LANES + i] = along(x, y, z, base[axis], base[axis + LANES], base[axis + 2 * LANES])
            t = 9 * LANES + i
            out[3 * LANES + i] = moved_offset(x, y, z, f, base[t], base[t + LANES], base[t + 2 * LANES])
