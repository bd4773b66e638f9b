"""A cell as it is or as its files say: an arm, where it stands, its tool, plates, and what joints do beside turning."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from benchmarks.trust.kinematics import Arm, link_frames

GRAVITY = np.array([0.0, 0.0, -9.81])
"""In the world [m/s²]."""

WAVELENGTHS = (0.31, 0.47)
"""Of a wavy plate, along its two axes [m]."""


@dataclass(frozen=True)
class Plane:
    """n·x + f = 0 with a unit normal n; f in metres."""

    normal: np.ndarray
    offset: float

    @staticmethod
    def of(normal: tuple[float, float, float], offset: float) -> Plane:
        """Returns the plane of a normal of any length."""
        size = float(np.linalg.norm(normal))
        return Plane(np.array(normal) / size, offset / size)


@dataclass(frozen=True)
class Cell:
    """Everything that decides a reading but the sensor itself.

    Attributes:
        arm: its table.
        base: (4, 4) of the arm's base in the world.
        mount: (4, 4) of the sensor in the frame after the last link.
        planes: by name, in the world.
        size: metres that stand for one metre of an arm of usual reach.
        gain: (joints,) each joint turns by 1 + gain times its reading.
        waves: (joints, 4) [rad] heights of cos q, sin q, cos 2q, sin 2q that each joint turns further by.
        give: (joints,) [rad/(N m)] how each joint gives way to the torque that gravity puts on it.
        mass: of each link, at its end [kg].
        waviness: amplitude of waves on every plate [m].
    """

    arm: Arm
    base: np.ndarray = field(default_factory=lambda: np.eye(4))
    mount: np.ndarray = field(default_factory=lambda: np.eye(4))
    planes: Mapping[str, Plane] = field(default_factory=dict)
    size: float = 1.0
    gain: np.ndarray | float = 0.0
    waves: np.ndarray | float = 0.0
    give: np.ndarray | float = 0.0
    mass: float = 3.0
    waviness: float = 0.0

    def poses(self, joints: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns (rows, 3) positions [m] and (rows, 3, 3) orientations of the sensor in the world."""
        rotations, origins = link_frames(self.arm, self.attained(joints))
        last, end = rotations[:, -1], origins[:, -1]
        place = end + last @ self.mount[:3, 3]
        return place @ self.base[:3, :3].T + self.base[:3, 3], self.base[:3, :3] @ last @ self.mount[:3, :3]

    def attained(self, joints: np.ndarray) -> np.ndarray:
        """Returns (rows, joints) what the joints really do when they read this."""
        turned = joints * (1.0 + np.asarray(self.gain))
        if np.any(self.waves):
            waves = np.broadcast_to(self.waves, (self.arm.count, 4))
            own = np.stack([np.cos(joints), np.sin(joints), np.cos(2 * joints), np.sin(2 * joints)], axis=2)
            turned = turned + np.einsum("rjk,jk->rj", own, waves)
        if np.any(self.give):
            turned = turned + self._sagged(turned)
        return turned

    def _sagged(self, joints: np.ndarray) -> np.ndarray:
        """Returns (rows, joints) [rad] turns of the joints under the weight of what they carry."""
        rotations, origins = link_frames(self.arm, joints)
        weight = self.mass * GRAVITY @ self.base[:3, :3]
        turns = np.zeros_like(joints)
        for k in range(self.arm.count):
            arms = (origins[:, k + 1 :] - origins[:, [k]]).sum(axis=1)
            torque = np.einsum("ri,ri->r", rotations[:, k, :, 2], np.cross(arms, weight))
            turns[:, k] = np.broadcast_to(self.give, (self.arm.count,))[k] * torque
        return turns


def ranges(cell: Cell, joints: np.ndarray, target: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns (rows,) distances [m] along the beam to the named plane, and the cosine between beam and normal.

    Negative distances are beams that look away.
    """
    place, turn = cell.poses(joints)
    beam = turn[:, :, 2]
    planes = [cell.planes[name] for name in cell.planes]
    normal = np.array([plane.normal for plane in planes])[target]
    offset = np.array([plane.offset for plane in planes])[target]
    cosine = np.einsum("ri,ri->r", beam, normal)
    height = np.einsum("ri,ri->r", place, normal) + offset
    distance = -height / cosine
    for _ in range(8 if cell.waviness else 0):  # the wave is low: each turn is a step of a contraction
        bump = waves_on(normal, place + distance[:, None] * beam, cell)
        distance = -(height - bump) / cosine
    return distance, cosine


def waves_on(normal: np.ndarray, points: np.ndarray, cell: Cell) -> np.ndarray:
    """Returns (rows,) how far [m] plates stand out at points on them."""
    across = np.where(np.abs(normal[:, [2]]) > 0.7, np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    first = np.cross(normal, across)
    second = np.cross(normal, first)
    u, v = (np.einsum("ri,ri->r", points, each) / np.linalg.norm(each, axis=1) for each in (first, second))
    by, of = (2.0 * np.pi / (length * cell.size) for length in WAVELENGTHS)
    return cell.waviness * np.sin(by * u + 0.4) * np.sin(of * v + 1.1)
