"""Floating-point operations of the compiled sweep, counted from a `Program`.

An addition, subtraction, multiplication, division or root is one operation, a fused multiply-add two; comparisons,
choices, signs and what is computed with constants alone are none. What is counted is what the steps of
`kernels.carrying`, `kernels.building` and `kernels.trigonometry` compute for one member as they are written,
multiplications by a share of 0 or 1 included, for revolute joints and ranges: `tests/benchmarks` runs the whole sweep
on numbers that count and arrives at the same. An odd last reading, which the loop carries twice, is counted once: the
second is of no use.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from boresight.kernels.programs import POINT, RANGE, TURN, Program, Rows

TURNED, ALONG, MOVED_OFFSET = 6, 5, 6
"""Of one call of the steps of `kernels.carrying`."""

COMPLETED = 11
"""A normal's third component: two squares, two sums, two roots, a division, a difference, and three products."""

SMALL_SINCOS = 22

STEP = TURNED + 3 * ALONG + MOVED_OFFSET
"""A plane through a joint and the link behind it."""

LAST_STEP = TURNED + ALONG + MOVED_OFFSET
"""The last, of which only z and the offset are needed."""

RANGE_RESIDUAL, SQUARE = 5, 3
"""Hit or not, h = -f / n_z with gain and bias, minus the reading; weighed, squared and added."""

TURN_MOTION = 2 + SMALL_SINCOS + 6 + 3 * TURNED
"""A correction taken and looked at, its sine and cosine added to the nominal angle's, and two columns turned."""

SHIFT_MOTION = 2 + 3 * 2
SENSOR, PRIOR = 6, 3


@dataclass(frozen=True)
class Operations:
    """What the cost of one member takes.

    Attributes:
        member: operations that do not depend on the readings: links, planes, sensor, priors.
        reading: operations a reading.
    """

    member: int
    reading: int

    def of(self, members: int, readings: int) -> int:
        """Returns the operations of a population."""
        return members * (self.member + self.reading * readings)


def operations(program: Program, rows: Rows) -> Operations:
    """Returns the operations of one member's cost.

    Args:
        program: of a cell whose joints turn, corrections small, plain squares.
        rows: ranges.
    """
    assert not program.prismatic.any(), "counted for joints that turn"
    assert np.all(rows.readout == RANGE), "counted for ranges"
    assert program.loss == 0.0, "counted for plain squares"
    turns = int(np.count_nonzero(program.motion_kind == TURN))
    shifts = len(program.motion_kind) - turns
    links = turns * TURN_MOTION + shifts * SHIFT_MOTION
    planes = sum(_plane(program, plane) for plane in range(len(program.plane)))
    rest = len(program.sensor_value) * SENSOR + len(program.prior_weight) * PRIOR
    joints = len(program.prismatic)
    return Operations(links + planes + rest, (joints - 1) * STEP + LAST_STEP + RANGE_RESIDUAL + SQUARE)


def _plane(program: Program, plane: int) -> int:
    """Returns the operations that write a plane as seen from the first joint's axis."""
    leans = program.plane_dropped[plane] != POINT and np.any(program.plane_parameter[plane, :3] >= 0)
    corrected = 4 * 2
    shifted = 3 * (2 if program.segment_start[1] > 0 else 1)  # products of constants, where the base does not move
    return corrected + (COMPLETED if leans else 0) + MOVED_OFFSET + shifted + 3 * ALONG
