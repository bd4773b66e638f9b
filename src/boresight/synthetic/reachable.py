"""Points at unknown places that are touched, put where the arm can touch them."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import replace

import numpy as np

from boresight.geometry import Point
from boresight.sensing import Cell, PointContact

WITHIN = 0.5
"""Share of the joints' ranges, about their middles, in which the arm touches such a point: others reach it too."""


def with_reachable_points(cell: Cell, unknown: Set[str], seed: int) -> Cell:
    """Returns the cell with every point that is touched and unknown where the tip is in some configuration.

    Args:
        cell: the nominal cell.
        unknown: names of unknown parameters.
        seed: of the configurations.
    """
    touched = {
        aim.target: place
        for place, aim in enumerate(cell.aims)
        if isinstance(cell.sensors[aim.sensor], PointContact) and f"{aim.target}.x" in unknown
    }
    if not touched:
        return cell
    slides = np.array([joint.type == "prismatic" for joint in cell.arm.driven])
    limits = np.where(slides[:, None], cell.arm.limits, np.clip(cell.arm.limits, -np.pi, np.pi))
    middle, half = limits.mean(axis=1), 0.5 * WITHIN * np.ptp(limits, axis=1)
    random = np.random.Generator(np.random.Philox(np.random.SeedSequence((seed, len(cell.targets)))))
    joints = random.uniform(middle - half, middle + half, (len(touched), len(middle)))
    tips = cell.poses(joints, None, np.array(list(touched.values())))[:, :3, 3]
    placed = {name: Point((float(x), float(y), float(z))) for name, (x, y, z) in zip(touched, tips, strict=True)}
    return replace(cell, targets={name: placed.get(name, target) for name, target in cell.targets.items()})
