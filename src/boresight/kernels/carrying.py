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

from boresight.kernels.compiling import compiled
from boresight.kernels.programs import MISSED


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
def range_residual(nz, f, bias, gain, reading):
    """Returns predicted minus measured range [m], `MISSED` where the beam looks away from its plane."""
    hits = f * nz < 0.0
    safe = nz if hits else 1.0
    return bias - gain * f / safe - reading if hits else MISSED
