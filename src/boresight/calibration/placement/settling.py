"""Frames after robust least squares from where they are, the geometry nominal."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from boresight.calibration.campaign import Freedom
from boresight.calibration.problem import MISSED_M, Problem
from boresight.calibration.robust import fit
from boresight.sensing import Cell, Readings

NOMINAL_STD_M = 1e-3
"""Standard deviation [m] that every reading has here: nominal geometry is off by about that much, the best reading no
less than the worst."""


def settled(cell: Cell, readings: Readings, names: tuple[str, ...]) -> tuple[Cell, float]:
    """Returns the cell with these frames settled, and the sum of absolute errors [m]."""
    readings = replace(readings, std=np.where(readings.read, NOMINAL_STD_M, np.inf))
    for _ in range(2):
        problem = Problem(cell, readings, tuple(Freedom(name, None, None) for name in names))
        found = fit(problem, np.zeros(len(names)))
        cell = problem.fitted(found.x)
    return cell, float(np.sum(np.abs(np.nan_to_num(found.problem.errors(found.x), nan=MISSED_M))))
