"""Where base and mounts stand, many trials at once, and what the equations leave there."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int

from boresight.calibration.placement.equations import Equations
from boresight.geometry import vector_rotation


@dataclass(frozen=True)
class Placements:
    """Trials of the base's place in the world and of every mount's on the flange.

    Attributes:
        base_turn: (trials, 3, 3).
        base_shift: (trials, 3) [m].
        mount_turn: (trials, mounts, 3, 3).
        mount_shift: (trials, mounts, 3) [m].
    """

    base_turn: Float[np.ndarray, "trials 3 3"]
    base_shift: Float[np.ndarray, "trials 3"]
    mount_turn: Float[np.ndarray, "trials mounts 3 3"]
    mount_shift: Float[np.ndarray, "trials mounts 3"]

    def __len__(self) -> int:
        """Number of trials."""
        return len(self.base_turn)

    def chosen(self, trials: Int[np.ndarray, " some"] | Bool[np.ndarray, " trials"]) -> Placements:
        """Returns some of the trials."""
        return Placements(
            self.base_turn[trials], self.base_shift[trials], self.mount_turn[trials], self.mount_shift[trials]
        )

    def where(self, taken: Bool[np.ndarray, " trials"], other: Placements) -> Placements:
        """Returns these trials where they are taken, and the others elsewhere."""
        return Placements(
            np.where(taken[:, None, None], self.base_turn, other.base_turn),
            np.where(taken[:, None], self.base_shift, other.base_shift),
            np.where(taken[:, None, None, None], self.mount_turn, other.mount_turn),
            np.where(taken[:, None, None], self.mount_shift, other.mount_shift),
        )

    def moved(self, step: Float[np.ndarray, "trials unknowns"], unknowns: Unknowns) -> Placements:
        """Returns the trials after a step: the base turned about the world's axes, mounts about their own."""
        full = np.zeros((len(self), unknowns.width))
        full[:, unknowns.columns] = step
        mounts = self.mount_turn.shape[1]
        of_mounts = full[:, 6:].reshape(-1, mounts, 6)
        return Placements(
            vector_rotation(full[:, :3]) @ self.base_turn,
            self.base_shift + full[:, 3:6],
            self.mount_turn @ vector_rotation(of_mounts[:, :, :3]),
            self.mount_shift + of_mounts[:, :, 3:],
        )


@dataclass(frozen=True)
class Unknowns:
    """Which of the numbers are sought: turns and shifts of the base, then of each mount.

    Attributes:
        base: whether its turn, whether its shift.
        mounts: the same of each mount.
    """

    base: tuple[bool, bool]
    mounts: tuple[tuple[bool, bool], ...]

    @property
    def width(self) -> int:
        """How many numbers there are in all."""
        return 6 * (1 + len(self.mounts))

    @property
    def columns(self) -> Int[np.ndarray, " unknowns"]:
        """The places of those that are sought."""
        return np.flatnonzero([part for pair in (self.base, *self.mounts) for part in pair for _ in range(3)])


def residuals(at: Placements, equations: Equations) -> Float[np.ndarray, "trials equations"]:
    """Returns what each equation leaves [m]."""
    return _linearised(at, equations, slopes=False)[0]


def linearised(
    at: Placements, equations: Equations, unknowns: Unknowns
) -> tuple[Float[np.ndarray, "trials equations"], Float[np.ndarray, "trials unknowns equations"]]:
    """Returns what each equation leaves [m] and its derivative by a step of `Placements.moved`."""
    left, slopes = _linearised(at, equations, slopes=True)
    return left, slopes[:, unknowns.columns]


def _linearised(
    at: Placements, equations: Equations, *, slopes: bool
) -> tuple[Float[np.ndarray, "trials equations"], Float[np.ndarray, "trials numbers equations"]]:
    e = equations
    in_base = e.normal @ at.base_turn  # R_b' n: (trials, equations, 3)
    in_flange = np.einsum("sej,ejk->sek", in_base, e.rotation, optimize=False)
    shift = at.mount_shift[:, e.mount] * e.carried[:, None]
    arm = at.mount_turn[:, e.mount, :, e.axis].transpose(1, 0, 2) * e.length[:, None]
    left = (
        np.einsum("sej,sej->se", in_flange, shift + arm)
        + np.einsum("sej,ej->se", in_base, e.origin * e.carried[:, None])
        + (at.base_shift @ e.normal.T) * e.carried
        + e.constant
    )
    if not slopes:
        return left, np.empty(0)
    trials, mounts = len(at), at.mount_turn.shape[1]
    by = np.zeros((trials, 6 * (1 + mounts), len(e)))
    point = np.einsum("ejk,sek->sej", e.rotation, shift + arm) + e.origin * e.carried[:, None]
    point = point @ np.swapaxes(at.base_turn, 1, 2)
    by[:, :3] = np.cross(point, e.normal).transpose(0, 2, 1)
    by[:, 3:6] = (e.normal * e.carried[:, None]).T
    for mount in range(mounts):
        rows = np.flatnonzero(e.mount == mount)
        first = 6 * (1 + mount)
        in_mount = in_flange[:, rows] @ at.mount_turn[:, mount]
        axis = np.eye(3)[e.axis[rows]] * e.length[rows, None]
        by[:, first : first + 3, rows] = np.cross(axis, in_mount).transpose(0, 2, 1)
        by[:, first + 3 : first + 6, rows] = (in_flange[:, rows] * e.carried[rows, None]).transpose(0, 2, 1)
    return left, by


def started(turns: Float[np.ndarray, "trials 3 3"], like: Placements, unknowns: Unknowns) -> Placements:
    """Returns trials with these turns of the base, and all else as in the only trial given."""
    count = len(turns)
    repeated = like.chosen(np.zeros(count, dtype=int))
    return replace(repeated, base_turn=turns) if unknowns.base[0] else repeated
