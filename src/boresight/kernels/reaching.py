"""Joint readings that put an arm's tool at a pose: damped least squares from a start, one pose after the other.

The step solves (J J^T + damping) for the joints (Wampler 1986; Nakamura & Hanafusa 1986), with the damping of
Levenberg and Marquardt: less after a step that helped, more after one that did not. Near the solution it is
Newton's method, so corrections of a calibration take two or three steps.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from boresight.kernels.compiling import compiled
from boresight.kernels.programs import FIXED, TURN

CLOSE = 1e-10
"""Size of the remaining error [m] at which a pose counts as reached exactly."""

MOST_STEPS = 60

SLOW, PATIENCE = 0.8, 4
"""A search that left more than this share of the squared error, this many times, is where it gets no nearer."""

_LEAST_DAMPING, _MOST_DAMPING, _FIRST_DAMPING = 1e-14, 1e6, 1e-6


class Limb(NamedTuple):
    """An arm as flat arrays, its corrections applied.

    Attributes:
        kind: (motions,) `TURN` or `SHIFT`.
        axis: (motions,) 0, 1, 2 for x, y, z.
        value: (motions,) angle [rad] or length [m], added to a joint's reading where there is one.
        sine, cosine: (motions,) of the value, for turns that are no joint's.
        joint: (motions,) column of the joint's reading, or `FIXED`.
        ratio: (motions,) what the reading is multiplied by; several motions may share one.
        lower, upper: (joints,) limits of the readings.
    """

    kind: np.ndarray
    axis: np.ndarray
    value: np.ndarray
    sine: np.ndarray
    cosine: np.ndarray
    joint: np.ndarray
    ratio: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


@compiled
def _move(limb, q, rotation, origin, axes, places):
    """Writes the tool's R (row by row) and p, and every joint motion's axis and a point on it, in the base."""
    for k in range(9):
        rotation[k] = 1.0 if k % 4 == 0 else 0.0
    origin[0] = origin[1] = origin[2] = 0.0
    for m in range(limb.kind.shape[0]):
        axis, joint = limb.axis[m], limb.joint[m]
        amount = limb.value[m]
        if joint != FIXED:
            amount += limb.ratio[m] * q[joint]
            for k in range(3):
                axes[m, k] = rotation[3 * k + axis]
                places[m, k] = origin[k]
        if limb.kind[m] == TURN:
            s, c = limb.sine[m], limb.cosine[m]
            if joint != FIXED:
                s, c = math.sin(amount), math.cos(amount)
            u, v = (axis + 1) % 3, (axis + 2) % 3
            for k in range(3):
                a, b = rotation[3 * k + u], rotation[3 * k + v]
                rotation[3 * k + u] = c * a + s * b
                rotation[3 * k + v] = c * b - s * a
        else:
            for k in range(3):
                origin[k] += amount * rotation[3 * k + axis]


@compiled
def _error(rotation, origin, pose, lever, error):
    """Writes what is missing to a pose, (p - p', lever times the rotation vector) [m], and returns its square."""
    for k in range(3):
        error[k] = pose[k, 3] - origin[k]
        error[3 + k] = 0.0
    if lever > 0.0:
        # D = R_wanted R^T; its rotation vector
        d = np.empty(9)
        for i in range(3):
            for j in range(3):
                d[3 * i + j] = (
                    pose[i, 0] * rotation[3 * j] + pose[i, 1] * rotation[3 * j + 1] + pose[i, 2] * rotation[3 * j + 2]
                )
        x, y, z = d[7] - d[5], d[2] - d[6], d[3] - d[1]
        sine = 0.5 * math.sqrt(x * x + y * y + z * z)
        cosine = 0.5 * (d[0] + d[4] + d[8] - 1.0)
        angle = math.atan2(sine, cosine)
        if sine > 1e-9:
            scale = 0.5 * angle / sine * lever
            error[3], error[4], error[5] = scale * x, scale * y, scale * z
        elif cosine > 0.0:
            error[3], error[4], error[5] = 0.5 * lever * x, 0.5 * lever * y, 0.5 * lever * z
        else:  # half a turn: any axis of R + R^T
            k = 0 if d[0] >= d[4] and d[0] >= d[8] else (1 if d[4] >= d[8] else 2)
            length = 0.0
            for i in range(3):
                error[3 + i] = 0.5 * (d[3 * i + k] + d[3 * k + i]) + (1.0 if i == k else 0.0)
                length += error[3 + i] ** 2
            for i in range(3):
                error[3 + i] *= lever * math.pi / math.sqrt(length)
    total = 0.0
    for k in range(6):
        total += error[k] * error[k]
    return total


@compiled
def _slopes(limb, origin, axes, places, lever, jacobian):
    """Writes the (joints, 6) derivative of the tool's (p, lever times rotation) by every joint's reading."""
    for j in range(jacobian.shape[0]):
        for k in range(6):
            jacobian[j, k] = 0.0
    for m in range(limb.kind.shape[0]):
        j = limb.joint[m]
        if j == FIXED:
            continue
        x, y, z = limb.ratio[m] * axes[m, 0], limb.ratio[m] * axes[m, 1], limb.ratio[m] * axes[m, 2]
        if limb.kind[m] == TURN:
            a, b, c = origin[0] - places[m, 0], origin[1] - places[m, 1], origin[2] - places[m, 2]
            jacobian[j, 0] += y * c - z * b
            jacobian[j, 1] += z * a - x * c
            jacobian[j, 2] += x * b - y * a
            jacobian[j, 3] += lever * x
            jacobian[j, 4] += lever * y
            jacobian[j, 5] += lever * z
        else:
            jacobian[j, 0] += x
            jacobian[j, 1] += y
            jacobian[j, 2] += z


@compiled
def _factor(matrix, size):
    """Turns the lower half of a symmetric positive matrix into its Cholesky factor, in place."""
    for i in range(size):
        for j in range(i + 1):
            total = matrix[i, j]
            for k in range(j):
                total -= matrix[i, k] * matrix[j, k]
            if i == j:
                matrix[i, i] = math.sqrt(max(total, 1e-300))
            else:
                matrix[i, j] = total / matrix[j, j]


@compiled
def _solve(factor, size, vector):
    """Replaces a vector by the solution of (L L^T) x = vector."""
    for i in range(size):
        for k in range(i):
            vector[i] -= factor[i, k] * vector[k]
        vector[i] /= factor[i, i]
    for i in range(size - 1, -1, -1):
        for k in range(i + 1, size):
            vector[i] -= factor[k, i] * vector[k]
        vector[i] /= factor[i, i]


@compiled
def _step(limb, q, jacobian, error, damping, rows, square, step):
    """Writes the damped step of the joints that are free to take it: J^T (J J^T + damping)^-1 error.

    A joint that stands at a limit and is pushed against it keeps still.
    """
    joints = q.shape[0]
    pushed = np.zeros(joints, dtype=np.bool_)
    for _ in range(joints + 1):
        for a in range(rows):
            for b in range(a + 1):
                total = damping if a == b else 0.0
                for j in range(joints):
                    if not pushed[j]:
                        total += jacobian[j, a] * jacobian[j, b]
                square[a, b] = total
        _factor(square, rows)
        solved = np.empty(6)
        for a in range(rows):
            solved[a] = error[a]
        _solve(square, rows, solved)
        again = False
        for j in range(joints):
            step[j] = 0.0
            if not pushed[j]:
                for a in range(rows):
                    step[j] += jacobian[j, a] * solved[a]
                if (q[j] <= limb.lower[j] and step[j] < 0.0) or (q[j] >= limb.upper[j] and step[j] > 0.0):
                    pushed[j] = again = True
        if not again:
            return


@compiled
def _weakest(jacobian, rows, square):
    """Returns the smallest singular value of the Jacobian [m/rad] by inverse iteration, to a few per cent."""
    joints = jacobian.shape[0]
    trace = 0.0
    for a in range(rows):
        for j in range(joints):
            trace += jacobian[j, a] * jacobian[j, a]
    for a in range(rows):
        for b in range(a + 1):
            total = 1e-12 * trace if a == b else 0.0
            for j in range(joints):
                total += jacobian[j, a] * jacobian[j, b]
            square[a, b] = total
    _factor(square, rows)
    vector = np.empty(6)
    for a in range(rows):
        vector[a] = 1.0 + 0.37 * a
    size = 1.0
    for _ in range(8):
        _solve(square, rows, vector)
        size = 0.0
        for a in range(rows):
            size += vector[a] * vector[a]
        size = math.sqrt(size)
        for a in range(rows):
            vector[a] /= size
    return 1.0 / math.sqrt(size)


@compiled
def reach(limb, poses, starts, lever, joints, missing, weakest):
    """Writes the joint readings nearest to each start that bring the tool as near to each pose as can be.

    Args:
        limb: the arm.
        poses: (rows, 4, 4) wanted `T_base_tool`.
        starts: (rows, joints) where to begin [rad or m].
        lever: length [m] by which an angle counts as a distance; 0 to leave orientation free.
        joints: (rows, joints) out: readings within the limits.
        missing: (rows, 2) out: distance [m] and angle [rad] that remain.
        weakest: (rows,) out: smallest singular value of the Jacobian there [m/rad]: how far the tool goes a
            radian in the direction that it hardly can.
    """
    count = starts.shape[1]
    rows = 6 if lever > 0.0 else 3
    rotation, origin, error = np.empty(9), np.empty(3), np.empty(6)
    motions = limb.kind.shape[0]
    axes, places, jacobian = np.empty((motions, 3)), np.empty((motions, 3)), np.empty((count, 6))
    square, step, trial = np.empty((6, 6)), np.empty(count), np.empty(count)
    for row in range(poses.shape[0]):
        q, pose = joints[row], poses[row]
        for j in range(count):
            q[j] = min(max(starts[row, j], limb.lower[j]), limb.upper[j])
        _move(limb, q, rotation, origin, axes, places)
        left = _error(rotation, origin, pose, lever, error)
        _slopes(limb, origin, axes, places, lever, jacobian)
        damping = _FIRST_DAMPING
        slow = 0
        for _ in range(MOST_STEPS):
            if left <= CLOSE * CLOSE or damping > _MOST_DAMPING or slow >= PATIENCE:
                break
            _step(limb, q, jacobian, error, damping, rows, square, step)
            for j in range(count):
                trial[j] = min(max(q[j] + step[j], limb.lower[j]), limb.upper[j])
            _move(limb, trial, rotation, origin, axes, places)
            after = _error(rotation, origin, pose, lever, error)
            if after < left:
                slow += 1 if after > SLOW * left else 0
                left = after
                damping = max(0.1 * damping, _LEAST_DAMPING)
                for j in range(count):
                    q[j] = trial[j]
                _slopes(limb, origin, axes, places, lever, jacobian)
            else:
                damping *= 10.0
                _move(limb, q, rotation, origin, axes, places)
                _error(rotation, origin, pose, lever, error)
        distance = error[0] * error[0] + error[1] * error[1] + error[2] * error[2]
        angle = error[3] * error[3] + error[4] * error[4] + error[5] * error[5]
        missing[row, 0] = math.sqrt(distance)
        missing[row, 1] = math.sqrt(angle) / lever if lever > 0.0 else 0.0
        weakest[row] = _weakest(jacobian, rows, square)
