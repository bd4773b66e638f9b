"""Arms whose joints give way under gravity, measured in MuJoCo: masses, centres of mass and springs of their own.

Nothing here knows of sags or levers: each link has a mass whose centre lies anywhere in it, each joint a stiffness,
and the arm hangs where the springs hold the weights, found by letting it settle.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import mujoco
import numpy as np
from independent_arms import mjcf

from boresight.arm import catalogue
from boresight.calibration import Campaign
from boresight.geometry import Frame, Plane
from boresight.sensing import Cell, LaserRanger, Position, Readings

STIFFNESS = 2.5e4
"""Of a typical joint [N m/rad]: an arm of 20 kg and a metre then gives way by a few tenths of a millimetre."""

PLANES = {
    "floor": Plane.of((0.05, -0.03, 1.0), 0.9),
    "wall_x": Plane.of((-1.0, 0.15, 0.2), 2.2),
    "wall_y": Plane.of((0.1, -1.0, 0.15), 2.3),
}


@dataclass(frozen=True)
class Weights:
    """What gravity does to an arm.

    Attributes:
        masses: of the links [kg].
        centres: (joints, 3) of mass, in the frame that turns with each joint [m].
        stiffness: of the joints [N m/rad].
        gravity: [m/s²] in the world.
    """

    masses: np.ndarray
    centres: np.ndarray
    stiffness: np.ndarray
    gravity: np.ndarray

    @classmethod
    def drawn(cls, rng: np.random.Generator, cell: Cell, down=(0.0, 0.0, -1.0)) -> Weights:
        """Links lighter towards the tool, which itself weighs 2 kg; centres between the joints and beside the line."""
        count = len(cell.arm.joints)
        masses = np.linspace(5.0, 1.0, count) * rng.uniform(0.7, 1.3, count)
        masses[-1] += 2.0
        along = np.array([[joint.a, 0.0, joint.d] for joint in cell.arm.joints])
        centres = along * rng.uniform(0.3, 0.7, (count, 1)) + rng.normal(0.0, 0.02, (count, 3))
        centres[-1, 2] += 0.08
        return cls(masses, centres, STIFFNESS * rng.uniform(0.5, 1.5, count), 9.81 * np.array(down))


def weighed_model(cell: Cell, weights: Weights) -> mujoco.MjModel:
    """Returns the cell in MuJoCo with its weights."""
    model = mujoco.MjModel.from_xml_string(mjcf(cell))
    moving = model.jnt_bodyid
    model.body_mass[moving], model.body_ipos[moving] = weights.masses, weights.centres
    model.body_sameframe[moving] = 0  # else centres of mass that were compiled at the origin stay there
    model.opt.gravity[:] = weights.gravity
    return model


def settled(cell: Cell, weights: Weights, joints: np.ndarray) -> np.ndarray:
    """Returns the sensor's poses in the world where springs and weights balance."""
    model = weighed_model(cell, weights)
    data = mujoco.MjData(model)
    poses = np.tile(np.eye(4), (len(joints), 1, 1))
    for row, commanded in enumerate(joints):
        data.qpos[:] = commanded
        for _ in range(5):
            mujoco.mj_forward(model, data)
            data.qpos[:] = commanded - data.qfrc_bias / weights.stiffness
        mujoco.mj_forward(model, data)
        poses[row, :3, :3] = data.site("sensor").xmat.reshape(3, 3)
        poses[row, :3, 3] = data.site("sensor").xpos
    return poses


def light_campaign(
    name: str = "iiwa14",
    *,
    seed: int = 0,
    rows: int = 200,
    held: int = 300,
    noise: float = 4.5e-5,
    weight: float = 1.0,
    down=(0.0, 0.0, -1.0),
    base_rpy=(0.0, 0.0, 2.1),
    ranger: bool = False,
    waves: float = 0.0,
) -> Campaign:
    """Returns a campaign of an arm with errors of half a millimetre and a milliradian, and its weights.

    Args:
        name: in the catalogue.
        seed: of everything.
        rows, held: to calibrate with, to validate with.
        noise: of a value [m].
        weight: times its weight; 0 in orbit.
        down: gravity's direction in the world.
        base_rpy: how the arm stands.
        ranger: a laser ranger before three known planes on a known base, else a tracker whose place is unknown.
        waves: standard deviation of each joint's harmonics [rad].
    """
    rng = np.random.default_rng([seed, rows])
    arm = catalogue.load(name)
    off = {
        f"{joint.name}.{number}": float(rng.normal(0.0, std))
        for joint in arm.joints
        for number, std in (("theta", 1e-3), ("alpha", 1e-3), ("a", 5e-4), ("d", 5e-4))
    }
    mount = Frame((0.03, 0.02, 0.1), (0.4, 0.3, 0.0) if ranger else (0.0, 0.0, 0.0))
    base = Frame((0.0, 0.0, 0.0) if ranger else (1.9, -0.7, 0.3), (0.0, 0.0, 0.0) if ranger else base_rpy)
    nominal = Cell(arm, LaserRanger(noise) if ranger else Position(noise), base, mount, PLANES if ranger else {})
    truth = replace(nominal, arm=arm.corrected(off))
    weights = Weights.drawn(rng, truth, down)
    weights = replace(weights, gravity=weight * weights.gravity)
    joints, target = _configurations(rng, truth, rows + held)
    heights = rng.normal(0.0, waves, (4, joints.shape[1])) if waves else np.zeros((4, joints.shape[1]))
    turned = joints + sum(h * w for h, w in zip(heights, _waves(joints), strict=True))
    poses = settled(truth, weights, turned)
    values = _values(truth, poses, target)
    readings = Readings(
        joints,
        values + rng.normal(0.0, noise, values.shape),
        np.full(values.shape, noise),
        target,
        np.arange(len(joints)),
    )
    axes = ("x", "y", "z", "roll", "pitch", "yaw")
    unknown = {f"base.{axis}" for axis in axes} | {f"mount.{axis}" for axis in axes[:3]}
    given = nominal if ranger else replace(nominal, base=Frame(), mount=Frame())
    return Campaign(
        "light",
        given,
        readings.chosen(np.arange(rows)),
        readings.chosen(np.arange(rows, rows + held)),
        unknown=frozenset() if ranger else frozenset(unknown),
    )


def _waves(joints):
    return np.cos(joints), np.sin(joints), np.cos(2 * joints), np.sin(2 * joints)


def _configurations(rng, cell, rows):
    lowest, highest = 0.8 * np.clip(cell.arm.limits, -2.9, 2.9).T
    joints = rng.uniform(lowest, highest, (40 * rows, len(lowest)))
    if cell.sensor.aims_at is None:
        return joints[:rows], np.zeros(rows, dtype=int)
    target = np.arange(len(joints)) % len(cell.targets)
    ranges = cell.predict(joints, target)[:, 0]
    normals = np.array([plane.normal for plane in cell.targets.values()])[target]
    steep = np.abs(np.sum(normals * cell.poses(joints)[:, :3, 2], axis=1)) > 0.3
    good = np.flatnonzero((np.nan_to_num(ranges) > 0.1) & (ranges < 4.0) & steep)[:rows]
    return joints[good], target[good]


def _values(cell, poses, target):
    if cell.sensor.aims_at is None:
        return poses[:, :3, 3]
    planes = np.array([[*plane.normal, plane.offset] for plane in cell.targets.values()])[target]
    height = planes[:, 3] + np.sum(planes[:, :3] * poses[:, :3, 3], axis=1)
    return (-height / np.sum(planes[:, :3] * poses[:, :3, 2], axis=1))[:, None]
