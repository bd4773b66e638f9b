"""How many poses a second are compensated, on one core.

For each catalogue arm, random configurations within nine tenths of the joints' limits, an arm that is off by 5 mrad and
2 mm at most. Once for the rows that can be reached, which is what a program consists of, and once for all rows: stuck
searches begin again, and poses beyond the arm are searched for in vain.
"""

from __future__ import annotations

import time

import numpy as np

from benchmarks.report import Figure, Report, Table, percent
from boresight.arm import Arm, catalogue
from boresight.compensation import Reached, compensate

TARGET = 50_000
_OFF = {"theta": 0.005, "alpha": 0.005, "d": 0.002, "a": 0.002}


def run(quick: bool) -> Report:
    """Returns poses a second of every catalogue arm."""
    rows, repeats = (2_000, 2) if quick else (50_000, 5)
    lines, figures = [], []
    for name in catalogue.names():
        arm = catalogue.load(name)
        real, joints = _bent(arm), _program(arm, rows)
        found = compensate(arm, real, joints=joints)
        there = found.reached <= Reached.NEAR_SINGULAR
        reachable = _rate(arm, real, joints[there], repeats)
        lines.append(
            (
                name,
                str(len(arm.joints)),
                percent(there.mean()),
                f"{reachable:,.0f}",
                f"{_rate(arm, real, joints, 2):,.0f}",
            )
        )
        if name == "space-arm":
            met = reachable >= TARGET
            figures.append(Figure(f"poses a second, {name}", f"{reachable:,.0f}", f">= {TARGET:,}", met))
    header = ("arm", "joints", "reached", "reached rows, poses/s", "all rows, poses/s")
    return Report(
        "compensation",
        f"{rows:,} poses an arm; best of {repeats}.",
        tuple(figures),
        (Table("Speed", header, tuple(lines)),),
    )


def _bent(arm: Arm) -> Arm:
    random = np.random.default_rng(0)
    return arm.corrected({f"{j.name}.{n}": random.uniform(-w, w) for j in arm.joints for n, w in _OFF.items()})


def _program(arm: Arm, rows: int) -> np.ndarray:
    low, high = 0.9 * np.clip(arm.limits, -np.pi, np.pi).T
    return np.random.default_rng(1).uniform(low, high, (rows, len(low)))


def _rate(arm: Arm, real: Arm, joints: np.ndarray, repeats: int) -> float:
    seconds = []
    for _ in range(repeats):
        began = time.perf_counter()
        compensate(arm, real, joints=joints)
        seconds.append(time.perf_counter() - began)
    return len(joints) / min(seconds)
