"""A reading and its exact derivatives, as one thread computes them: `boresight.kernels.linearising` on the card.

A plane is carried to the sensor, and its wrench back; the derivative by a motion is one component of n or of x × n.
"""

from __future__ import annotations

from typing import Any

from numba import cuda

from boresight.kernels.carrying import completed, turned
from boresight.kernels.cuda.batches import Shape
from boresight.kernels.programs import FIXED, MISSED, RANGE, TURN
from boresight.kernels.trigonometry import sincos


def linearising_functions(shape: Shape) -> tuple[Any, Any]:
    """Returns two device functions.

    `stand(program, run, x, motions, planes)` has a block's threads write what does not depend on the row: of each
    motion its length or angle, sine and cosine; of each plane its normal and offset and their derivatives by two
    components of the normal.

    `linearise(program, rows, run, row, motions, planes, x, slopes, place, wanted)` returns the weighted error of a
    row, and writes its derivatives from `slopes[place]` on where they are wanted.
    """
    joints, parameters = shape.joints, shape.parameters

    @cuda.jit(device=True)
    def turned_about(axis, s, c, x, y, z):
        if axis == 0:
            y, z = turned(s, c, y, z)
        elif axis == 1:
            z, x = turned(s, c, z, x)
        else:
            x, y = turned(s, c, x, y)
        return x, y, z

    @cuda.jit(device=True)
    def moved(value, parameter, x):
        return value if parameter == FIXED else value + x[parameter]

    @cuda.jit(device=True)
    def stand(program, run, x, motions, planes):
        for m in range(cuda.threadIdx.x, program.motion_kind.shape[0], cuda.blockDim.x):
            value = moved(program.motion_value[run, m], program.motion_parameter[m], x)
            motions[3 * m] = value
            motions[3 * m + 1], motions[3 * m + 2] = sincos(value)
        for p in range(cuda.threadIdx.x, program.plane.shape[1], cuda.blockDim.x):
            of, k = program.plane_parameter, 7 * p
            a = moved(program.plane[run, p, 0], of[p, 0], x)
            b = moved(program.plane[run, p, 1], of[p, 1], x)
            c = moved(program.plane[run, p, 2], of[p, 2], x)
            dropped = program.plane_dropped[p]
            sign = -1.0 if program.plane[run, p, dropped] < 0.0 else 1.0
            if of[p, 0] != FIXED or of[p, 1] != FIXED or of[p, 2] != FIXED:
                a, b, c = completed(a, b, c, sign, dropped == 0, dropped == 1, dropped == 2)
            last = a if dropped == 0 else b if dropped == 1 else c
            steep = 1.0 / last if abs(last) > 1e-9 else 0.0
            planes[k], planes[k + 1], planes[k + 2] = a, b, c
            planes[k + 3] = moved(program.plane[run, p, 3], of[p, 3], x)
            for component in range(3):  # how the dropped component follows each of the others
                of_it = a if component == 0 else b if component == 1 else c
                planes[k + 4 + component] = 0.0 if component == dropped else -of_it * steep

    @cuda.jit(device=True)
    def by_motions(program, rows, run, row, motions, nx, ny, nz, x, y, z, slope, slopes, place):
        """Carries a wrench back to the world, writes the derivatives, and returns where it meets the plane."""
        for back in range(joints + 1):
            joint = joints - back
            segment = joint
            if back == 0:
                segment += rows.mount[run, row]
            for m in range(program.segment_start[segment + 1] - 1, program.segment_start[segment] - 1, -1):
                axis, parameter = program.motion_axis[m], program.motion_parameter[m]
                if program.motion_kind[m] == TURN:
                    if parameter != FIXED:
                        lever = y * nz - z * ny if axis == 0 else z * nx - x * nz if axis == 1 else x * ny - y * nx
                        slopes[place + parameter] += slope * lever
                    s, c = motions[3 * m + 1], motions[3 * m + 2]
                    nx, ny, nz = turned_about(axis, -s, c, nx, ny, nz)
                    x, y, z = turned_about(axis, -s, c, x, y, z)
                else:
                    if parameter != FIXED:
                        slopes[place + parameter] += slope * (nx if axis == 0 else ny if axis == 1 else nz)
                    value = motions[3 * m]
                    if axis == 0:
                        x += value
                    elif axis == 1:
                        y += value
                    else:
                        z += value
            if joint > 0:
                first, second = rows.first[run, row, joint - 1], rows.second[run, row, joint - 1]
                if program.prismatic[joint - 1]:
                    z += first
                else:
                    nx, ny = turned(-second, first, nx, ny)
                    x, y = turned(-second, first, x, y)
        return x, y, z

    @cuda.jit(device=True)
    def linearise(program, rows, run, row, motions, planes, x, slopes, place, wanted):
        weight = rows.weight[run, row] ** 0.5
        p = 7 * rows.plane[run, row]
        nx, ny, nz, f = planes[p], planes[p + 1], planes[p + 2], planes[p + 3]
        for joint in range(joints + 1):
            segment = joint
            if joint == joints:
                segment += rows.mount[run, row]
            if joint > 0:
                first, second = rows.first[run, row, joint - 1], rows.second[run, row, joint - 1]
                if program.prismatic[joint - 1]:
                    f += first * nz
                else:
                    nx, ny = turned(second, first, nx, ny)
            for m in range(program.segment_start[segment], program.segment_start[segment + 1]):
                axis = program.motion_axis[m]
                if program.motion_kind[m] == TURN:
                    nx, ny, nz = turned_about(axis, motions[3 * m + 1], motions[3 * m + 2], nx, ny, nz)
                else:
                    f += motions[3 * m] * (nx if axis == 0 else ny if axis == 1 else nz)
        if wanted:
            for parameter in range(parameters):
                slopes[place + parameter] = 0.0
        sensor, of = rows.sensor[run, row], program.sensor_parameter
        predicted, distance, slope = f, 0.0, 1.0
        if rows.readout[run, row] == RANGE:
            if not f * nz < 0.0:
                return weight * MISSED
            bias = moved(moved(program.sensor_value[run, sensor, 0], of[sensor, 0], x), of[sensor, 2], x)
            gain = moved(1.0 + program.sensor_value[run, sensor, 1], of[sensor, 1], x)
            distance, slope = -f / nz, -gain / nz
            predicted = bias + gain * distance
            if wanted:
                for number in range(3):
                    if of[sensor, number] != FIXED:
                        slopes[place + of[sensor, number]] += weight * (distance if number == 1 else 1.0)
        if wanted:
            slope *= weight
            u, v, w = by_motions(program, rows, run, row, motions, nx, ny, nz, 0.0, 0.0, distance, slope, slopes, place)
            dropped = program.plane_dropped[rows.plane[run, row]]
            into = u if dropped == 0 else v if dropped == 1 else w
            for component in range(3):
                parameter = program.plane_parameter[rows.plane[run, row], component]
                if parameter != FIXED:
                    along = u if component == 0 else v if component == 1 else w
                    slopes[place + parameter] += slope * (along + into * planes[p + 4 + component])
            parameter = program.plane_parameter[rows.plane[run, row], 3]
            if parameter != FIXED:
                slopes[place + parameter] += slope
        return weight * (predicted - rows.reading[run, row])

    return stand, linearise
