"""Arms, planes and cells drawn at random: the material of the property and oracle tests."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from boresight.arm import Arm, Joint
from boresight.geometry import Frame, Plane, Point, vector_rotation
from boresight.sensing import Cell, DrawWire, LaserRanger, PlaneContact, Pose, Position
from boresight.synthetic import exact_readings

SENSORS = {
    "laser_ranger": LaserRanger(2e-4, bias=0.003, scale=2e-3),
    "draw_wire": DrawWire(1e-4, bias=-0.02, scale=-1e-3),
    "position": Position(2e-4),
    "pose": Pose(2e-4, 5e-4),
    "plane_contact": PlaneContact(5e-5),
}

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
    planar = {f"plane{number}": random_plane(rng) for number in range(planes)}
    points = {f"point{number}": random_point(rng) for number in range(planes)} if sensor == "draw_wire" else {}
    return Cell(
        random_arm(rng) if arm is None else arm,
        SENSORS[sensor],
        random_frame(rng),
        random_frame(rng),
        planar | points,
    )


def random_point(rng: np.random.Generator) -> Point:
    """Returns a point up to 2 m from the origin along each axis."""
    x, y, z = (float(v) for v in rng.uniform(-2.0, 2.0, 3))
    return Point((x, y, z))


def mixed_cell(rng: np.random.Generator, arm: Arm | None = None) -> Cell:
    """Returns an arm that carries every sensor, on two markers, before planes and points."""
    return Cell(
        random_arm(rng) if arm is None else arm,
        SENSORS,
        random_frame(rng),
        {"first": random_frame(rng), "second": random_frame(rng)},
        {"wall": random_plane(rng), "anchor": random_point(rng), "floor": random_plane(rng)},
    )


def steep_rows(rng: np.random.Generator, cell: Cell, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns configurations and aims of which no beam grazes its plane and no wire is very short, where rounding would
    be magnified; perhaps fewer than asked for."""
    joints, target = random_joints(rng, cell.arm, 6 * rows), random_targets(rng, cell, 6 * rows)
    poses = cell.poses(joints, None, target)
    good = np.ones(len(joints), dtype=bool)
    for row, place in enumerate(target):
        aim = cell.aims[place]
        if isinstance(cell.sensors[aim.sensor], LaserRanger):
            good[row] = abs(poses[row, :3, 2] @ cell.targets[aim.target].normal) > 0.3
        elif isinstance(cell.sensors[aim.sensor], DrawWire):
            good[row] = np.linalg.norm(poses[row, :3, 3] - cell.targets[aim.target].xyz) > 0.05
    return joints[good][:rows], target[good][:rows]


def near_readings(rng: np.random.Generator, cell: Cell, rows: int, size: float):
    """Returns readings that are off what the cell predicts by errors of a size [m, and rad of orientations]; 1 m where
    a beam misses."""
    exact = exact_readings(cell, *steep_rows(rng, cell, rows))
    reference = exact.reference
    if reference is not None:
        turned = (exact.channels == 6)[:, None]
        reference = reference @ vector_rotation(np.where(turned, rng.normal(0.0, size, (len(exact), 3)), 0.0))
    off = rng.normal(0.0, size, exact.values.shape) * exact.read
    if reference is not None:
        off[exact.channels == 6, 3:] = 0.0
    return replace(exact, values=np.nan_to_num(exact.values, nan=1.0) + off, reference=reference)


def random_joints(rng: np.random.Generator, arm: Arm, rows: int) -> np.ndarray:
    """Returns configurations within the arm's limits."""
    lowest, highest = arm.limits.T
    return rng.uniform(lowest, highest, (rows, len(lowest)))


def random_targets(rng: np.random.Generator, cell: Cell, rows: int) -> np.ndarray:
    """Returns the index of an aim for each row: of a target, for a ranger."""
    return rng.integers(0, len(cell.aims), rows)


def random_corrections(rng: np.random.Generator, cell: Cell, size: float = 0.02) -> np.ndarray:
    """Returns a small correction of every parameter."""
    return rng.uniform(-size, size, len(cell.parameters))


def named(cell: Cell, corrections: np.ndarray) -> dict[str, float]:
    """Returns corrections by the parameters' names."""
    return {p.name: float(c) for p, c in zip(cell.parameters, corrections, strict=True)}


def compiled_names(cell: Cell) -> list[str]:
    """Returns a cell's parameters but the scales of trackers, which compiled loops take to be right."""
    scales = {f"{name}.scale" for name, sensor in cell.sensors.items() if isinstance(sensor, (Position, Pose))}
    return [parameter.name for parameter in cell.parameters if parameter.name not in scales]
