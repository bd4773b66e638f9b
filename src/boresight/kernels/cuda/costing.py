"""What one member costs, as one thread computes it: links and planes in registers, readings one by one.

Everything that a shape fixes (how many joints, planes, sensors, mounts there are) is a constant when this is compiled:
loops over joints unroll, and numbers that are indexed by constants stay in registers. What is rare (several planes,
mounts or sensors, prismatic joints, points and normals) costs nothing where it does not occur.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import cuda, from_dtype

from boresight.kernels.carrying import along, completed, moved_offset, range_residual, robust, turned
from boresight.kernels.cuda.batches import Shape
from boresight.kernels.programs import COMPONENT, DISTANCE, FIXED, OFFSET, POINT, RANGE, TURN
from boresight.kernels.trigonometry import SMALL, sincos, small_sincos


def cost_function(shape: Shape, real: type[np.floating]) -> Any:
    """Returns the device function `cost(program, rows, run, trials, lane)` of a shape in a precision.

    Its program and rows have a leading axis, the run, wherever runs differ; trials are (runs, parameters, members).
    """
    joints, segments, planes, sensors = shape.joints, shape.segments, shape.planes, shape.sensors
    one_plane, one_sensor, one_mount = planes == 1, sensors == 1, shape.mounts == 1
    of_links, of_planes, of_sensors = 12 * segments, 4 * planes, 2 * sensors
    slides, others = shape.slides, shape.others
    parameters, members = shape.parameters, shape.members
    zero, one, kind = real(0.0), real(1.0), from_dtype(np.dtype(real))

    @cuda.jit(device=True)
    def moved(value, parameter, trials, run, lane):
        if parameter == FIXED:
            return value
        return value + trials[run, parameter * members + lane]

    @cuda.jit(device=True)
    def angle(program, run, motion, trials, lane):
        """Returns sine and cosine of a motion's angle."""
        sine, cosine = program.motion_sine[run, motion], program.motion_cosine[run, motion]
        parameter = program.motion_parameter[motion]
        if parameter == FIXED:
            return sine, cosine
        correction = np.float64(trials[run, parameter * members + lane])
        if abs(correction) > SMALL:
            s, c = sincos(np.float64(program.motion_value[run, motion]) + correction)
            return real(s), real(c)
        s, c = small_sincos(correction)
        s, c = real(s), real(c)
        return sine * c + cosine * s, cosine * c - sine * s

    @cuda.jit(device=True)
    def build(program, run, trials, lane, links):
        """Writes the constant transform of every segment: R column by column, then t."""
        for segment in range(segments):
            xx, xy, xz, yx, yy, yz, zx, zy, zz = one, zero, zero, zero, one, zero, zero, zero, one
            tx, ty, tz = zero, zero, zero
            for motion in range(program.segment_start[segment], program.segment_start[segment + 1]):
                axis = program.motion_axis[motion]
                if program.motion_kind[motion] == TURN:
                    s, c = angle(program, run, motion, trials, lane)
                    if axis == 0:
                        yx, zx = turned(s, c, yx, zx)
                        yy, zy = turned(s, c, yy, zy)
                        yz, zz = turned(s, c, yz, zz)
                    elif axis == 1:
                        zx, xx = turned(s, c, zx, xx)
                        zy, xy = turned(s, c, zy, xy)
                        zz, xz = turned(s, c, zz, xz)
                    else:
                        xx, yx = turned(s, c, xx, yx)
                        xy, yy = turned(s, c, xy, yy)
                        xz, yz = turned(s, c, xz, yz)
                else:
                    length = moved(
                        program.motion_value[run, motion], program.motion_parameter[motion], trials, run, lane
                    )
                    if axis == 0:
                        tx, ty, tz = tx + length * xx, ty + length * xy, tz + length * xz
                    elif axis == 1:
                        tx, ty, tz = tx + length * yx, ty + length * yy, tz + length * yz
                    else:
                        tx, ty, tz = tx + length * zx, ty + length * zy, tz + length * zz
            k = 12 * segment
            links[k], links[k + 1], links[k + 2] = xx, xy, xz
            links[k + 3], links[k + 4], links[k + 5] = yx, yy, yz
            links[k + 6], links[k + 7], links[k + 8] = zx, zy, zz
            links[k + 9], links[k + 10], links[k + 11] = tx, ty, tz

    @cuda.jit(device=True)
    def place(program, run, plane, trials, lane, links, seen):
        """Writes a plane or point as seen from the first joint's axis."""
        of = program.plane_parameter
        x = moved(program.plane[run, plane, 0], of[plane, 0], trials, run, lane)
        y = moved(program.plane[run, plane, 1], of[plane, 1], trials, run, lane)
        z = moved(program.plane[run, plane, 2], of[plane, 2], trials, run, lane)
        f = moved(program.plane[run, plane, 3], of[plane, 3], trials, run, lane)
        dropped = program.plane_dropped[plane]
        if dropped == POINT:
            x, y, z = x - links[9], y - links[10], z - links[11]
        else:
            if of[plane, 0] != FIXED or of[plane, 1] != FIXED or of[plane, 2] != FIXED:
                sign = -one if program.plane[run, plane, dropped] < zero else one
                x, y, z = completed(x, y, z, sign, dropped == 0, dropped == 1, dropped == 2)
            f = moved_offset(x, y, z, f, links[9], links[10], links[11])
        seen[4 * plane] = along(x, y, z, links[0], links[1], links[2])
        seen[4 * plane + 1] = along(x, y, z, links[3], links[4], links[5])
        seen[4 * plane + 2] = along(x, y, z, links[6], links[7], links[8])
        seen[4 * plane + 3] = f

    @cuda.jit(device=True)
    def other_residual(program, rows, run, row, links, x, y, z, bias, gain):
        """Returns the residual of a reading off a carried point or normal."""
        kind = rows.readout[run, row]
        share = one if kind == DISTANCE else zero  # of a link's shift: a point is shifted, a normal is not
        for joint in range(joints):
            c, s = rows.first[run, row, joint], rows.second[run, row, joint]
            if program.prismatic[joint]:
                z = z - share * c
                c, s = one, zero
            x, y = turned(s, c, x, y)
            k = 12 * (joint + 1)
            if joint == joints - 1:
                k += 12 * rows.mount[run, row]
            u, v, w = x - share * links[k + 9], y - share * links[k + 10], z - share * links[k + 11]
            x = along(u, v, w, links[k], links[k + 1], links[k + 2])
            y = along(u, v, w, links[k + 3], links[k + 4], links[k + 5])
            z = along(u, v, w, links[k + 6], links[k + 7], links[k + 8])
        if kind == DISTANCE:
            return bias + gain * math.sqrt(x * x + y * y + z * z) - rows.reading[run, row]
        component = x if kind == COMPONENT else y if kind == COMPONENT + 1 else z
        return component - rows.reading[run, row]

    @cuda.jit(device=True)
    def plane_residual(program, rows, run, row, links, x, y, z, f, bias, gain):
        """Returns the residual of a reading off a carried plane: a range or an offset."""
        c, s = one, zero
        for joint in range(joints):
            c, s = rows.first[run, row, joint], rows.second[run, row, joint]
            if slides and program.prismatic[joint]:
                f = f + c * z
                c, s = one, zero
            if joint < joints - 1:
                k = 12 * (joint + 1)
                u, v = turned(s, c, x, y)
                f = moved_offset(u, v, z, f, links[k + 9], links[k + 10], links[k + 11])
                x = along(u, v, z, links[k], links[k + 1], links[k + 2])
                y = along(u, v, z, links[k + 3], links[k + 4], links[k + 5])
                z = along(u, v, z, links[k + 6], links[k + 7], links[k + 8])
        k = 12 * joints
        if not one_mount:
            k += 12 * rows.mount[run, row]
        u, v = turned(s, c, x, y)
        f = moved_offset(u, v, z, f, links[k + 9], links[k + 10], links[k + 11])
        if rows.readout[run, row] != RANGE:
            return f - rows.reading[run, row]
        nz = along(u, v, z, links[k + 6], links[k + 7], links[k + 8])
        return range_residual(nz, f, bias, gain, rows.reading[run, row])

    @cuda.jit(device=True)
    def cost(program, rows, run, trials, lane):
        links = cuda.local.array(of_links, kind)
        seen = cuda.local.array(of_planes, kind)
        own = cuda.local.array(of_sensors, kind)
        build(program, run, trials, lane, links)
        for plane in range(planes):
            place(program, run, plane, trials, lane, links, seen)
        for slot in range(sensors):
            of, value = program.sensor_parameter, program.sensor_value
            bias = moved(value[run, slot, 0], of[slot, 0], trials, run, lane)
            own[2 * slot] = moved(bias, of[slot, 2], trials, run, lane)
            own[2 * slot + 1] = moved(one + value[run, slot, 1], of[slot, 1], trials, run, lane)
        total = zero
        for parameter in range(parameters):
            correction = trials[run, parameter * members + lane]
            total += program.prior_weight[run, parameter] * correction * correction
        loss = program.loss[run]
        for row in range(rows.reading.shape[1]):
            p = 0 if one_plane else 4 * rows.plane[run, row]
            b = 0 if one_sensor else 2 * rows.sensor[run, row]
            x, y, z, f, bias, gain = seen[p], seen[p + 1], seen[p + 2], seen[p + 3], own[b], own[b + 1]
            if others and rows.readout[run, row] > OFFSET:
                residual = other_residual(program, rows, run, row, links, x, y, z, bias, gain)
            else:
                residual = plane_residual(program, rows, run, row, links, x, y, z, f, bias, gain)
            total += robust(rows.weight[run, row] * residual * residual, loss)
        return total

    return cost
