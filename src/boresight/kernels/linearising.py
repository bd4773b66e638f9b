"""Readings and their exact derivatives at one point: a plane carried to the sensor, and its wrench carried back.

A twist (v, w) of the sensor changes a reading by slope (n·v + (x × n)·w), where n is the plane's normal and x the
point where the beam meets it (or the sensor's origin, for an offset). Carried back link by link, n and x are at every
motion in that motion's own frame, where a turn about an axis e has the twist (0, e) and a shift along it (e, 0): the
derivative is one component of x × n or of n. So a row costs two passes over the motions, whatever is free.

Rows are independent, and nothing but the results is stored, so a million readings need no more memory than that.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from boresight.kernels.compiling import compiled
from boresight.kernels.programs import FIXED, RANGE, TURN


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


@compiled
def _forward(program, point, rows, row, n):
    """Carries a row's plane to the sensor: n in place, the offset [m] returned."""
    plane = rows.plane[row]
    n[0], n[1], n[2] = point.plane[plane, 0], point.plane[plane, 1], point.plane[plane, 2]
    f = point.plane[plane, 3]
    for segment in range(program.segment_start.shape[0] - 1):
        if segment > 0:
            first, second = rows.first[row, segment - 1], rows.second[row, segment - 1]
            if program.prismatic[segment - 1]:
                f += first * n[2]
            else:
                n[0], n[1] = first * n[0] + second * n[1], first * n[1] - second * n[0]
        for m in range(program.segment_start[segment], program.segment_start[segment + 1]):
            axis = program.motion_axis[m]
            if program.motion_kind[m] == TURN:
                i, j = (axis + 1) % 3, (axis + 2) % 3
                s, c = point.sine[m], point.cosine[m]
                n[i], n[j] = c * n[i] + s * n[j], c * n[j] - s * n[i]
            else:
                f += point.value[m] * n[axis]
    return f


@compiled
def _backward(program, point, rows, row, n, x, slope, slopes):
    """Carries a row's wrench back to the world and writes the derivatives by the motions' corrections."""
    for back in range(program.segment_start.shape[0] - 1):
        segment = program.segment_start.shape[0] - 2 - back
        start, stop = program.segment_start[segment], program.segment_start[segment + 1]
        for m in range(stop - 1, start - 1, -1):
            axis, parameter = program.motion_axis[m], program.motion_parameter[m]
            i, j = (axis + 1) % 3, (axis + 2) % 3
            if program.motion_kind[m] == TURN:
                if parameter != FIXED:
                    slopes[parameter] += slope * (x[i] * n[j] - x[j] * n[i])
                s, c = point.sine[m], point.cosine[m]
                n[i], n[j] = c * n[i] - s * n[j], s * n[i] + c * n[j]
                x[i], x[j] = c * x[i] - s * x[j], s * x[i] + c * x[j]
            else:
                if parameter != FIXED:
                    slopes[parameter] += slope * n[axis]
                x[axis] += point.value[m]
        if segment > 0:
            first, second = rows.first[row, segment - 1], rows.second[row, segment - 1]
            if program.prismatic[segment - 1]:
                x[2] += first
            else:
                n[0], n[1] = first * n[0] - second * n[1], second * n[0] + first * n[1]
                x[0], x[1] = first * x[0] - second * x[1], second * x[0] + first * x[1]


@compiled
def _by_plane(point, plane, x, slope, slopes):
    """Writes the derivatives by the plane's corrections, x being in the world."""
    for k in range(3):
        column = point.plane_column[plane, k]
        if column != FIXED:
            by = point.by_plane[plane]
            slopes[column] += slope * (x[0] * by[0, k] + x[1] * by[1, k] + x[2] * by[2, k] + by[3, k])


@compiled
def _by_sensor(program, sensor, distance, slopes):
    """Writes the derivatives of a range by the sensor's own numbers."""
    for number in range(3):
        column = program.sensor_parameter[sensor, number]
        if column != FIXED:
            slopes[column] += distance if number == 1 else 1.0


@compiled
def predict_row(program, point, rows, row, n):
    """Returns whether a row's beam hits, its reading [m] and the slope of its wrench; n is left at the sensor.

    Compiled code that may re-associate sums knows no NaN, so a miss is said and its numbers are 0.
    """
    f = _forward(program, point, rows, row, n)
    if rows.readout[row] != RANGE:
        return True, f, 1.0
    if f * n[2] < 0.0:
        bias, gain = point.bias[rows.sensor[row]], point.gain[rows.sensor[row]]
        return True, bias - gain * f / n[2], -gain / n[2]
    return False, 0.0, 0.0


@compiled
def linearise_row(program, point, rows, row, n, x, slopes):
    """Returns whether a row's beam hits and its predicted reading [m], and writes its derivatives: zeros for a miss."""
    for k in range(slopes.shape[0]):
        slopes[k] = 0.0
    hit, predicted, slope = predict_row(program, point, rows, row, n)
    if hit:
        is_range, sensor = rows.readout[row] == RANGE, rows.sensor[row]
        distance = (predicted - point.bias[sensor]) / point.gain[sensor] if is_range else 0.0
        x[0], x[1], x[2] = 0.0, 0.0, distance
        _backward(program, point, rows, row, n, x, slope, slopes)
        _by_plane(point, rows.plane[row], x, slope, slopes)
        if is_range:
            _by_sensor(program, sensor, distance, slopes)
    return hit, predicted


@compiled
def predict_rows(program, point, rows, predicted, hit):
    """Writes every predicted reading [m], and whether its beam hits."""
    n = np.empty(3)
    for row in range(predicted.shape[0]):
        hit[row], predicted[row], _ = predict_row(program, point, rows, row, n)


@compiled
def linearise_rows(program, point, rows, predicted, hit, slopes):
    """Writes every predicted reading [m], whether its beam hits, and its (parameters,) derivatives."""
    n, x = np.empty(3), np.empty(3)
    for row in range(predicted.shape[0]):
        hit[row], predicted[row] = linearise_row(program, point, rows, row, n, x, slopes[row])
