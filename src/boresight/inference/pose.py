"""How certain the tool's pose is, where no reading was taken: the posterior carried to any configuration.

Terms as metrologists use them (JCGM 100, the GUM): a *standard uncertainty* is a standard deviation, an
*expanded uncertainty* is twice that (coverage factor k = 2). Of a position, which has three components, the
95 % figure is the radius of a ball that holds the true position with that probability.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int

from boresight.inference.coverage import ball_radius, ellipsoid_square
from boresight.inference.words import listed
from boresight.sensing import Cell

COVERAGE = 2.0
"""Coverage factor k of an expanded uncertainty."""

STANDS_OUT = 10.0
"""A direction this many times less certain than the best one stands out."""

AXES = "xyz"


@dataclass(frozen=True)
class PoseUncertainty:
    """Uncertainty of the tool's pose at some configurations.

    Attributes:
        joints: (rows, joints) the configurations [rad or m].
        covariance: (rows, 6, 6) of the tool's displacement (position [m], then rotation [rad]), in the world's axes.
        freedom: (rows,) effective degrees of freedom of the variance (Welch-Satterthwaite); infinite where the size of
            the readings' noise is known.
        position_known: whether the position depends on no gauge direction; if it does, its figures are infinite.
        orientation_known: the same of the orientation.
        beam_alone: whether the orientation is that of the tool's z axis, the spin about it being a gauge.
    """

    joints: Float[np.ndarray, "rows joints"]
    covariance: Float[np.ndarray, "rows 6 6"]
    freedom: Float[np.ndarray, "rows"]
    position_known: bool = True
    orientation_known: bool = True
    beam_alone: bool = False

    @cached_property
    def position_std(self) -> Float[np.ndarray, "rows"]:
        """Standard uncertainty of the position error's length [m]: the root of the summed variances."""
        return self._position(np.sqrt(np.trace(self.covariance[:, :3, :3], axis1=1, axis2=2)))

    @cached_property
    def orientation_std(self) -> Float[np.ndarray, "rows"]:
        """Standard uncertainty of the orientation error's angle [rad]."""
        return self._orientation(np.sqrt(np.trace(self.covariance[:, 3:, 3:], axis1=1, axis2=2)))

    @cached_property
    def position_95(self) -> Float[np.ndarray, "rows"]:
        """Radius of the ball that holds each true position with 95 % probability [m]."""
        return self._position(ball_radius(self.covariance[:, :3, :3], self.freedom))

    @cached_property
    def orientation_95(self) -> Float[np.ndarray, "rows"]:
        """The same of each orientation: the largest turn [rad]."""
        return self._orientation(ball_radius(self.covariance[:, 3:, 3:], self.freedom))

    def _position(self, size: Float[np.ndarray, "rows"]) -> Float[np.ndarray, "rows"]:
        return size if self.position_known else np.full(len(size), np.inf)

    def _orientation(self, size: Float[np.ndarray, "rows"]) -> Float[np.ndarray, "rows"]:
        return size if self.orientation_known else np.full(len(size), np.inf)

    def holds(self, displacement: Float[np.ndarray, "rows 3"]) -> np.ndarray:
        """Returns whether each position error [m] lies inside its 95 % ellipsoid.

        Directions that the covariance says are certain must be met exactly, to a nanometre.
        """
        floor = 1e-18 * np.eye(3)
        solved = np.linalg.solve(self.covariance[:, :3, :3] + floor, displacement[:, :, None])[:, :, 0]
        return np.einsum("ri,ri->r", displacement, solved) <= ellipsoid_square(self.freedom)


def pose_uncertainty(
    cell: Cell,
    names: tuple[str, ...],
    covariance: Float[np.ndarray, "free free"],
    joints: Float[np.ndarray, "rows joints"],
) -> PoseUncertainty:
    """Returns the uncertainty of the sensor frame's pose in the world, the size of the readings' noise being known.

    Args:
        cell: the identified cell.
        names: the parameters that may be wrong.
        covariance: their posterior covariance.
        joints: configurations [rad or m].
    """
    slopes, columns = tool_slopes(cell, names, joints)
    part = covariance[np.ix_(columns, columns)]
    return PoseUncertainty(joints, carried(slopes, part), np.full(len(joints), np.inf))


