"""The kernel against the machine: the sweep over 150 members, beside the measured peak of multiply-adds.

Kernel and peak are measured in turns of equal length, so that both meet the same clock and the same company. 150
members go through in four tiles of 40 lanes, or two of 80 in single precision; the operations of the 10 spare lanes are
not counted, though they are done. A division counts as one operation, though it costs a core more than an addition.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numba
import numpy as np

from benchmarks.report import Table
from benchmarks.speed.cases import MEMBERS, plain
from benchmarks.speed.operations import Operations, operations
from benchmarks.speed.peak import peak_rate, vector_bits
from benchmarks.speed.timing import say
from boresight.calibration.problem import Problem
from boresight.kernels import sweeping
from boresight.kernels.lanes import padded
from boresight.kernels.programs import Program, Rows, aligned, in_precision, workspace
from boresight.kernels.sweeping import sweep
from boresight.search.devices import Device, Precision
from boresight.sensing.compiled import compile_program, compile_rows

READINGS = (35, 100, 1_000, 100_000)
"""Of a batch; of 100,000, the first thousand come again and again, each time in memory of their own."""

SINGLES = (35, 1_000)
"""The same in single precision, beside the peak in single precision."""

DRAWN = 1_000


@dataclass(frozen=True)
class Roof:
    """A kernel beside the machine's peak.

    Attributes:
        readings: how many.
        counted: operations of a member.
        seconds: (runs,) of a sweep over `MEMBERS`.
        peak: (runs,) operations a second of the loop of multiply-adds, measured right after each.
        precision: double or single, of both.
    """

    readings: int
    counted: Operations
    seconds: np.ndarray
    peak: np.ndarray
    precision: Precision = "double"

    @property
    def range_seconds(self) -> float:
        """Median time of a range of a member [s]."""
        return float(np.median(self.seconds)) / (MEMBERS * self.readings)

    @property
    def rate(self) -> float:
        """Operations a second, median."""
        return self.counted.of(MEMBERS, self.readings) / float(np.median(self.seconds))

    @property
    def fraction(self) -> float:
        """Share of the peak, median of runs, each beside its own peak."""
        return float(np.median(self.counted.of(MEMBERS, self.readings) / self.seconds / self.peak))

    @property
    def undisturbed(self) -> float:
        """Share of the peak, the fastest sweep beside the fastest multiply-adds."""
        return self.counted.of(MEMBERS, self.readings) / float(self.seconds.min() * self.peak.max())

    def as_values(self) -> dict[str, object]:
        """Returns it as plain values."""
        return {
            "readings": self.readings,
            "precision": self.precision,
            "nanoseconds_a_range": 1e9 * self.range_seconds,
            "operations_a_member": self.counted.member,
            "operations_a_reading": self.counted.reading,
            "gflops": self.rate / 1e9,
            "peak_gflops": float(np.median(self.peak)) / 1e9,
            "fraction": self.fraction,
            "fraction_of_best_runs": self.undisturbed,
        }


def measure(readings: int, seconds: float, precision: Precision = "double") -> Roof:
    """Returns the sweep over a number of readings, measured for some seconds."""
    say(f"roofline: {readings:,} configurations, {precision} precision")
    real = Device("cpu", precision).real
    problem = plain(min(readings, DRAWN))
    program, rows = (in_precision(each, real) for each in _compiled(problem))
    rows = repeated(rows, readings)
    work, costs = workspace(program), aligned(padded(MEMBERS, real))
    lanes = aligned(len(problem.names), padded(MEMBERS, real), dtype=real)
    box = problem.box
    lanes[:] = np.random.default_rng(0).uniform(box.lower[:, None], box.upper[:, None], lanes.shape)
    sweep(program, rows, work, lanes, costs)
    peak_rate(1e-3, real)
    again = max(1, int(2e-3 / (MEMBERS * readings * 3e-9)))
    times, peaks = [], []
    until = time.perf_counter() + seconds
    while time.perf_counter() < until or len(times) < 5:
        began = time.perf_counter()
        for _ in range(again):
            sweep(program, rows, work, lanes, costs)
        taken = time.perf_counter() - began
        times.append(taken / again)
        peaks.append(peak_rate(taken, real))
    return Roof(readings, operations(program, rows), np.array(times), np.array(peaks), precision)


def kernel_bits() -> int:
    """Returns the width of the vectors in the loop over readings, read off its assembly.

    Compiled again for that, with the same flags: code that comes from the disk does not tell its assembly.
    """
    program, rows = _compiled(plain(READINGS[0]))
    work = workspace(program)
    tile = numba.njit(fastmath=True, error_model="numpy", nogil=True)(sweeping._sweep_tile.py_func)
    tile(program, rows, work.planes, work.links, work.sensor, work.state, work.costs)
    return vector_bits(tile)


def _compiled(problem: Problem) -> tuple[Program, Rows]:
    program = compile_program(problem.cell, problem.names, np.zeros(len(problem.names)))
    return program, compile_rows(problem.cell, problem.readings, np.ones(problem.readings.values.shape))


def repeated(rows: Rows, readings: int) -> Rows:
    """Returns rows that come again until there are as many as asked for, each in memory of its own."""
    place = np.arange(readings) % len(rows.reading)
    return Rows(*(np.ascontiguousarray(array[place]) for array in rows))


def table_of(roofs: list[Roof]) -> Table:
    """Returns the roofline as text."""
    header = (
        "configurations", "precision", "ns a range, median", "min", "operations a range", "in links and planes",
        "Gflop/s", "peak, Gflop/s", "share of peak", "of best runs", "runs",
    )  # fmt: skip
    rows = []
    for roof in roofs:
        shared = roof.counted.member / roof.readings
        least = float(roof.seconds.min()) / (MEMBERS * roof.readings)
        rows.append((
            f"{roof.readings:,}", roof.precision, f"{1e9 * roof.range_seconds:.2f}", f"{1e9 * least:.2f}",
            f"{roof.counted.reading + shared:.0f}", f"{shared:.0f}", f"{roof.rate / 1e9:.1f}",
            f"{float(np.median(roof.peak)) / 1e9:.1f}", f"{100 * roof.fraction:.0f} %",
            f"{100 * roof.undisturbed:.0f} %", f"{len(roof.seconds)}",
        ))  # fmt: skip
    return Table("Roofline of the sweep, 150 members, one core", header, tuple(rows))
