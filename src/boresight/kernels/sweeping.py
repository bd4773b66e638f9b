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
from boresight.kernels.carrying import along, moved_offset, range_residual, turned
from boresight.kernels.compiling import compiled
from boresight.kernels.programs import COMPONENT, DISTANCE, LANES, OFFSET, RANGE

_LANES = np.uint64(LANES)
_X, _Y, _Z, _F = (np.uint64(k * LANES) for k in range(4))
_LINK = np.uint64(12 * LANES)
_XX, _XY, _XZ, _YX, _YY, _YZ, _ZX, _ZY, _ZZ, _TX, _TY, _TZ = (np.uint64(k * LANES) for k in range(12))
"""Where each number of a tile's plane and of its links begins."""


@compiled
def _other_residuals(rows, row, program, links, sensor, state):
    """Writes the weighted squares of a reading off a carried point or normal in place of the state's x.

    A call of its own, which costs 6.3 ns a wire where a range costs 4.0: the loops for planes are not slowed.
    """
    joints = program.prismatic.shape[0]
    kind = rows.readout[row]
    is_point = kind == DISTANCE
    share = 1.0 if is_point else 0.0  # of a link's shift: a point is shifted, a normal is not
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
def _add_costs(state, costs, loss, inverse_loss):
    """Adds the weighted squares in place of the state's x to the costs, robustly where there is a loss."""
    for i in range(_LANES):
        square = state[_X + i]
        if loss > 0.0:
            square = 2.0 * loss * (np.sqrt(1.0 + square * inverse_loss) - 1.0)
        costs[i] += square


@compiled
def _sweep_tile(program, rows, planes, links, sensor, state, costs):
    """Adds every reading's cost to the members of one tile."""
    loss = program.loss
    inverse_loss = 1.0 / loss if loss > 0.0 else 0.0
    joints = program.prismatic.shape[0]
    for row in range(rows.reading.shape[0]):
        start = np.uint64(rows.plane[row]) * np.uint64(4) * _LANES
        for i in range(np.uint64(4) * _LANES):
            state[i] = planes[start + i]
        if rows.readout[row] > OFFSET:
            _other_residuals(rows, row, program, links, sensor, state)
            _add_costs(state, costs, loss, inverse_loss)
            continue
        link = _LINK
        c, s = 1.0, 0.0
        for joint in range(joints):
            c, s = rows.first[row, joint], rows.second[row, joint]
            if program.prismatic[joint]:
                for i in range(_LANES):
                    state[_F + i] += c * state[_Z + i]
                c, s = 1.0, 0.0
            if joint == joints - 1:
                break
            for i in range(_LANES):
                x, y = turned(s, c, state[_X + i], state[_Y + i])
                z, k = state[_Z + i], link + i
                state[_F + i] = moved_offset(x, y, z, state[_F + i], links[k + _TX], links[k + _TY], links[k + _TZ])
                state[_X + i] = along(x, y, z, links[k + _XX], links[k + _XY], links[k + _XZ])
                state[_Y + i] = along(x, y, z, links[k + _YX], links[k + _YY], links[k + _YZ])
                state[_Z + i] = along(x, y, z, links[k + _ZX], links[k + _ZY], links[k + _ZZ])
            link += _LINK
        reading, weight = rows.reading[row], rows.weight[row]
        is_range = rows.readout[row] == RANGE
        link += np.uint64(rows.mount[row]) * _LINK
        at = np.uint64(rows.sensor[row]) * np.uint64(2) * _LANES
        for i in range(_LANES):
            x, y = turned(s, c, state[_X + i], state[_Y + i])
            z, k = state[_Z + i], link + i
            f = moved_offset(x, y, z, state[_F + i], links[k + _TX], links[k + _TY], links[k + _TZ])
            nz = along(x, y, z, links[k + _ZX], links[k + _ZY], links[k + _ZZ])
            residual = f - reading
            if is_range:
                residual = range_residual(nz, f, sensor[at + i], sensor[at + _LANES + i], reading)
            state[_X + i] = weight * residual * residual
        if loss == 0.0:
            for i in range(_LANES):
                costs[i] += state[_X + i]
        else:
            for i in range(_LANES):
                costs[i] += 2.0 * loss * (np.sqrt(1.0 + state[_X + i] * inverse_loss) - 1.0)


@compiled
def sweep(program, rows, work, members, costs):
    """Writes the cost of every member: the weighted sum of squared residuals and of squared corrections
    (paper, eq. 12 and 22).

    Args:
        program: the `Program`.
        rows: the `Rows`.
        work: the thread's `Workspace`.
        members: (parameters, lanes) corrections, lanes a multiple of `LANES`.
        costs: (lanes,) out.
    """
    for start in range(0, members.shape[1], LANES):
        build_links(program, members, start, work.links, work.scratch)
        build_planes(program, members, start, work.links, work.planes)
        build_sensor(program, members, start, work.sensor)
        tile = costs[start : start + LANES]
        for i in range(LANES):
            work.costs[i] = 0.0
        for parameter in range(members.shape[0]):
            weight = program.prior_weight[parameter]
            correction = members[parameter, start : start + LANES]
            for i in range(LANES):
                work.costs[i] += weight * correction[i] * correction[i]
        _sweep_tile(program, rows, work.planes, work.links, work.sensor, work.state, work.costs)
        for i in range(LANES):
            tile[i] = work.costs[i]