def tool_slopes(
    cell: Cell, names: tuple[str, ...], joints: Float[np.ndarray, "rows joints"]
) -> tuple[Float[np.ndarray, "rows moving 6"], list[int]]:
    """Returns the tool's displacement by a unit of each parameter that moves it, and those parameters' places.

    A parameter's error moves the tool by its twist (v, w): the position by v + w × p, the orientation by w.
    Errors of targets do not move the tool.
    """
    motion = cell.chain.linearise(joints)
    place = {name: column for column, name in enumerate(cell.chain.parameters)}
    moving = [i for i, name in enumerate(names) if name in place]
    twists = motion.twists[:, [place[names[i]] for i in moving]]
    shifts = twists[:, :, :3] + np.cross(twists[:, :, 3:], motion.poses[:, None, :3, 3])
    return np.concatenate([shifts, twists[:, :, 3:]], axis=2), moving


def carried(
    slopes: Float[np.ndarray, "rows moving 6"], covariance: Float[np.ndarray, "moving moving"]
) -> Float[np.ndarray, "rows 6 6"]:
    """Returns the covariance of the tool's displacement from that of the parameters that move it."""
    return np.swapaxes(slopes, 1, 2) @ covariance @ slopes


def uncalibrated_in_words(uncertainty: PoseUncertainty) -> str:
    """Returns which directions of the tool's pose are far less certain than the others, as a sentence.

    Meant for where some directions of the parameters are not seen at all: those that matter to the tool then
    stand out by their uncertainty, which is the prior's.
    """
    variance = np.mean(np.diagonal(uncertainty.covariance, axis1=1, axis2=2), axis=0)
    position, orientation = np.sqrt(variance[:3]), np.sqrt(variance[3:])
    said = []
    for std, verb, scale, unit in (
        (position, "position along", 1e3, "mm"),
        (orientation, "orientation about", 1e3, "mrad"),
    ):
        axes = np.flatnonzero(std > STANDS_OUT * np.min(std))
        if len(axes):
            worst = scale * float(np.max(std[axes]))
            said.append(f"{verb} {listed([AXES[axis] for axis in axes])} (standard uncertainty {worst:.2g} {unit})")
    if not said:
        shift, turn = 1e3 * float(np.max(position)), 1e3 * float(np.max(orientation))
        return (
            "Some parameters stay at nominal because no reading sees them: the tool's pose is known to "
            f"{shift:.2g} mm and {turn:.2g} mrad (standard uncertainty)."
        )
    return f"Not calibrated, since no reading sees it: the tool's {' and its '.join(said)}, in the world's axes."


def spread_configurations(cell: Cell, rows: int) -> Float[np.ndarray, "rows joints"]:
    """Returns configurations spread evenly within the joints' limits, the same ones every time (Halton 1960)."""
    limits = np.array(cell.arm.limits)
    turns = np.array([joint.type == "revolute" for joint in cell.arm.driven])
    limits[turns] = np.clip(limits[turns], -np.pi, np.pi)
    primes = _primes(len(limits))
    unit = np.stack([_radical_inverse(np.arange(1, rows + 1), prime) for prime in primes], axis=1)
    return limits[:, 0] + unit * (limits[:, 1] - limits[:, 0])


def _primes(count: int) -> list[int]:
    found: list[int] = []
    candidate = 2
    while len(found) < count:
        if all(candidate % prime for prime in found):
            found.append(candidate)
        candidate += 1
    return found


def _radical_inverse(index: Int[np.ndarray, "rows"], base: int) -> Float[np.ndarray, "rows"]:
    """Returns the digits of each index in a base, mirrored at the point."""
    value, scale, rest = np.zeros(len(index)), 1.0, index.copy()
    while np.any(rest > 0):
        scale /= base
        value += scale * (rest % base)
        rest //= base
    return value
