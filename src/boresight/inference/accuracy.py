"""The tool's accuracy over the work space, twice: absolute, and relative.

*Absolute* is where the tool is in the frame in which base, planes and points are stated. *Relative* is what is left
after the best rigid motion of all its positions at once: errors of how the whole arm stands (the first joint's zero,
the base) do not count, errors of its shape do. For a space robot the paper calls the former minor, since cameras or
the target give them back.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.inference.coverage import effective_freedom
from boresight.inference.pose import PoseUncertainty, carried, tool_slopes
from boresight.sensing import Cell

MOVED = 1e-6
"""A gauge direction of unit length that moves the tool by less than this share of its own size does not move it."""


ASIDE = 0.05
"""A gauge direction that turns the tool about its own axis, and about others by less than this share, is a spin."""

NOTHING = 1e-6
"""Directions in which the tool's variance before any reading is below this share of the largest are known anyway."""


@dataclass(frozen=True)
class Moments:
    """What is known of the parameters that move the tool.

    Attributes:
        names: of the parameters.
        covariance: of estimate minus truth.
        noise: the part of it that rests on the size of the readings' noise.
        prior: before any reading.
        gauge: (directions, parameters) what is neither read nor believed.
        freedom: degrees of freedom with which the size of the noise is known.
        model_std: standard deviation [m] of what the model leaves unexplained, along each axis.
    """

    names: tuple[str, ...]
    covariance: Float[np.ndarray, "parameters parameters"]
    noise: Float[np.ndarray, "parameters parameters"]
    prior: Float[np.ndarray, "parameters parameters"]
    gauge: Float[np.ndarray, "directions parameters"]
    freedom: float
    model_std: float


@dataclass(frozen=True)
class ToolAccuracy:
    """One of the two accuracies.

    Attributes:
        pose: uncertainty of the tool's pose at each configuration, combined (Type A and Type B).
        prior: median 95 % radius of the position before any reading [m].
        noise_share: median share of the position's variance that comes from the readings, not from priors.
        remaining: of the position's standard deviation before any reading, the share that is left in the direction in
            which the readings tell least.
    """

    pose: PoseUncertainty
    prior: float
    noise_share: float = 1.0
    remaining: float = 0.0

    @property
    def determined(self) -> bool:
        """Whether the positions depend on no gauge direction."""
        return self.pose.position_known

    @property
    def median(self) -> float:
        """Median over the configurations of the position's 95 % radius [m]; infinite where it is not determined."""
        return float(np.median(self.pose.position_95))

    @property
    def median_turn(self) -> float:
        """The same of the orientation [rad]."""
        return float(np.median(self.pose.orientation_95))


@dataclass(frozen=True)
class Accuracy:
    """What may be expected of the tool."""

    absolute: ToolAccuracy
    relative: ToolAccuracy


