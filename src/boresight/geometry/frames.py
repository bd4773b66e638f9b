"""Where one frame stands in another, and the small corrections it can be given."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.geometry.rotations import matrix_rpy, rpy_matrix

Triple = tuple[float, float, float]


def triple_of(values: Iterable[float]) -> Triple:
    """Returns three numbers as a tuple of plain ones."""
    x, y, z = (float(value) for value in values)
    return x, y, z


@dataclass(frozen=True, slots=True)
class Frame:
    """The pose of a child frame in its parent: `T_parent_child`.

    Attributes:
        xyz: the child's origin in the parent [m].
        rpy: roll, pitch, yaw [rad] about the parent's fixed axes, R = Rz(yaw) Ry(pitch) Rx(roll).
    """

    xyz: Triple = (0.0, 0.0, 0.0)
    rpy: Triple = (0.0, 0.0, 0.0)

    @classmethod
    def of(cls, T_parent_child: Float[np.ndarray, "4 4"]) -> Frame:
        """Returns the frame of a homogeneous transform."""
        return cls(triple_of(T_parent_child[:3, 3]), matrix_rpy(T_parent_child[:3, :3]))

    @property
    def matrix(self) -> Float[np.ndarray, "4 4"]:
        """The homogeneous transform `T_parent_child`."""
        T = np.eye(4)
        T[:3, :3] = rpy_matrix(self.rpy)
        T[:3, 3] = self.xyz
        return T

    def moved(self, shift: Triple, turn: Triple) -> Frame:
        """Returns the frame shifted along the parent's axes [m] and turned about its own x, y, z [rad].

        The turn is Rz(turn_z) Ry(turn_y) Rx(turn_x) after the present orientation, so a small correction is
        well defined at every orientation; adding to roll, pitch and yaw is not at pitch = 90 degrees.
        """
        x, y, z = (float(a + b) for a, b in zip(self.xyz, shift, strict=True))
        return Frame((x, y, z), matrix_rpy(rpy_matrix(self.rpy) @ rpy_matrix(turn)))


def inverse(T_a_b: Float[np.ndarray, "*batch 4 4"]) -> Float[np.ndarray, "*batch 4 4"]:
    """Returns `T_b_a` of a rigid transform."""
    R = np.swapaxes(T_a_b[..., :3, :3], -1, -2)
    T = np.zeros_like(T_a_b)
    T[..., :3, :3] = R
    T[..., :3, 3] = -np.einsum("...ij,...j->...i", R, T_a_b[..., :3, 3])
    T[..., 3, 3] = 1.0
    return T
