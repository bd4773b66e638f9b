"""Forward kinematics of standard D-H arms in NumPy, sharing nothing with the package; held to MuJoCo by a test."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

NEARLY_PARALLEL = np.deg2rad(5.0)
"""Axes nearer to parallel than this have Hayati's beta in place of d."""

NUMBERS = ("theta", "d", "a", "alpha", "beta")


@dataclass(frozen=True)
class Arm:
    """An arm by its table: Rz(q + theta) Tz(d) Tx(a) Rx(alpha) Ry(beta), a prismatic joint's reading added to d.

    Attributes:
        types: a letter a joint, `r` revolute or `p` prismatic.
        theta, alpha, beta: (joints,) or (rows, joints) [rad].
        d, a: the same [m].
        limits: (joints, 2) lowest and highest reading [rad or m].
    """

    types: str
    theta: np.ndarray
    d: np.ndarray
    a: np.ndarray
    alpha: np.ndarray
    beta: np.ndarray
    limits: np.ndarray

    @property
    def count(self) -> int:
        """How many joints."""
        return len(self.types)

    @property
    def revolute(self) -> np.ndarray:
        """(joints,) whether each joint turns."""
        return np.array([kind == "r" for kind in self.types])

    @property
    def parallel(self) -> np.ndarray:
        """(joints,) whether beta stands for d: a revolute joint whose axis is nearly parallel to the next."""
        near = np.abs(np.sin(self.alpha)) < np.sin(NEARLY_PARALLEL)
        return near & self.revolute & (np.arange(self.count) < self.count - 1)

    def corrected(self, number: str, amount: np.ndarray) -> Arm:
        """Returns the arm with (joints,) or (rows, joints) added to one number of each link."""
        return replace(self, **{number: getattr(self, number) + amount})


def link_frames(arm: Arm, joints: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns every frame from the base to after the last link.

    Args:
        arm: its numbers may differ row by row.
        joints: (rows, joints) readings [rad or m].

    Returns:
        (rows, joints + 1, 3, 3) rotations and (rows, joints + 1, 3) origins [m], in the arm's base.
    """
    rows = len(joints)
    rotation, origin = np.broadcast_to(np.eye(3), (rows, 3, 3)), np.zeros((rows, 3))
    rotations, origins = [rotation], [origin]
    theta, d, a, alpha, beta = (np.broadcast_to(getattr(arm, n), joints.shape) for n in NUMBERS)
    for k, turns in enumerate(arm.revolute):
        angle = theta[:, k] + (joints[:, k] if turns else 0.0)
        along = d[:, k] + (0.0 if turns else joints[:, k])
        step = np.stack([a[:, k] * np.cos(angle), a[:, k] * np.sin(angle), along], axis=1)
        origin = origin + np.einsum("rij,rj->ri", rotation, step)
        rotation = rotation @ about("z", angle) @ about("x", alpha[:, k]) @ about("y", beta[:, k])
        rotations.append(rotation)
        origins.append(origin)
    return np.stack(rotations, axis=1), np.stack(origins, axis=1)


def about(axis: str, angle: np.ndarray | float) -> np.ndarray:
    """Returns (..., 3, 3) rotations about a coordinate axis by (...) angles [rad]."""
    angle = np.asarray(angle, dtype=float)
    k = "xyz".index(axis)
    i, j = (k + 1) % 3, (k + 2) % 3
    turn = np.zeros((*angle.shape, 3, 3))
    turn[..., k, k] = 1.0
    turn[..., i, i] = turn[..., j, j] = np.cos(angle)
    turn[..., j, i] = np.sin(angle)
    turn[..., i, j] = -np.sin(angle)
    return turn


def frame(
    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0), rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> np.ndarray:
    """Returns (4, 4) Rz(yaw) Ry(pitch) Rx(roll) and a translation [m, rad]."""
    roll, pitch, yaw = rpy
    T = np.eye(4)
    T[:3, :3] = about("z", yaw) @ about("y", pitch) @ about("x", roll)
    T[:3, 3] = xyz
    return T


def roll_pitch_yaw(T: np.ndarray) -> tuple[float, float, float]:
    """Returns the angles [rad] that `frame` was given, with pitch within a right angle."""
    R = T[:3, :3]
    return (
        float(np.arctan2(R[2, 1], R[2, 2])),
        float(np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0]))),
        float(np.arctan2(R[1, 0], R[0, 0])),
    )
