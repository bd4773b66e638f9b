"""Noise of the joint readings: how it widens a row's standard deviation, and whether residuals look like it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from boresight.calibration.effects import all_slopes, joint_slopes
from boresight.calibration.robust import Fit
from boresight.calibration.robust import fit as fit_robustly
from boresight.inference import model_std
from boresight.sensing import Cell, Readings

REFITS = 2
"""Fits with rows weighed by the encoder noise found before."""

LIKELIER = 8.0
"""Encoder noise is named where twice its log-likelihood exceeds that of the same error in every reading by this."""


@dataclass(frozen=True, slots=True)
class EncoderNoise:
    """Noise of the joint readings that would explain the residuals.

    Attributes:
        std: standard deviation of each revolute joint's readings [rad].
        likelier: twice its log-likelihood above that of an error of the same size in every reading.
    """

    std: float
    likelier: float

    @property
    def words(self) -> str:
        """What a person should know, as a sentence."""
        return (
            f"Encoder noise of {1e3 * self.std:.2g} mrad explains the residuals better than an error of one size in "
            "every reading: they are larger where joints move the readings more. State it as `joint_noise_std` in the "
            "campaign, in its angle unit, to weigh each row accordingly."
        )


def with_joint_noise(cell: Cell, readings: Readings, joint_noise_std: tuple[float, ...]) -> Readings:
    """Returns readings whose standard deviations hold the joint readings' noise too, to first order.

    Args:
        cell: the nominal cell.
        readings: as measured.
        joint_noise_std: standard deviation of each joint's readings [rad or m].
    """
    if not any(joint_noise_std):
        return readings
    by_joint = joint_slopes(cell, readings, all_slopes(cell, readings, np.zeros(len(cell.parameters))))
    return replace(readings, std=np.sqrt(readings.std**2 + np.sum((by_joint * joint_noise_std) ** 2, axis=2)))


def find_encoder_noise(fit: Fit) -> EncoderNoise | None:
    """Returns the encoder noise that explains what a fit leaves, None where an equal error everywhere does as well.

    Args:
        fit: the final fit; without an error of its model's own there is nothing to explain.
    """
    problem, kept = fit.problem, fit.kept
    if problem.model_std == 0.0:
        return None
    cell, readings = problem.cell, problem.readings
    turning = np.array([joint.type == "revolute" for joint in cell.arm.driven])
    slopes = joint_slopes(cell, readings, all_slopes(cell, readings, problem.corrections(fit.x)))
    lever = np.sqrt(np.sum((slopes * turning) ** 2, axis=2))
    seen = np.isfinite(problem.errors(fit.x)) & readings.read & kept[:, None] & (lever > 0.0)
    if np.count_nonzero(seen) < 2 * len(fit.x) or not seen.any():
        return None
    refitted, turn = fit, 0.0
    for _ in range(REFITS):  # rows that joints move much have bent the fit that weighed all alike
        turn = _size(refitted, lever, readings.std, seen & np.isfinite(refitted.problem.errors(refitted.x)))
        if turn == 0.0:
            return None
        weighed = replace(readings, std=np.hypot(readings.std, np.where(readings.read, turn * lever, 0.0)))
        refitted = fit_robustly(replace(problem, readings=weighed, model_std=0.0, row_weights=None), fit.x)
    errors, std = refitted.problem.errors(refitted.x), readings.std
    both = seen & refitted.kept[:, None] & np.isfinite(errors)
    if not both.any():
        return None
    likelihoods = [
        _minus_twice_log(errors[both], std[both] ** 2 + (turn * lever[both]) ** 2),
        _minus_twice_log(problem.errors(fit.x)[both], std[both] ** 2 + problem.model_std**2),
    ]
    likelier = likelihoods[1] - likelihoods[0]
    return EncoderNoise(turn, likelier) if likelier > LIKELIER else None


def _size(
    fit: Fit,
    lever: Float[np.ndarray, "rows channels"],
    std: Float[np.ndarray, "rows channels"],
    seen: Bool[np.ndarray, "rows channels"],
) -> float:
    """Returns the standard deviation of joint readings [rad] that a fit's residuals speak of.

    Divided by its own lever, a residual of encoder noise is of one size everywhere, as a model's error is undivided.
    """
    errors = fit.problem.errors(fit.x)[seen] / lever[seen]
    return model_std(errors, std[seen] / lever[seen], len(fit.x))


def _minus_twice_log(errors: Float[np.ndarray, "values"], variance: Float[np.ndarray, "values"]) -> float:
    return float(np.sum(np.log(variance) + errors**2 / variance))
