"""Where the base, sensors, markers and points stand when nobody has measured it: found from the data, without a guess.

Evolution searches the unknown frames alone, geometry nominal, over every orientation and as far as the
readings could come from; least squares then finishes. The same search serves every sensor and every
combination of unknown numbers, which closed forms do not.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from boresight.calibration.campaign import Freedom
from boresight.calibration.problem import MISSED_M, Problem
from boresight.calibration.robust import fit
from boresight.calibration.thinning import thinned
from boresight.errors import InputError
from boresight.geometry import Plane
from boresight.inference import listed
from boresight.search import DifferentialEvolution, Stops, evolve
from boresight.sensing import Cell, Readings

_ROWS = 60
"""Rows that the evolution looks at: more would not make frames plainer."""

_NOISE_M = 1e-3
"""Standard deviation [m] that every reading has here: nominal geometry is off by about that much, the best
reading no less than the worst."""

_RUNS = 6
"""Independent runs; the search ends early when two agree."""


def find_frames(cell: Cell, readings: Readings, unknown: frozenset[str], seed: int) -> Cell:
    """Returns the cell with its unknown frames where the readings put them, geometry nominal.

    Args:
        cell: the nominal cell, unknown numbers at zero.
        readings: measured values; of many, some stand for all (`thinning`), since nominal geometry is off by more
            than the rest could add.
        unknown: the unknown parameters of the base, mounts and points, and unknown offsets.
        seed: of the evolution.

    Raises:
        InputError: no frames explain the readings at all.
    """
    names = tuple(name for name in cell.index if name in unknown)
    if not names:
        return cell
    readings = replace(readings, std=np.where(readings.read, _NOISE_M, np.inf)).chosen(thinned(readings))
    few = readings.chosen(np.unique(np.linspace(0, len(readings) - 1, min(_ROWS, len(readings))).astype(int)))
    if set(names) <= set(cell.offsets):  # they add to readings: a straight line leads there from anywhere
        return _settle(cell, readings, names)[0]
    widths = {"angle": np.pi, "length": _span(cell, readings)}
    quantity = {parameter.name: parameter.quantity for parameter in cell.parameters}
    freedoms = tuple(Freedom(name, widths[quantity[name]], None) for name in names)
    best = None
    for run in range(_RUNS):
        wide = Problem(cell, few, freedoms)
        rough = evolve(
            wide.robust_cost,
            wide.box,
            DifferentialEvolution(population=20 * len(names)),
            Stops(400),
            seed=seed,
            run=run,
        )
        candidate = _settle(wide.fitted(rough.best), few, names)
        if best is not None and abs(candidate[1] - best[1]) <= 1e-3 * best[1] + 1e-9:
            best = min(best, candidate, key=lambda found: found[1])
            break
        best = candidate if best is None or candidate[1] < best[1] else best
    assert best is not None
    found = best[0]
    if np.isnan(found.errors(few)).mean() > 0.5:
        raise InputError(
            f"no placement of {listed(names)} explains the readings: with the best one found, most beams look away "
            "from their planes; check the joint columns, their units and the planes"
        )
    return _settle(found, readings, names)[0]


def _settle(cell: Cell, readings: Readings, names: tuple[str, ...]) -> tuple[Cell, float]:
    """Returns the frames after robust least squares from where they are, and the sum of absolute errors [m]."""
    for _ in range(2):
        problem = Problem(cell, readings, tuple(Freedom(name, None, None) for name in names))
        found = fit(problem, np.zeros(len(names)))
        cell = problem.fitted(found.x)
    return cell, float(np.sum(np.abs(np.nan_to_num(found.problem.errors(found.x), nan=MISSED_M))))


def _span(cell: Cell, readings: Readings) -> float:
    """Returns how far [m] an unknown origin may lie: the arm's reach and the farthest thing measured."""
    offsets = [
        abs(target.offset) if isinstance(target, Plane) else float(np.linalg.norm(target.xyz))
        for target in cell.targets.values()
    ]
    return 1.5 * (cell.arm.reach + float(np.max(np.abs(readings.values))) + max(offsets, default=0.0))
