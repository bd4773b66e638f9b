"""A plane handed from link to link: the scalar steps that predict a reading.

Instead of carrying the tool to the base (4x4 products, a point and a beam), carry the plane (n, f) from
the base to the tool. A frame change p = R p' + t turns n·p + f = 0 into n' = R^T n, f' = f + n·t. In the
sensor's frame, whose beam leaves the origin along z, the range is h = -f / n_z (paper, eq. 9), and f alone
is the signed distance of the sensor from the plane, which for the planes x = 0, y = 0, z = 0 is its
position. A link costs 16 multiply-adds. A point is handed on in the same way, c' = R^T (c - t), and its distance
from the sensor is |c|.

These functions are the one source of the hot loop, whatever it is compiled for.
"""

from __future__ import annotations

import math

import numpy as np

from boresight.kernels.compiling import compiled
from boresight.kernels.programs import MISSED, ONE, TWO, ZERO

_MISSED = np.float32(MISSED)


@compiled
def turned(s, c, u, v):
    """Returns two components after a turn in their plane: of a normal seen after a joint's turn about z, or
    of a rotation's two columns that a turn about the third mixes (paper, eq. 1).
    """
    return c * u + s * v, c * v - s * u


@compiled
def along(nx, ny, nz, ax, ay, az):
    """Returns the component of a normal along an axis: one row of n' = R^T n."""
    return nx * ax + ny * ay + nz * az


@compiled
def moved_offset(nx, ny, nz, f, tx, ty, tz):
    """Returns a plane's offset [m] as seen from a frame whose origin lies at t [m]."""
    return f + nx * tx + ny * ty + nz * tz


@compiled
def completed(x, y, z, sign, is_x, is_y, is_z):
    """Returns a unit normal of which one component is dropped, and follows from |n| = 1 (paper, eq. 19).

    Where the other two alone are longer than 1, it is 0 and they are scaled back.

    Args:
        x: first component.
        y: second.
        z: third.
        sign: of the dropped one, 1 or -1; itself, it is not read.
        is_x: whether it is the first.
        is_y: whether it is the second.
        is_z: whether it is the third.
    """
    x, y, z = ZERO if is_x else x, ZERO if is_y else y, ZERO if is_z else z
    squares = x * x + y * y + z * z
    scale = ONE / math.sqrt(max(squares, ONE))
    last = sign * math.sqrt(max(ONE - squares, ZERO))
    return last if is_x else scale * x, last if is_y else scale * y, last if is_z else scale * z


@compiled
def range_residual(nz, f, bias, gain, reading):
    """Returns predicted minus measured range [m], `MISSED` where the beam looks away from its plane."""
    hits = f * nz < ZERO
    safe = nz if hits else ONE
    return bias - gain * f / safe - reading if hits else _MISSED


@compiled
def robust(square, loss):
    """Returns a squared residual counted by size beyond `loss` (pseudo-Huber), or as it is where `loss` is 0."""
    return TWO * loss * (math.sqrt(ONE + square / loss) - ONE) if loss > ZERO else square


@compiled
def wide(number):
    """Returns a number in double precision, in which sums are kept."""
    return np.float64(number)
