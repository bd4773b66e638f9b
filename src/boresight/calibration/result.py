"""What a calibration found, as values."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from boresight.calibration.alternatives import Alternative
from boresight.calibration.beyond import Beyond
from boresight.calibration.campaign import RobotFile, SetAside
from boresight.calibration.explanation import Explanation
from boresight.calibration.jumps import Jump
from boresight.calibration.robust import NoiseCheck
from boresight.calibration.sensitivities import Sensitivity
from boresight.calibration.solve import Solution, Solver
from boresight.inference import Accuracy, PoseUncertainty
from boresight.sensing import Cell, Readings

AcceptedFor = Literal["absolute", "relative", "partial"]


@dataclass(frozen=True, slots=True)
class Estimate:
    """One parameter, as it was believed and as it was found.

    Attributes:
        name: the parameter.
        unit: m, rad or 1.
        nominal: the value the files gave; None where they said it was unknown.
        identified: the value found.
        correction: identified minus nominal.
        std: standard deviation of the identified value, whatever else may be wrong; of a parameter that was not
            estimated the prior's; 0 where it is taken as known.
        half_width_95: half-width of its 95 % interval, by Student's t where the size of the noise was estimated.
        conditional_std: standard deviation if everything that was not estimated is as stated; 0 if it was not either.
        source: whether the value comes from the `data`, from the `prior`, is `fixed`, or was held by convention, as a
            `gauge`, since neither readings nor priors say anything of it.
    """

    name: str
    unit: str
    nominal: float | None
    identified: float
    correction: float | None
    std: float
    source: str
    conditional_std: float = 0.0
    half_width_95: float = 0.0


@dataclass(frozen=True, slots=True)
class ErrorSummary:
    """Size of a set of errors [m].

    Attributes:
        rms: root mean square.
        mean: mean; of positions the mean over poses of the pose accuracy AP_P of ISO 9283, the distance between
            the commanded and the attained position, each pose visited once.
        max: largest.
    """

    rms: float
    mean: float
    max: float


@dataclass(frozen=True, slots=True)
class Residuals:
    """Errors of one set of rows: of ranges, or the lengths of position error vectors.

    Attributes:
        method: where the rows come from: `calibration rows`, `validation rows`, `5-fold cross-validation`.
        count: rows whose reading could be predicted.
        missed: rows whose beam, as predicted after calibration, looks away from its plane.
        before: geometry nominal, unknown frames fitted.
        after: identified.
    """

    method: str
    count: int
    missed: int
    before: ErrorSummary
    after: ErrorSummary


@dataclass(frozen=True, slots=True)
class SensorErrors:
    """Errors of what one sensor reads.

    Attributes:
        sensor: its name.
        what: range, length, position, orientation or contact.
        unit: m or rad.
        rows: how many rows.
        stated_std: median stated standard deviation of each value.
        before, after: sizes of the errors, of a vector its length.
    """

    sensor: str
    what: str
    unit: str
    rows: int
    stated_std: float
    before: ErrorSummary
    after: ErrorSummary


@dataclass(frozen=True, slots=True)
class Outlier:
    """A row whose residual does not fit with the others.

    Attributes:
        line: its line in the observations file.
        residual_m: measured minus predicted, or the length of the error vector [m].
        ratio: its size in standard deviations of such a residual.
    """

    line: int
    residual_m: float
    ratio: float

    @property
    def reason(self) -> str:
        """Why the row was left out, in words."""
        if not math.isfinite(self.ratio):
            return "its beam, as predicted, looks away from its plane"
        return f"{self.ratio:.3g} standard deviations from what the other rows predict"


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether to use the result.

    Attributes:
        accepted: whether the corrected arm may be used.
        reasons: one sentence each, that a person can act on; of a rejected result the cause first.
        accepted_for: the tool's accuracy that the readings give: `absolute` in the frame of base and targets,
            `relative` after the best rigid motion, or `partial` where neither; None where it is rejected.
    """

    accepted: bool
    reasons: tuple[str, ...]
    accepted_for: AcceptedFor | None = None