def tool_accuracy(
    cell: Cell, known: Moments, joints: Float[np.ndarray, "rows joints"], *, mirrored: bool = False
) -> Accuracy:
    """Returns the tool's absolute and relative accuracy at some configurations.

    Args:
        cell: the identified cell.
        known: what is known of its parameters.
        joints: configurations [rad or m].
        mirrored: whether the base may as well stand elsewhere, so that nothing absolute is determined.
    """
    slopes, columns = tool_slopes(cell, known.names, joints)
    poses = cell.poses(joints)
    positions, beam = poses[:, :3, 3], poses[:, :3, 2]
    reach = max(float(np.ptp(positions, axis=0).max(initial=0.0)), 1e-3)
    of_model = np.diag([known.model_std**2] * 3 + [(known.model_std / reach) ** 2] * 3)

    def of(slopes: Float[np.ndarray, "rows moving 6"], *, known_place: bool = True) -> ToolAccuracy:
        part = np.ix_(columns, columns)
        drift = np.einsum("rpi,gp->rgi", slopes, known.gauge[:, columns])
        spin = np.einsum("rgi,ri->rg", drift[:, :, 3:], beam)
        aside = drift[:, :, 3:] - spin[:, :, None] * beam[:, None]
        beam_alone = not _still(spin) and _size(aside) <= ASIDE * _size(spin)
        if beam_alone:
            slopes = _without_spin(slopes, beam)
        covariance = carried(slopes, known.covariance[part]) + of_model
        noise = carried(slopes, known.noise[part]) + of_model
        total, estimated = (np.trace(each[:, :3, :3], axis1=1, axis2=2) for each in (covariance, noise))
        pose = PoseUncertainty(
            joints,
            covariance,
            effective_freedom(total, estimated, known.freedom),
            position_known=known_place and _still(drift[:, :, :3]),
            orientation_known=known_place and (beam_alone or _still(drift[:, :, 3:])),
            beam_alone=beam_alone,
        )
        before = PoseUncertainty(joints, carried(slopes, known.prior[part]), np.full(len(joints), np.inf))
        share = float(np.median(estimated / np.maximum(total, 1e-300)))
        left = _remaining(pose.covariance[:, :3, :3], before.covariance[:, :3, :3])
        return ToolAccuracy(pose, float(np.median(before.position_95)), share, left)

    return Accuracy(of(slopes, known_place=not mirrored), of(without_rigid_motion(slopes, positions)))


def _still(drift: np.ndarray) -> bool:
    """Returns whether gauge directions of unit length move the tool by nothing [m or rad]."""
    return _size(drift) <= MOVED


def _size(drift: np.ndarray) -> float:
    return float(np.sqrt(np.sum(drift**2) / max(len(drift), 1)))


def _without_spin(
    slopes: Float[np.ndarray, "rows moving 6"], beam: Float[np.ndarray, "rows 3"]
) -> Float[np.ndarray, "rows moving 6"]:
    """Returns displacements of the tool less its turns about its own z axis."""
    spin = np.einsum("rpi,ri->rp", slopes[:, :, 3:], beam)
    return np.concatenate([slopes[:, :, :3], slopes[:, :, 3:] - spin[:, :, None] * beam[:, None]], axis=2)


def _remaining(after: Float[np.ndarray, "rows 3 3"], before: Float[np.ndarray, "rows 3 3"]) -> float:
    """Returns the largest ratio of standard deviations after and before in any direction, over all configurations."""
    mean = np.mean(before, axis=0)
    values, directions = np.linalg.eigh(mean)
    believed = values > NOTHING * max(float(values[-1]), 1e-300)
    if not believed.any():
        return 0.0
    whiten = directions[:, believed] / np.sqrt(values[believed])
    return float(np.sqrt(np.linalg.eigvalsh(whiten.T @ np.mean(after, axis=0) @ whiten)[-1]))


def without_rigid_motion(
    slopes: Float[np.ndarray, "rows moving 6"], positions: Float[np.ndarray, "rows 3"]
) -> Float[np.ndarray, "rows moving 6"]:
    """Returns displacements of the tool less the rigid motion that fits those of its positions best.

    Args:
        slopes: displacement (position [m], rotation [rad]) by a unit of each parameter.
        positions: of the tool [m].
    """
    rows, moving = slopes.shape[:2]
    rigid = np.zeros((rows, 6, 6))
    rigid[:, :3, :3] = rigid[:, 3:, 3:] = np.eye(3)
    x, y, z = positions.T
    zero = np.zeros(rows)
    rigid[:, :3, 3:] = np.stack([zero, z, -y, -z, zero, x, y, -x, zero], axis=1).reshape(rows, 3, 3)
    wanted = np.moveaxis(slopes[:, :, :3], 1, 2).reshape(3 * rows, moving)
    best = np.linalg.lstsq(rigid[:, :3].reshape(3 * rows, 6), wanted, rcond=None)[0]
    return slopes - np.swapaxes(rigid @ best, 1, 2)
