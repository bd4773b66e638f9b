"""How wrong a nominal arm and its plates are: every independent number drawn afresh for each seed."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from benchmarks.trust.cell import Cell, Plane
from benchmarks.trust.kinematics import Arm


@dataclass(frozen=True)
class Errors:
    """How errors of a kind are distributed.

    Attributes:
        angle, length: standard deviations [rad, m for an arm of usual reach].
        uniform: whether they are uniform rather than normal.
    """

    angle: float
    length: float
    uniform: bool = False

    def draw(self, random: np.random.Generator, std: float, count: int) -> np.ndarray:
        """Returns (count,) errors."""
        half_width = np.sqrt(3.0) * std
        return random.uniform(-half_width, half_width, count) if self.uniform else random.normal(0.0, std, count)


USUAL = Errors(1.5e-3, 1.5e-3)
"""What assembly and handling leave of an arm of a metre."""

AS_PRIOR = Errors(0.05 / np.sqrt(3.0), 0.02 / np.sqrt(3.0), uniform=True)
"""As wide as the product believes where nobody says more: uniform within 0.05 rad and 20 mm."""


def true_arm(nominal: Arm, errors: Errors, size: float, exact: tuple[str, ...], random: np.random.Generator) -> Arm:
    """Returns an arm with errors in theta, d, a, alpha of every link, and in beta for d where axes are parallel.

    Args:
        nominal: the arm that its files describe.
        errors: how large.
        size: what lengths are multiplied by.
        exact: numbers without an error, such as `j1.theta` where it defines the base frame.
        random: where they are drawn from.
    """
    arm = nominal
    for number in ("theta", "alpha", "beta", "d", "a"):
        std = size * errors.length if number in ("d", "a") else errors.angle
        drawn = errors.draw(random, std, nominal.count)
        wrong = np.array([f"j{k + 1}.{number}" not in exact for k in range(nominal.count)])
        if number == "beta":
            wrong &= nominal.parallel
        if number == "d":
            wrong &= ~nominal.parallel
        arm = arm.corrected(number, np.where(wrong, drawn, 0.0))
    return arm


def moved_planes(cell: Cell, angle: float, length: float, random: np.random.Generator) -> Cell:
    """Returns the cell with normals tilted and offsets changed, by normal errors of these sizes [rad, m]."""
    planes = {}
    for name, plane in cell.planes.items():
        normal = plane.normal + np.cross(random.normal(0.0, angle, 3), plane.normal)
        offset = plane.offset + cell.size * random.normal(0.0, length)
        planes[name] = Plane(normal / np.linalg.norm(normal), float(offset))
    return replace(cell, planes=planes)
