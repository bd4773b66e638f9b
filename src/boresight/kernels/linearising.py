"""Readings and their exact derivatives at one point: a plane carried to the sensor, and its wrench carried back.

A twist (v, w) of the sensor changes a reading by slope (n·v + (x × n)·w), where n is the plane's normal and x the
point where the beam meets it (or the sensor's origin, for an offset). Carried back link by link, n and x are at every
motion in that motion's own frame, where a turn about an axis e has the twist (0, e) and a shift along it (e, 0): the
derivative is one component of x × n or of n. So a row costs two passes over the motions, whatever is free.

Rows are independent and go through the motions in tiles, side by side, so that the loops over a tile are vector code:
row by row, 25 derivatives took 780 ns a row, side by side they take 75. Nothing is kept beside the results, and these
are asked for block by block.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from boresight.kernels.compiling import compiled
from boresight.kernels.programs import FIXED, RANGE, TURN

TILE = 128
"""Rows side by side: their planes, points and slopes stay in the first-level cache."""


class Point(NamedTuple):
    """Where a program is linearised: everything that does not depend on the row.

    Attributes:
        value: (motions,) angle [rad] or length [m] of each motion, corrections added.
        sine, cosine: (motions,) of the value.
        plane: (planes, 4) unit normal and offset [m] in the world, corrections added.
        by_plane: (planes, 4, 3) derivative of these by the corrections of two components of the normal and the offset.
        plane_column: (planes, 3) columns of these corrections, or `FIXED`.
        bias: (sensors,) of each sensor in each session [m].
        gain: (sensors,) 1 and its relative scale error.
    """

    value: np.ndarray
    sine: np.ndarray
    cosine: np.ndarray
    plane: np.ndarray
    by_plane: np.ndarray
    plane_column: np.ndarray
    bias: np.ndarray
    gain: np.ndarray


class Columns(NamedTuple):
    """The scalar readings as in `boresight.kernels.programs.Rows`, the rows of an array side by side.

    Attributes:
        first: (joints, rows) cos q of a revolute joint, the displacement [m] of a prismatic one.
        second: (joints, rows) sin q of a revolute joint, unused of a prismatic one.
        plane: (rows,) the plane a reading is about.
        sensor: (rows,) the sensor, in its session, that reads.
        readout: (rows,) `RANGE` or `OFFSET`.
        reading: (rows,) measured value [m].
    """

    first: np.ndarray
    second: np.ndarray
    plane: np.ndarray
    sensor: np.ndarray
    readout: np.ndarray
    reading: np.ndarray


@compiled
def _turn(c, s, u, v):
    """Turns the components u and v of a tile's vectors into those in a frame turned by the angle of c and s."""
    for t in range(u.shape[0]):
        u[t], v[t] = c * u[t] + s * v[t], c * v[t] - s * u[t]


@compiled
def _turn_each(c, s, u, v):
    """The same, each of a tile's vectors by an angle of its own."""
    for t in range(u.shape[0]):
        u[t], v[t] = c[t] * u[t] + s[t] * v[t], c[t] * v[t] - s[t] * u[t]


@compiled
def _turn_each_back(c, s, u, v):
    """The inverse of `_turn_each`."""
    for t in range(u.shape[0]):
        u[t], v[t] = c[t] * u[t] - s[t] * v[t], s[t] * u[t] + c[t] * v[t]


@compiled
def _forward(program, point, rows, start, n, f):
    """Carries a tile's planes to the sensor: their normals n and offsets f [m] in place."""
    count = f.shape[0]
    for t in range(count):
        plane = rows.plane[start + t]
        n[0, t], n[1, t], n[2, t] = point.plane[plane, 0], point.plane[plane, 1], point.plane[plane, 2]
        f[t] = point.plane[plane, 3]
    stop = start + count
    for segment in range(program.segment_start.shape[0] - 1):
        if segment > 0:
            first, second = rows.first[segment - 1, start:stop], rows.second[segment - 1, start:stop]
            if program.prismatic[segment - 1]:
                shifted = n[2, :count]
                for t in range(count):
                    f[t] += first[t] * shifted[t]
            else:
                _turn_each(first, second, n[0, :count], n[1, :count])
        for m in range(program.segment_start[segment], program.segment_start[segment + 1]):
            axis = program.motion_axis[m]
            if program.motion_kind[m] == TURN:
                _turn(point.cosine[m], point.sine[m], n[(axis + 1) % 3, :count], n[(axis + 2) % 3, :count])
            else:
                value, shifted = point.value[m], n[axis, :count]
                for t in range(count):
                    f[t] += value * shifted[t]


