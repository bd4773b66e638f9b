"""Why a combination of parameters changes no reading: a null space taken apart into motions that have names.

In configuration k a null direction δ moves the sensor by the twist ξ_k = Σ_p twist_p(q_k) δ_p. Where all ξ_k are
zero, the parameters do the same to the arm, or belong to a target that no row aims at. Where each ξ_k maps the
plane or point it aims at onto itself, the sensor only glides along or about it. Where all ξ_k are one twist, the
whole arm moves as a rigid body, and targets with it. Where they are one twist seen from the sensor, the sensor
moves on its mount. What is left has no name.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from jaxtyping import Float

from boresight.inference.identifiability import shortest
from boresight.inference.movements import Movements
from boresight.inference.rigid import AXES, base_motions, off_target, seen_from_sensor

Kind = Literal["still", "gliding", "base", "sensor", "other"]
KINDS: tuple[Kind, ...] = ("still", "gliding", "base", "sensor", "other")

ALIKE = 1e-5
"""Twists that differ by less than this share of what the single parameters do are the same."""


LEADING = 0.05
"""Parameters whose part in a direction is smaller than this share of the largest are not named."""


@dataclass(frozen=True)
class Symmetry:
    """One direction that changes no reading, and what kind of motion it is.

    Attributes:
        direction: (parameters,) scaled, its largest entry 1.
        kind: of motion.
        motion: which motion, for kinds `base` and `sensor`: "turning about z"; "" where it has no name.
        mount: for kind `sensor`, which mount moves.
    """

    direction: Float[np.ndarray, "parameters"]
    kind: Kind
    motion: str = ""
    mount: str = ""


@dataclass
class _Taken:
    """Directions found so far, each with the parameter that it does without from then on."""

    rows: list[np.ndarray] = field(default_factory=list)
    pivots: list[int] = field(default_factory=list)
    found: list[Symmetry] = field(default_factory=list)

    def without(self, rows: np.ndarray) -> np.ndarray:
        """Returns directions with what was found before taken off them."""
        rows = rows.copy()
        for known, pivot in zip(self.rows, self.pivots, strict=True):
            rows -= np.outer(rows[:, pivot] / known[pivot], known)
        return rows

    def take(self, direction: np.ndarray, kind: Kind, motion: str = "", mount: str = "") -> None:
        """Adds a direction, unless the ones before it make it up."""
        left = self.without(direction[None, :] / np.abs(direction).max())[0]
        if np.abs(left).max() < 1e-4:
            return
        pivot = int(np.argmax(np.abs(left)))
        left = np.where(np.abs(left) < ALIKE * abs(left[pivot]), 0.0, left / left[pivot])
        self.rows.append(left)
        self.pivots.append(pivot)
        self.found.append(Symmetry(left, kind, motion, mount))


def symmetries_of(
    unseen: Float[np.ndarray, "directions parameters"], scale: Float[np.ndarray, "parameters"], moves: Movements
) -> list[Symmetry]:
    """Returns a basis of a null space, made of motions that have names as far as there are any.

    Args:
        unseen: a basis of scaled directions that change no reading.
        scale: the size by which each parameter was scaled.
        moves: how the parameters move sensor and targets.
    """
    if not len(unseen):
        return []
    null = np.linalg.qr(unseen.T)[0].T
    sizes = np.sqrt((moves.twists**2).sum(axis=2)).max(axis=0) * scale
    twists = np.einsum("rpx,dp->drx", moves.twists, null * scale) / max(float(sizes.max()), 1e-300)
    of_targets = null * np.array([bool(owner) for owner in moves.of_target])
    taken = _Taken()
    _take_short(taken, _vanishing(null, twists), "still")
    if moves.targets:
        _take_alone(taken, _vanishing(null, off_target(twists, moves), of_targets), "gliding")
    constant = _vanishing(null, twists - twists.mean(axis=1, keepdims=True))
    _take_named(taken, constant, _mean(constant, scale, moves.twists), base_motions(moves), "base")
    if moves.targets and not moves.too_few:  # a few rows are glided over by many motions that have no reason
        _take_short(taken, _vanishing(null, off_target(twists, moves), of_targets), "gliding")
    own = seen_from_sensor(twists, moves.poses)
    for place in np.unique(moves.mounted):
        rows = moves.mounted == place
        alone = own - np.where(rows[:, None], own[:, rows].mean(axis=1, keepdims=True), 0.0)
        fixed = _vanishing(null, alone, of_targets)
        moved = np.einsum("rpx,dp->drx", moves.twists[rows], fixed * scale)
        on_sensor = seen_from_sensor(moved, moves.poses[rows]).mean(axis=1)
        _take_named(taken, fixed, on_sensor, AXES, "sensor", moves.mounts[place])
    _take_short(taken, null, "other")
    return sorted(taken.found, key=lambda symmetry: KINDS.index(symmetry.kind))


def _vanishing(null: np.ndarray, *images: np.ndarray) -> np.ndarray:
    """Returns the combinations of null directions for which all images are zero."""
    if not len(null):
        return null
    image = np.concatenate([each.reshape(len(null), -1) / np.sqrt(max(each.shape[1], 1)) for each in images], axis=1)
    left, sizes, _ = np.linalg.svd(np.transpose(np.linalg.qr(image.T, mode="r")))
    full = np.zeros(len(null))
    full[: len(sizes)] = sizes
    return left[:, full < ALIKE].T @ null


def _take_short(taken: _Taken, space: np.ndarray, kind: Kind, mount: str = "") -> None:
    for row in _new(taken, space):
        taken.take(row, kind, mount=mount)


def _take_alone(taken: _Taken, space: np.ndarray, kind: Kind) -> None:
    """Takes the directions that are one parameter, or one and little beside."""
    for row in _new(taken, space):
        if np.count_nonzero(np.abs(row) > LEADING * np.abs(row).max()) == 1:
            taken.take(row, kind)


def _new(taken: _Taken, space: np.ndarray) -> np.ndarray:
    """Returns a short basis of what a space has beyond the directions taken."""
    if not len(space):
        return space
    _, sizes, rows = np.linalg.svd(taken.without(space), full_matrices=False)
    return shortest(rows[sizes > 1e-4])


def _take_named(
    taken: _Taken, space: np.ndarray, twists: np.ndarray, named: dict[str, np.ndarray], kind: Kind, mount: str = ""
) -> None:
    """Takes from a space of rigid motions those that have names, then the rest."""
    if not len(space):
        return
    for name, twist in named.items():
        parts = np.linalg.lstsq(twists.T, twist, rcond=1e-9)[0]
        if np.linalg.norm(parts @ twists - twist) < 1e-4 * np.linalg.norm(twist):
            taken.take(parts @ space, kind, name, mount)
    _take_short(taken, space, kind, mount)


def _mean(space: np.ndarray, scale: np.ndarray, twists: np.ndarray) -> np.ndarray:
    return np.einsum("rpx,dp->drx", twists, space * scale).mean(axis=1)
