"""The cost of a population over all readings: the innermost loops of the product.

Each reading's plane is carried through a tile's links, its four numbers in the first-level cache between
links. The first link reads the plane itself and the last one needs only f and n_z, so nothing is copied.
One compiled function serves every arm: it does not know the number of links when compiled.
"""

from __future__ import annotations

import numpy as np

from boresight.kernels.building import build_links, build_planes
from boresight.kernels.carrying import along, moved_offset, range_residual, turned
from boresight.kernels.compiling import compiled
from boresight.kernels.programs import LANES, RANGE


@compiled
def _carry_over_turn(c, s, link, state):
    """Carries a tile's plane over a revolute joint and its link, in place."""
    for i in range(LANES):
        x, y = turned(s, c, state[i], state[LANES + i])
        z = state[2 * LANES + i]
        state[3 * LANES + i] = moved_offset(
            x, y, z, state[3 * LANES + i], link[9 * LANES + i], link[10 * LANES + i], link[11 * LANES + i]
        )
        state[i] = along(x, y, z, link[i], link[LANES + i], link[2 * LANES + i])
        state[LANES + i] = along(x, y, z, link[3 * LANES + i], link[4 * LANES + i], link[5 * LANES + i])
        state[2 * LANES + i] = along(x, y, z, link[6 * LANES + i], link[7 * LANES + i], link[8 * LANES + i])


@compiled
def _slide(displacement, state):
    """Carries a tile's plane over the shift of a prismatic joint, in place."""
    for i in range(LANES):
        state[3 * LANES + i] += displacement * state[2 * LANES + i]


@compiled
def _read_range(reading, weight, state, costs):
    for i in range(LANES):
        residual = range_residual(state[2 * LANES + i], state[3 * LANES + i], reading)
        costs[i] += weight * residual * residual


@compiled
def _read_offset(reading, weight, state, costs):
    for i in range(LANES):
        residual = state[3 * LANES + i] - reading
        costs[i] += weight * residual * residual


@compiled
def _sweep_tile(program, rows, work):
    state = work.state
    for row in range(rows.reading.shape[0]):
        start = rows.plane[row] * 4 * LANES
        plane = work.planes[start : start + 4 * LANES]
        for i in range(4 * LANES):
            state[i] = plane[i]
        for joint in range(program.prismatic.shape[0]):
            link = work.links[(joint + 1) * 12 * LANES : (joint + 2) * 12 * LANES]
            if program.prismatic[joint]:
                _slide(rows.first[row, joint], state)
                _carry_over_turn(1.0, 0.0, link, state)
            else:
                _carry_over_turn(rows.first[row, joint], rows.second[row, joint], link, state)
        if rows.readout[row] == RANGE:
            _read_range(rows.reading[row], rows.weight[row], state, work.costs)
        else:
            _read_offset(rows.reading[row], rows.weight[row], state, work.costs)


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
    zero = np.zeros(LANES)
    for start in range(0, members.shape[1], LANES):
        build_links(program, members, start, zero, work.links)
        build_planes(program, members, start, work.links, work.planes)
        tile = costs[start : start + LANES]
        for i in range(LANES):
            work.costs[i] = 0.0
        for parameter in range(members.shape[0]):
            weight = program.prior_weight[parameter]
            correction = members[parameter, start : start + LANES]
            for i in range(LANES):
                work.costs[i] += weight * correction[i] * correction[i]
        _sweep_tile(program, rows, work)
        for i in range(LANES):
            tile[i] = work.costs[i]