@dataclass(frozen=True, slots=True)
class Unseen:
    """A combination of free parameters that changes no reading.

    Attributes:
        parameters: which.
        words: what that means.
    """

    parameters: tuple[str, ...]
    words: str


@dataclass(frozen=True)
class Result:
    """The outcome of a calibration.

    Attributes:
        name: of the campaign.
        cell: the identified cell.
        nominal: the cell with geometry nominal and unknown frames fitted.
        verdict: whether to use it.
        estimates: every parameter.
        free: number of free parameters.
        rank: number of directions the readings see.
        unseen: directions they do not.
        calibration: errors of the rows that were fitted.
        validation: errors of rows that were not.
        by_sensor: errors of the rows that were fitted, sensor by sensor, lengths apart from angles.
        outliers: rows that stand out.
        readings: the rows that were fitted.
        errors: (rows, channels) predicted minus measured [m], before and after.
        stated_std: median stated standard deviation of a row's value [m].
        model_std: standard deviation [m] of what the model leaves unexplained.
        noise: the residuals against the stated noise.
        beyond: what was tried beyond geometry; None where there was no need, or it was not wanted.
        solution: how the search went.
        solver: how it was set.
        covariance: (free, free) posterior covariance of the corrections.
        free_names: the free parameters.
        at_rows: uncertainty of the tool's pose at the validation rows, or the calibration rows if there are none; of
            many rows at some thousands.
        in_workspace: uncertainty of the tool's pose at configurations spread within the joints' limits.
        accuracy: absolute and relative, over the same configurations.
        assumed: link parameters taken as known because the campaign fixes them.
        priors: prior standard deviation [m, rad or 1] of every parameter that may be wrong and was not estimated.
        explanations: missing effects that explain the residuals, the best first.
        alternatives: slips that explain them: a flipped plane, a joint that counts backwards.
        sensitivities: what is assumed and no reading can check, the weightiest first.
        set_aside: rows that were not used.
        jumps: blocks of rows that a sensor read differently, and nobody said so.
        warnings: what a person should look at.
        notes: choices a person should know.
        inputs: SHA-256 by file name.
        robot_file: the URDF the arm was read from, if it was.
    """

    name: str
    cell: Cell
    nominal: Cell
    verdict: Verdict
    estimates: tuple[Estimate, ...]
    free: int
    rank: int
    unseen: tuple[Unseen, ...]
    calibration: Residuals
    validation: Residuals
    by_sensor: tuple[SensorErrors, ...]
    outliers: tuple[Outlier, ...]
    readings: Readings
    errors: Mapping[str, Float[np.ndarray, "rows channels"]]
    stated_std: float
    model_std: float
    noise: NoiseCheck
    beyond: Beyond | None
    solution: Solution
    solver: Solver
    covariance: Float[np.ndarray, "free free"]
    free_names: tuple[str, ...]
    at_rows: PoseUncertainty
    in_workspace: PoseUncertainty
    accuracy: Accuracy
    assumed: tuple[str, ...]
    priors: Mapping[str, float]
    explanations: tuple[Explanation, ...]
    alternatives: tuple[Alternative, ...]
    sensitivities: tuple[Sensitivity, ...]
    set_aside: tuple[SetAside, ...]
    jumps: tuple[Jump, ...]
    warnings: tuple[str, ...]
    notes: tuple[str, ...]
    inputs: Mapping[str, str]
    robot_file: RobotFile | None = None

    def correlations(self, above: float = 0.9) -> list[tuple[str, str, float]]:
        """Returns the pairs of free parameters whose errors go together, the strongest first."""
        std = np.sqrt(np.diag(self.covariance))
        correlation = self.covariance / np.outer(std, std)
        first, second = np.nonzero(np.triu(np.abs(correlation) > above, 1))
        pairs = [
            (self.free_names[i], self.free_names[j], float(correlation[i, j]))
            for i, j in zip(first, second, strict=True)
        ]
        return sorted(pairs, key=lambda pair: -abs(pair[2]))
