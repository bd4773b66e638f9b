"""Arms, planes and cells drawn at random: the material of the property and oracle tests."""

from __future__ import annotations

import numpy as np

from boresight.arm import Arm, Joint
from boresight.geometry import Frame, Plane
from boresight.sensing import Cell, LaserRanger, Position

CONVENTIONS = ("standard-dh", "modified-dh")


def random_joint(rng: np.random.Generator, number: int) -> Joint:
    """Returns a joint of either type with five generic numbers."""
    theta, alpha, beta = (float(v) for v in rng.uniform(-np.pi, np.pi, 3))
    d, a = (float(v) for v in rng.uniform(-0.5, 0.5, 2))
    if rng.random() < 0.3:
        return Joint(f"j{number}", "prismatic", theta, d, a, alpha, beta, limits=(-0.4, 0.6))
    return Joint(f"j{number}", "revolute", theta, d, a, alpha, beta)


def random_arm(rng: np.random.Generator, joints: int | None = None, convention: str | None = None) -> Arm:
    """Returns an arm of 1 to 8 joints in either convention."""
    count = int(rng.integers(1, 9)) if joints is None else joints
    chosen = str(rng.choice(CONVENTIONS)) if convention is None else convention
    return Arm("random", tuple(random_joint(rng, number) for number in range(1, count + 1)), chosen)


def random_frame(rng: np.random.Generator) -> Frame:
    """Returns a frame of any orientation, up to half a metre along each axis away."""
    x, y, z, roll, pitch, yaw = (float(v) for v in rng.uniform(-1.0, 1.0, 6) * [0.5, 0.5, 0.5, np.pi, 1.5, np.pi])
    return Frame((x, y, z), (roll, pitch, yaw))


def random_plane(rng: np.random.Generator) -> Plane:
    """Returns a plane of any orientation, up to 2 m from the origin."""
    x, y, z = (float(v) for v in rng.normal(size=3))
    return Plane.of((x, y, z), float(rng.uniform(-2.0, 2.0) * np.sqrt(x * x + y * y + z * z)))


def random_cell(
    rng: np.random.Generator, planes: int = 3, sensor: str = "laser_ranger", arm: Arm | None = None
) -> Cell:
    """Returns an arm on a random base, its sensor on a random mount, before random planes."""
    return Cell(
        random_arm(rng) if arm is None else arm,
        LaserRanger(2e-4) if sensor == "laser_ranger" else Position(2e-4),
        random_frame(rng),
        random_frame(rng),
        {f"plane{number}": random_plane(rng) for number in range(planes)},
    )


def random_joints(rng: np.random.Generator, arm: Arm, rows: int) -> np.ndarray:
    """Returns configurations within the arm's limits."""
    lowest, highest = arm.limits.T
    return rng.uniform(lowest, highest, (rows, len(lowest)))


def random_targets(rng: np.random.Generator, cell: Cell, rows: int) -> np.ndarray:
    """Returns the index of a target for each row."""
    return rng.integers(0, max(len(cell.targets), 1), rows)


def random_corrections(rng: np.random.Generator, cell: Cell, size: float = 0.02) -> np.ndarray:
    """Returns a small correction of every parameter."""
    return rng.uniform(-size, size, len(cell.parameters))


def named(cell: Cell, corrections: np.ndarray) -> dict[str, float]:
    """Returns corrections by the parameters' names."""
    return {p.name: float(c) for p, c in zip(cell.parameters, corrections, strict=True)}
