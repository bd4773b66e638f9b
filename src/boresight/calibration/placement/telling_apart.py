"""What is said where the readings fit two placements alike."""

from __future__ import annotations

import numpy as np

from boresight.geometry import Plane
from boresight.inference import listed
from boresight.sensing import Cell

SQUARE = 0.15
"""Planes whose normals' cosine is below this are as good as square to each other."""


def alike_in_words(cells: list[Cell], names: tuple[str, ...], ratios: tuple[float, float]) -> str:
    """Returns the sentence that refuses, and what would tell the placements apart.

    Args:
        cells: the cell in each placement, the best first.
        names: the unknown parameters.
        ratios: what the best two leave with the geometry free, over the stated noise.
    """
    frames = [frame for frame in ("base", *cells[0].mounts) if any(name.startswith(f"{frame}.") for name in names)]
    return (
        f"the readings fit {len(cells)} placements of {listed(frames)} alike (residuals {ratios[0]:.2g}x and "
        f"{ratios[1]:.2g}x the stated noise with the geometry free): {_difference(cells)}. {_advice(cells[0], frames)}"
    )


def _difference(cells: list[Cell]) -> str:
    first, second = cells[0], cells[1]
    sides = [
        name
        for name, plane in first.targets.items()
        if isinstance(plane, Plane) and _side(first, plane) != _side(second, plane)
    ]
    stands = " or ".join(_stands(cell) for cell in cells[:2])
    side = f", on the other side of {listed(sides)}" if sides else ""
    return f"the base stands at {stands}{side}" if first.base != second.base else "they differ in the mount alone"


def _stands(cell: Cell) -> str:
    x, y, z = cell.base.xyz
    roll, pitch, yaw = np.rad2deg(cell.base.rpy)
    return f"({x:.2f}, {y:.2f}, {z:.2f}) m, rpy ({roll:.0f}, {pitch:.0f}, {yaw:.0f})°"


def _side(cell: Cell, plane: Plane) -> bool:
    return bool(plane.height(np.asarray(cell.base.xyz)) > 0.0)


def _advice(cell: Cell, frames: list[str]) -> str:
    normals = np.array([plane.normal for plane in cell.targets.values() if isinstance(plane, Plane)])
    known = f"state {listed([f'`{frame}`' for frame in frames])} roughly, with xyz_std and rpy_std beside"
    if len(normals) < 3:
        return f"Aim at a third plane that is neither square nor parallel to the others, or {known}"
    cosines = np.abs(normals @ normals.T)[np.triu_indices(len(normals), 1)]
    if np.count_nonzero(cosines < SQUARE) >= 2:
        return f"Planes that are square to each other look the same from either side: tilt one of them, or {known}"
    return f"Take rows at configurations that differ more in all joints, or {known}"


def mirrored_in_words(chosen: Cell, others: list[Cell]) -> str:
    """Returns the sentence that says which of several places of the base was taken, where only that differs."""
    return (
        f"The base may as well stand at {_stands(others[0])} instead of {_stands(chosen)}: "
        f"{listed([f'`{name}`' for name in chosen.targets])} cannot tell which. Nothing that is relative to the arm "
        f"depends on it. {_advice(chosen, ['base'])}."
    )
