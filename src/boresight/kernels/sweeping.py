"""The cost of a population over all readings: the innermost loops of the product.

Each reading's plane is carried through a tile's links, its four numbers a lane in the first-level cache; the
last link only as far as the readout needs. One compiled function serves every arm: it does not know the
number of links when compiled.

What makes these loops vector code, each found by measurement (ns a range, six links, one core):
offsets are unsigned, since an index that might be negative becomes a gather (6.3 instead of 40); the loops
stand in one function, since every call with an array counts references (6.3 instead of 11); the state is
updated in place, since two buffers that change roles cannot be told apart (6.3 instead of 27).
"""

from __future__ import annotations

import numpy as np

from boresight.kernels.building import build_links, build_planes, build_sensor
from boresight.kernels.carrying import along, moved_offset, range_residual, robust, turned
from boresight.kernels.compiling import compiled
from boresight.kernels.programs import COMPONENT, DISTANCE, LANES, OFFSET, RANGE

_LANES = np.uint64(LANES)
_PLANE, _SECOND, _SENSOR = np.uint64(4 * LANES), np.uint64(4 * LANES), np.uint64(2 * LANES)
_X, _Y, _Z, _F = (np.uint64(k * LANES) for k in range(4))
_LINK = np.uint64(12 * LANES)
_XX, _XY, _XZ, _YX, _YY, _YZ, _ZX, _ZY, _ZZ, _TX, _TY, _TZ = (np.uint64(k * LANES) for k in range(12))
"""Where each number of a tile's plane and of its links begins."""


@compiled
def _other_residuals(rows, row, program, planes, links, sensor, state):
    """Writes the weighted squares of a reading off a carried point or normal in place of the state's x.

    A call of its own, which costs 6.3 ns a wire where a range costs 4.0: the loops for planes are not slowed.
    """
    joints = program.prismatic.shape[0]
    kind = rows.readout[row]
    is_point = kind == DISTANCE
    share = 1.0 if is_point else 0.0  # of a link's shift: a point is shifted, a normal is not
    start = np.uint64(rows.plane[row]) * _PLANE
    for i in range(_PLANE):
        state[i] = planes[start + i]
    link = _LINK
    for joint in range(joints):
        if joint == joints - 1:
            link += np.uint64(rows.mount[row]) * _LINK
        c, s = rows.first[row, joint], rows.second[row, joint]
        if program.prismatic[joint]:
            for i in range(_LANES):
                state[_Z + i] -= share * c
            c, s = 1.0, 0.0
        for i in range(_LANES):
            x, y = turned(s, c, state[_X + i], state[_Y + i])
            z, k = state[_Z + i], link + i
            x, y, z = x - share * links[k + _TX], y - share * links[k + _TY], z - share * links[k + _TZ]
            state[_X + i] = along(x, y, z, links[k + _XX], links[k + _XY], links[k + _XZ])
            state[_Y + i] = along(x, y, z, links[k + _YX], links[k + _YY], links[k + _YZ])
            state[_Z + i] = along(x, y, z, links[k + _ZX], links[k + _ZY], links[k + _ZZ])
        link += _LINK
    reading, weight = rows.reading[row], rows.weight[row]
    if is_point:
        at = np.uint64(rows.sensor[row]) * np.uint64(2) * _LANES
        for i in range(_LANES):
            x, y, z = state[_X + i], state[_Y + i], state[_Z + i]
            residual = sensor[at + i] + sensor[at + _LANES + i] * np.sqrt(x * x + y * y + z * z) - reading
            state[_X + i] = weight * residual * residual
    else:
        # Chosen by factors: an offset known only when it runs keeps the loop scalar (145 instead of 114 ns a pose).
        on_x = 1.0 if kind == COMPONENT else 0.0
        on_y = 1.0 if kind == COMPONENT + 1 else 0.0
        on_z = 1.0 if kind == COMPONENT + 2 else 0.0
        for i in range(_LANES):
            residual = on_x * state[_X + i] + on_y * state[_Y + i] + on_z * state[_Z + i] - reading
            state[_X + i] = weight * residual * residual


@compiled
def _step(s, c, x, y, z, f, xx, xy, xz, yx, yy, yz, zx, zy, zz, tx, ty, tz):
    """Returns a plane's (x, y, z, f) after a joint's turn and the link behind it."""
    x, y = turned(s, c, x, y)
    return (
        along(x, y, z, xx, xy, xz),
        along(x, y, z, yx, yy, yz),
        along(x, y, z, zx, zy, zz),
        moved_offset(x, y, z, f, tx, ty, tz),
    )


