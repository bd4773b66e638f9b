"""The cost of a population over all readings: the innermost loops of the product.

Each reading's plane is carried through a tile's links, its four numbers a lane in the first-level cache; the
last link only as far as the readout needs. One compiled function serves every arm: it does not know the
number of links when compiled.

What makes these loops vector code, each found by measurement (ns a range, six links, one core):
offsets are unsigned, since an index that might be negative becomes a gather (6.3 instead of 40); the state is
updated in place, since two buffers that change roles cannot be told apart (6.3 instead of 27).
"""

from __future__ import annotations

import numpy as np

from boresight.kernels.building import build_links, build_planes, build_sensor
from boresight.kernels.carrying import along, moved_offset, range_residual, robust, turned, wide
from boresight.kernels.compiling import compiled
from boresight.kernels.lanes import is_single, lanes_of, link_offsets, plane_offsets
from boresight.kernels.programs import COMPONENT, DISTANCE, OFFSET, ONE, RANGE, ZERO

_LINK, _PLANE, _SENSOR = (np.uint64(numbers) for numbers in (12, 4, 2))
"""Numbers a lane of each."""


@compiled
def _other_residuals(rows, row, program, planes, links, sensor, state):
    """Writes the weighted squares of a reading off a carried point or normal in place of the state's x.

    A call of its own, which costs 6.3 ns a wire where a range costs 4.0: the loops for planes are not slowed.
    """
    joints = program.prismatic.shape[0]
    kind = rows.readout[row]
    is_point = kind == DISTANCE
    share = ONE if is_point else ZERO  # of a link's shift: a point is shifted, a normal is not
    lanes = lanes_of(state)
    at_x, at_y, at_z, _ = plane_offsets(state)
    xx, xy, xz, yx, yy, yz, zx, zy, zz, tx, ty, tz = link_offsets(links)
    a_plane, a_link = _PLANE * lanes, _LINK * lanes
    start = np.uint64(rows.plane[row]) * a_plane
    for i in range(a_plane):
        state[i] = planes[start + i]
    link = a_link
    for joint in range(joints):
        if joint == joints - 1:
            link += np.uint64(rows.mount[row]) * a_link
        c, s = rows.first[row, joint], rows.second[row, joint]
        if program.prismatic[joint]:
            for i in range(lanes):
                state[at_z + i] -= share * c
            c, s = ONE, ZERO
        for i in range(lanes):
            x, y = turned(s, c, state[at_x + i], state[at_y + i])
            z, k = state[at_z + i], link + i
            x, y, z = x - share * links[k + tx], y - share * links[k + ty], z - share * links[k + tz]
            state[at_x + i] = along(x, y, z, links[k + xx], links[k + xy], links[k + xz])
            state[at_y + i] = along(x, y, z, links[k + yx], links[k + yy], links[k + yz])
            state[at_z + i] = along(x, y, z, links[k + zx], links[k + zy], links[k + zz])
        link += a_link
    reading, weight = rows.reading[row], rows.weight[row]
    if is_point:
        at = np.uint64(rows.sensor[row]) * _SENSOR * lanes
        for i in range(lanes):
            x, y, z = state[at_x + i], state[at_y + i], state[at_z + i]
            residual = sensor[at + i] + sensor[at + lanes + i] * np.sqrt(x * x + y * y + z * z) - reading
            state[at_x + i] = weight * residual * residual
    else:
        # Chosen by factors: an offset known only when it runs keeps the loop scalar (145 instead of 114 ns a pose).
        on_x = ONE if kind == COMPONENT else ZERO
        on_y = ONE if kind == COMPONENT + 1 else ZERO
        on_z = ONE if kind == COMPONENT + 2 else ZERO
        for i in range(lanes):
            residual = on_x * state[at_x + i] + on_y * state[at_y + i] + on_z * state[at_z + i] - reading
            state[at_x + i] = weight * residual * residual


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
    lanes, single = lanes_of(state), is_single(state)
    at_x, at_y, at_z, at_f = plane_offsets(state)
    o_xx, o_xy, o_xz, o_yx, o_yy, o_yz, o_zx, o_zy, o_zz, o_tx, o_ty, o_tz = link_offsets(links)
    a_plane, a_link, a_sensor = _PLANE * lanes, _LINK * lanes, _SENSOR * lanes
    second = a_plane  # where the second reading's plane begins
    row = 0
    while row < count:
        if rows.readout[row] > OFFSET:
            _other_residuals(rows, row, program, planes, links, sensor, state)
            for i in range(lanes):
                costs[i] += wide(robust(state[at_x + i], loss))
            row += 1
            continue
        other = row + 1
        if other == count or rows.readout[other] != rows.readout[row] or rows.mount[other] != rows.mount[row]:
            other = row
        weight, weight_2 = rows.weight[row], rows.weight[other] if other > row else ZERO
        start, start_2 = np.uint64(rows.plane[row]) * a_plane, np.uint64(rows.plane[other]) * a_plane
        for i in range(a_plane):
            state[i], state[second + i] = planes[start + i], planes[start_2 + i]
        link = a_link
        for joint in range(joints):
            c, s = rows.first[row, joint], rows.second[row, joint]
            c_2, s_2 = rows.first[other, joint], rows.second[other, joint]
            if program.prismatic[joint]:
                for i in range(lanes):
                    state[at_f + i] += c * state[at_z + i]
                    state[second + at_f + i] += c_2 * state[second + at_z + i]
                c, s, c_2, s_2 = ONE, ZERO, ONE, ZERO
            if joint == joints - 1:
                break
            for i in range(lanes):
                k, a, b = link + i, i, second + i
                xx, xy, xz = links[k + o_xx], links[k + o_xy], links[k + o_xz]
                yx, yy, yz = links[k + o_yx], links[k + o_yy], links[k + o_yz]
                zx, zy, zz = links[k + o_zx], links[k + o_zy], links[k + o_zz]
                tx, ty, tz = links[k + o_tx], links[k + o_ty], links[k + o_tz]
                state[at_x + a], state[at_y + a], state[at_z + a], state[at_f + a] = _step(
                    s, c, state[at_x + a], state[at_y + a], state[at_z + a], state[at_f + a],
                    xx, xy, xz, yx, yy, yz, zx, zy, zz, tx, ty, tz,
                )  # fmt: skip
                state[at_x + b], state[at_y + b], state[at_z + b], state[at_f + b] = _step(
                    s_2, c_2, state[at_x + b], state[at_y + b], state[at_z + b], state[at_f + b],
                    xx, xy, xz, yx, yy, yz, zx, zy, zz, tx, ty, tz,
                )  # fmt: skip
            link += a_link
        reading, reading_2 = rows.reading[row], rows.reading[other]
        is_range = rows.readout[row] == RANGE
        link += np.uint64(rows.mount[row]) * a_link
        at, at_2 = np.uint64(rows.sensor[row]) * a_sensor, np.uint64(rows.sensor[other]) * a_sensor
        for i in range(lanes):
            k, a, b = link + i, i, second + i
            zx, zy, zz = links[k + o_zx], links[k + o_zy], links[k + o_zz]
            tx, ty, tz = links[k + o_tx], links[k + o_ty], links[k + o_tz]
            x, y = turned(s, c, state[at_x + a], state[at_y + a])
            f = moved_offset(x, y, state[at_z + a], state[at_f + a], tx, ty, tz)
            nz = along(x, y, state[at_z + a], zx, zy, zz)
            x, y = turned(s_2, c_2, state[at_x + b], state[at_y + b])
            f_2 = moved_offset(x, y, state[at_z + b], state[at_f + b], tx, ty, tz)
            nz_2 = along(x, y, state[at_z + b], zx, zy, zz)
            residual, residual_2 = f - reading, f_2 - reading_2
            if is_range:
                residual = range_residual(nz, f, sensor[at + i], sensor[at + lanes + i], reading)
                residual_2 = range_residual(nz_2, f_2, sensor[at_2 + i], sensor[at_2 + lanes + i], reading_2)
            square, square_2 = weight * residual * residual, weight_2 * residual_2 * residual_2
            value, value_2 = robust(square, loss), robust(square_2, loss)
            if single:
                state[at_x + a], state[at_x + b] = value, value_2
            else:
                costs[i] += value + value_2
        if single:  # in a loop of its own, or all of the one before would go through half as many numbers at once
            for i in range(lanes):
                costs[i] += wide(state[at_x + i]) + wide(state[second + at_x + i])
        row = other + 1


@compiled
def sweep(program, rows, work, members, costs):
    """Writes the cost of every member: the weighted sum of squared residuals and of squared corrections
    (paper, eq. 12 and 22).

    Args:
        program: the `Program`.
        rows: the `Rows`.
        work: the thread's `Workspace`.
        members: (parameters, lanes) corrections, lanes whole tiles; one row at least, be it unused.
        costs: (lanes,) out, in double precision: what one missed beam costs would drown all else in a single sum.
    """
    lanes = np.int64(lanes_of(members))
    for start in range(0, members.shape[1], lanes):
        build_links(program, members, start, work.links, work.scratch)
        build_planes(program, members, start, work.links, work.planes)
        build_sensor(program, members, start, work.sensor)
        tile = costs[start : start + lanes]
        for i in range(lanes):
            work.costs[i] = 0.0
        for parameter in range(program.prior_weight.shape[0]):
            weight = program.prior_weight[parameter]
            correction = members[parameter, start : start + lanes]
            for i in range(lanes):
                work.costs[i] += wide(weight * correction[i] * correction[i])
        _sweep_tile(program, rows, work.planes, work.links, work.sensor, work.state, work.costs)
        for i in range(lanes):
            tile[i] = work.costs[i]
