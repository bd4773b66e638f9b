"""Many calibrations of one shape as arrays with a leading axis, the run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from boresight.kernels.breeding import Breeding
from boresight.kernels.programs import OFFSET, Program, Rows

WARP = 32
MOST_THREADS = 256
"""In a block: beyond, its registers would no longer fit for arms of seven joints in double precision."""

REGISTERS = 65536
"""Of a multiprocessor."""

SHARED_BYTES = 48 * 1024
"""What every card gives a block without asking."""

_SAME = (
    "segment_start",
    "motion_kind",
    "motion_axis",
    "motion_parameter",
    "prismatic",
    "plane_parameter",
    "plane_dropped",
    "sensor_parameter",
)
"""What of a program the runs of a batch share."""


class Shape(NamedTuple):
    """What is a constant in compiled code.

    Attributes:
        joints: of the arm.
        segments: joints, mounts and the base.
        mounts: where a sensor may sit.
        motions: elementary ones, in all segments.
        planes: planes and points.
        sensors: sensors, in each session.
        parameters: free ones.
        members: Np.
        elite: how many members stand for the best.
        slides: whether a joint is prismatic.
        others: whether some reading is about a point or a normal.
    """

    joints: int
    segments: int
    mounts: int
    motions: int
    planes: int
    sensors: int
    parameters: int
    members: int
    elite: int
    slides: bool
    others: bool

    @property
    def threads(self) -> int:
        """Threads of a block: whole warps, a member each, or as few members each as can be."""
        passes = -(-self.members // MOST_THREADS)
        return -(-self.members // (passes * WARP)) * WARP

    def in_shared(self, real: type[np.floating]) -> bool:
        """Returns whether the population fits in the block's shared memory."""
        return self.shared_bytes(real) + 20 * self.threads <= SHARED_BYTES

    def registers(self, real: type[np.floating]) -> int:
        """Returns the registers a thread may have, so that a multiprocessor holds several blocks at once.

        Left alone, the compiler takes 230 in single precision and 255 in double, for case 1; at 136 and 200 it keeps
        all but a few of them, and a multiprocessor of an H100 holds three blocks in place of one, and two.
        """
        blocks = 3 if np.dtype(real).itemsize == 4 else 2
        return max(64, min(255, REGISTERS // (blocks * self.threads) // 8 * 8))

    def shared_bytes(self, real: type[np.floating]) -> int:
        """Returns the size of the population and its costs [bytes]."""
        return (self.parameters + 1) * self.members * np.dtype(real).itemsize


class Task(NamedTuple):
    """One calibration.

    Attributes:
        program: how a member becomes links and planes.
        rows: its readings.
        breeding: strategy and box.
        members: Np.
        key: of its random numbers.
    """

    program: Program
    rows: Rows
    breeding: Breeding
    members: int
    key: int

    @property
    def shape(self) -> Shape:
        """Its shape."""
        program = self.program
        joints, segments = len(program.prismatic), len(program.segment_start) - 1
        return Shape(
            joints=joints,
            segments=segments,
            mounts=segments - joints,
            motions=len(program.motion_kind),
            planes=len(program.plane),
            sensors=len(program.sensor_value),
            parameters=len(program.prior_weight),
            members=self.members,
            elite=min(self.breeding.elite, self.members),
            slides=bool(program.prismatic.any()),
            others=bool((self.rows.readout > OFFSET).any()),
        )

    @property
    def kind(self) -> tuple:
        """What it must have in common with those that it can share a batch with."""
        return (
            self.shape,
            len(self.rows.reading),
            tuple(getattr(self.program, name).tobytes() for name in _SAME),
            self.breeding[: self.breeding._fields.index("elite")],
        )


class Batch(NamedTuple):
    """Tasks of one kind.

    Attributes:
        shape: theirs.
        program: theirs, with a leading axis on all numbers that are not structure.
        rows: theirs, with a leading axis.
        breeding: theirs, bounds (runs, parameters).
        keys: (runs,) of their random numbers.
    """

    shape: Shape
    program: Program
    rows: Rows
    breeding: Breeding
    keys: np.ndarray


def batch_of(tasks: Sequence[Task], real: type[np.floating]) -> Batch:
    """Returns tasks of one kind as arrays in a precision."""
    first = tasks[0]

    def stacked(parts: Sequence[Any]) -> Any:
        array = np.stack([np.asarray(part) for part in parts])
        return array.astype(np.int32 if array.dtype.kind in "iu" else real)

    def of_programs(name: str) -> Any:
        if name in _SAME:
            array = getattr(first.program, name)
            return array if array.dtype == np.bool_ else array.astype(np.int32)
        return stacked([getattr(task.program, name) for task in tasks])

    return Batch(
        shape=first.shape,
        program=Program(*(of_programs(name) for name in Program._fields)),
        rows=Rows(*(stacked([getattr(task.rows, name) for task in tasks]) for name in Rows._fields)),
        breeding=first.breeding._replace(
            lower=stacked([task.breeding.lower for task in tasks]),
            upper=stacked([task.breeding.upper for task in tasks]),
        ),
        keys=np.array([task.key for task in tasks], dtype=np.uint64),
    )