@compiled
def _sweep_tile(program, rows, planes, links, sensor, state, costs):
    """Adds every reading's cost to the members of one tile."""
    loss = program.loss
    joints, count = program.prismatic.shape[0], rows.reading.shape[0]
    row = 0
    while row < count:
        if rows.readout[row] > OFFSET:
            _other_residuals(rows, row, program, planes, links, sensor, state)
            for i in range(_LANES):
                costs[i] += robust(state[_X + i], loss)
            row += 1
            continue
        other = row + 1
        if other == count or rows.readout[other] != rows.readout[row] or rows.mount[other] != rows.mount[row]:
            other = row
        weight, weight_2 = rows.weight[row], rows.weight[other] if other > row else 0.0
        start, start_2 = np.uint64(rows.plane[row]) * _PLANE, np.uint64(rows.plane[other]) * _PLANE
        for i in range(_PLANE):
            state[i], state[_SECOND + i] = planes[start + i], planes[start_2 + i]
        link = _LINK
        for joint in range(joints):
            c, s = rows.first[row, joint], rows.second[row, joint]
            c_2, s_2 = rows.first[other, joint], rows.second[other, joint]
            if program.prismatic[joint]:
                for i in range(_LANES):
                    state[_F + i] += c * state[_Z + i]
                    state[_SECOND + _F + i] += c_2 * state[_SECOND + _Z + i]
                c, s, c_2, s_2 = 1.0, 0.0, 1.0, 0.0
            if joint == joints - 1:
                break
            for i in range(_LANES):
                k, a, b = link + i, i, _SECOND + i
                xx, xy, xz = links[k + _XX], links[k + _XY], links[k + _XZ]
                yx, yy, yz = links[k + _YX], links[k + _YY], links[k + _YZ]
                zx, zy, zz = links[k + _ZX], links[k + _ZY], links[k + _ZZ]
                tx, ty, tz = links[k + _TX], links[k + _TY], links[k + _TZ]
                state[_X + a], state[_Y + a], state[_Z + a], state[_F + a] = _step(
                    s, c, state[_X + a], state[_Y + a], state[_Z + a], state[_F + a],
                    xx, xy, xz, yx, yy, yz, zx, zy, zz, tx, ty, tz,
                )  # fmt: skip
                state[_X + b], state[_Y + b], state[_Z + b], state[_F + b] = _step(
                    s_2, c_2, state[_X + b], state[_Y + b], state[_Z + b], state[_F + b],
                    xx, xy, xz, yx, yy, yz, zx, zy, zz, tx, ty, tz,
                )  # fmt: skip
            link += _LINK
        reading, reading_2 = rows.reading[row], rows.reading[other]
        is_range = rows.readout[row] == RANGE
        link += np.uint64(rows.mount[row]) * _LINK
        at, at_2 = np.uint64(rows.sensor[row]) * _SENSOR, np.uint64(rows.sensor[other]) * _SENSOR
        for i in range(_LANES):
            k, a, b = link + i, i, _SECOND + i
            zx, zy, zz = links[k + _ZX], links[k + _ZY], links[k + _ZZ]
            tx, ty, tz = links[k + _TX], links[k + _TY], links[k + _TZ]
            x, y = turned(s, c, state[_X + a], state[_Y + a])
            f = moved_offset(x, y, state[_Z + a], state[_F + a], tx, ty, tz)
            nz = along(x, y, state[_Z + a], zx, zy, zz)
            x, y = turned(s_2, c_2, state[_X + b], state[_Y + b])
            f_2 = moved_offset(x, y, state[_Z + b], state[_F + b], tx, ty, tz)
            nz_2 = along(x, y, state[_Z + b], zx, zy, zz)
            residual, residual_2 = f - reading, f_2 - reading_2
            if is_range:
                residual = range_residual(nz, f, sensor[at + i], sensor[at + _LANES + i], reading)
                residual_2 = range_residual(nz_2, f_2, sensor[at_2 + i], sensor[at_2 + _LANES + i], reading_2)
            square, square_2 = weight * residual * residual, weight_2 * residual_2 * residual_2
            costs[i] += robust(square, loss) + robust(square_2, loss)
        row = other + 1


@compiled
def sweep(program, rows, work, members, costs):
    """Writes the cost of every member: the weighted sum of squared residuals and of squared corrections
    (paper, eq. 12 and 22).

    Args:
        program: the `Program`.
        rows: the `Rows`.
        work: the thread's `Workspace`.
        members: (parameters, lanes) corrections, lanes a multiple of `LANES`; one row at least, be it unused.
        costs: (lanes,) out.
    """
    for start in range(0, members.shape[1], LANES):
        build_links(program, members, start, work.links, work.scratch)
        build_planes(program, members, start, work.links, work.planes)
        build_sensor(program, members, start, work.sensor)
        tile = costs[start : start + LANES]
        for i in range(LANES):
            work.costs[i] = 0.0
        for parameter in range(program.prior_weight.shape[0]):
            weight = program.prior_weight[parameter]
            correction = members[parameter, start : start + LANES]
            for i in range(LANES):
                work.costs[i] += weight * correction[i] * correction[i]
        _sweep_tile(program, rows, work.planes, work.links, work.sensor, work.state, work.costs)
        for i in range(LANES):
            tile[i] = work.costs[i]