@compiled
def _backward(program, point, rows, start, n, x, slope, slopes, at):
    """Carries a tile's wrenches back to the world and writes the derivatives by the motions' corrections."""
    count = slope.shape[0]
    for back in range(program.segment_start.shape[0] - 1):
        segment = program.segment_start.shape[0] - 2 - back
        for m in range(program.segment_start[segment + 1] - 1, program.segment_start[segment] - 1, -1):
            axis, parameter = program.motion_axis[m], program.motion_parameter[m]
            i, j = (axis + 1) % 3, (axis + 2) % 3
            if program.motion_kind[m] == TURN:
                xi, xj, ni, nj = x[i, :count], x[j, :count], n[i, :count], n[j, :count]
                if parameter != FIXED:
                    into = slopes[parameter, at : at + count]
                    for t in range(count):
                        into[t] += slope[t] * (xi[t] * nj[t] - xj[t] * ni[t])
                _turn(point.cosine[m], -point.sine[m], ni, nj)
                _turn(point.cosine[m], -point.sine[m], xi, xj)
            else:
                if parameter != FIXED:
                    into, along = slopes[parameter, at : at + count], n[axis, :count]
                    for t in range(count):
                        into[t] += slope[t] * along[t]
                value, shifted = point.value[m], x[axis, :count]
                for t in range(count):
                    shifted[t] += value
        if segment > 0:
            first = rows.first[segment - 1, start : start + count]
            second = rows.second[segment - 1, start : start + count]
            if program.prismatic[segment - 1]:
                shifted = x[2, :count]
                for t in range(count):
                    shifted[t] += first[t]
            else:
                _turn_each_back(first, second, n[0, :count], n[1, :count])
                _turn_each_back(first, second, x[0, :count], x[1, :count])


@compiled
def _by_plane(point, rows, start, x, slope, slopes, at):
    """Writes the derivatives by the planes' corrections, x being in the world."""
    for t in range(slope.shape[0]):
        plane = rows.plane[start + t]
        for k in range(3):
            column = point.plane_column[plane, k]
            if column != FIXED:
                by = point.by_plane[plane]
                effect = x[0, t] * by[0, k] + x[1, t] * by[1, k] + x[2, t] * by[2, k] + by[3, k]
                slopes[column, at + t] += slope[t] * effect


@compiled
def _by_sensor(program, rows, start, distance, weight, slopes, at):
    """Writes the derivatives of ranges by the sensors' own numbers; a missed beam's distance and weight are 0."""
    for t in range(weight.shape[0]):
        if rows.readout[start + t] == RANGE:
            sensor = rows.sensor[start + t]
            for number in range(3):
                column = program.sensor_parameter[sensor, number]
                if column != FIXED:
                    slopes[column, at + t] += weight[t] * (distance[t] if number == 1 else 1.0)


@compiled
def _read(point, rows, start, n, f, hit, predicted, slope, distance):
    """Writes for a tile whether beams hit, predicted readings [m], the slopes of wrenches and the beams' lengths [m].

    Compiled code that may re-associate sums knows no NaN, so a miss is said and its numbers are 0.
    """
    for t in range(f.shape[0]):
        if rows.readout[start + t] != RANGE:
            hit[t], predicted[t], slope[t], distance[t] = True, f[t], 1.0, 0.0
        elif f[t] * n[2, t] < 0.0:
            sensor = rows.sensor[start + t]
            gain, length = point.gain[sensor], -f[t] / n[2, t]
            hit[t], predicted[t] = True, point.bias[sensor] + gain * length
            slope[t], distance[t] = -gain / n[2, t], length
        else:
            hit[t], predicted[t], slope[t], distance[t] = False, 0.0, 0.0, 0.0


@compiled
def predict_rows(program, point, rows, predicted, hit):
    """Writes every predicted reading [m], and whether its beam hits."""
    scratch, n = np.empty((3, TILE)), np.empty((3, TILE))
    for start in range(0, predicted.shape[0], TILE):
        stop = min(start + TILE, predicted.shape[0])
        count = stop - start
        f, slope, distance = scratch[0, :count], scratch[1, :count], scratch[2, :count]
        _forward(program, point, rows, start, n, f)
        _read(point, rows, start, n, f, hit[start:stop], predicted[start:stop], slope, distance)


@compiled
def linearise_rows(program, point, rows, start, weight, missed, block):
    """Writes what least squares needs of some rows, all of it times the rows' weights.

    Args:
        program: the cell.
        point: where.
        rows: all rows.
        start: the first that is wanted.
        weight: (count,) of each that is wanted, on its error and derivatives.
        missed: the error [m] of a beam that misses; its derivatives are 0.
        block: (parameters + 1, count) where the derivatives are written, and last the errors, predicted minus measured.
    """
    free = block.shape[0] - 1
    n, x, scratch, hits = np.empty((3, TILE)), np.empty((3, TILE)), np.empty((4, TILE)), np.empty(TILE, dtype=np.bool_)
    for at in range(0, weight.shape[0], TILE):
        count = min(TILE, weight.shape[0] - at)
        row, own = start + at, weight[at : at + count]
        hit, predicted = hits[:count], scratch[0, :count]
        f, slope, distance = scratch[1, :count], scratch[2, :count], scratch[3, :count]
        for parameter in range(free):
            for t in range(count):
                block[parameter, at + t] = 0.0
        _forward(program, point, rows, row, n, f)
        _read(point, rows, row, n, f, hit, predicted, slope, distance)
        for t in range(count):
            x[0, t], x[1, t], x[2, t] = 0.0, 0.0, distance[t]
            error = predicted[t] - rows.reading[row + t] if hit[t] else missed
            block[free, at + t] = error * own[t]
            slope[t] *= own[t]
            f[t] = own[t] if hit[t] else 0.0
        _by_sensor(program, rows, row, distance, f, block, at)
        _backward(program, point, rows, row, n, x, slope, block, at)
        _by_plane(point, rows, row, x, slope, block, at)
