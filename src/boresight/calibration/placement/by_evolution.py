"""Unknown frames and points that only a search over all of them finds: of draw wires, and of points.

Evolution searches the unknown numbers alone, geometry nominal, over every orientation and as far as the readings could
come from; least squares then finishes.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from boresight.calibration.campaign import Freedom
from boresight.calibration.placement.settling import NOMINAL_STD_M, settled
from boresight.calibration.problem import Problem
from boresight.geometry import Plane
from boresight.search import DifferentialEvolution, Stops, evolve
from boresight.sensing import Cell, Readings

ROWS = 60
"""Rows that the evolution looks at: more would not make frames plainer."""

RUNS = 6
"""Independent runs; the search ends early when two agree."""


def placed_by_evolution(cell: Cell, readings: Readings, names: tuple[str, ...], seed: int, runs: int = RUNS) -> Cell:
    """Returns the cell with its unknown numbers where the readings put them, geometry nominal.

    Args:
        cell: the nominal cell.
        readings: measured values.
        names: the unknown parameters.
        seed: of the evolution.
        runs: how many at most.
    """
    few = readings.chosen(np.unique(np.linspace(0, len(readings) - 1, min(ROWS, len(readings))).astype(int)))
    alike = replace(few, std=np.where(few.read, NOMINAL_STD_M, np.inf))
    widths = {"angle": np.pi, "length": _span(cell, readings)}
    quantity = {parameter.name: parameter.quantity for parameter in cell.parameters}
    freedoms = tuple(Freedom(name, widths[quantity[name]], None) for name in names)
    best = None
    for run in range(runs):
        wide = Problem(cell, alike, freedoms)
        rough = evolve(
            wide.robust_cost,
            wide.box,
            DifferentialEvolution(population=20 * len(names)),
            Stops(400),
            seed=seed,
            run=run,
        )
        candidate = settled(wide.fitted(rough.best), few, names)
        if best is not None and abs(candidate[1] - best[1]) <= 1e-3 * best[1] + 1e-9:
            best = min(best, candidate, key=lambda found: found[1])
            break
        best = candidate if best is None or candidate[1] < best[1] else best
    assert best is not None
    return settled(best[0], readings, names)[0]


def _span(cell: Cell, readings: Readings) -> float:
    """Returns how far [m] an unknown origin may lie: the arm's reach and the farthest thing measured."""
    offsets = [
        abs(target.offset) if isinstance(target, Plane) else float(np.linalg.norm(target.xyz))
        for target in cell.targets.values()
    ]
    return 1.5 * (cell.arm.reach + float(np.max(np.abs(readings.values))) + max(offsets, default=0.0))
