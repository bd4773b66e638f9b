"""Every workload measured, and what is claimed of it."""

from __future__ import annotations

import importlib.util
import time

from benchmarks.report import Report
from benchmarks.speed import batch, end_to_end, identification, least_squares, monte_carlo, roofline, start_up
from benchmarks.speed.cases import EVALUATIONS, MEMBERS
from benchmarks.speed.claims import figures
from benchmarks.speed.lines import Line, table_of
from benchmarks.speed.peak import vector_bits
from benchmarks.speed.peers import missing

FEW_BATCHES = ((35, MEMBERS), (100, MEMBERS), (1_000, MEMBERS), (35, 15_000))
BATCHES = (*FEW_BATCHES[:3], (100_000, MEMBERS), (35, 1_500), (35, 15_000), (35, 1_000_000))
"""Readings and members: both may grow."""

SIZES, FEW_SIZES = (1_000, 10_000, 100_000, 1_000_000), (1_000, 10_000, 100_000)


def measure(quick: bool) -> Report:
    """Returns everything measured."""
    began = time.perf_counter()
    lines: list[Line] = []
    seconds = 0.5 if quick else 5.0
    roofs = [roofline.measure(readings, seconds) for readings in roofline.READINGS]
    roofs += [roofline.measure(readings, seconds, "single") for readings in roofline.SINGLES]
    for readings, members in FEW_BATCHES if quick else BATCHES:
        lines += batch.measure(readings, members, 3 if quick else 7)
    for case in (1, 2):
        lines += identification.measure(case, 1 if quick else 5)
    for readings in (100,) if quick else (100, 100_000):
        lines += least_squares.measure(readings, 3 if quick or readings > 1_000 else 7)
    lines += monte_carlo.measure(300 if quick else 600, 1 if quick else 3)
    lines += start_up.measure(3 if quick else 9, 1 if quick else 2)
    ended, notes = end_to_end.measure(FEW_SIZES if quick else SIZES, 1 if quick else 3)
    kernel, peak = roofline.kernel_bits(), vector_bits()
    minutes = (time.perf_counter() - began) / 60.0
    return Report(
        "speed",
        f"One core unless said, vectors of {kernel} bits in the kernel and {peak} in the peak; "
        f"{EVALUATIONS:,} evaluations an identification. "
        "`ends at` is the median run's error and the worst one's. See the docstrings of benchmarks/speed. "
        f"Measured in {minutes:.0f} minutes; other processes may have shared the machine.",
        figures(lines, roofs, ended),
        (table_of(lines), roofline.table_of(roofs), end_to_end.table_of(ended)),
        tuple(notes + absent()),
        {
            "vector_bits": {"kernel": kernel, "peak": peak},
            "lines": [line.as_values() for line in lines],
            "roofline": [roof.as_values() for roof in roofs],
            "end_to_end": [each.as_values() for each in ended],
        },
    )


def absent() -> list[str]:
    """Returns a note on every peer that is not installed."""
    packages = [*missing(), *([] if importlib.util.find_spec("pyarrow") else ["pyarrow"])]
    return [f"{package} is not installed, so it was left out." for package in packages]
