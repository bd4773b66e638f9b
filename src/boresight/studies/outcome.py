"""What one simulated calibration came to."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

REACHED = 0.01
"""A search ended at the optimum where its root mean square is within this share of the optimum's."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """One calibration against its truth; NaN where there is no such number, 0 rows where there is no such row.

    Attributes:
        nominal_position_rms: RMS error of the tool's position at the validation configurations [m], nominal model.
        nominal_orientation_rms: the same of its orientation [rad].
        position_rms: RMS error of the tool's position there [m], identified model, in the world and absolute: what
            the readings cannot see is not taken out.
        position_max: the largest of them [m].
        orientation_rms: RMS error of the tool's orientation there [rad].
        position_95: predicted 95 % radius of the position there [m], median.
        inside_95: share of these positions that lie inside their predicted 95 % ellipsoid.
        calibration_rms: measured minus predicted over the rows that the fit used [m].
        validation_rms: measured minus predicted at the validation configurations [m].
        cost: squared residuals of the rows that are not grossly wrong, over their variances, and priors.
        optimum: the same where least squares ends that starts at the truth and knows which rows are wrong.
        model_std: what the fit says the model leaves unexplained [m].
        free: parameters estimated.
        planted: rows that are grossly wrong.
        found: how many of these were left out.
        flagged: good rows that were left out.
        evaluations: how often all readings were predicted.
        seconds: of the search alone, wall time; the one number that differs from machine to machine.
        failure: why there is no outcome, in words; empty where there is one.
    """

    nominal_position_rms: float
    nominal_orientation_rms: float
    position_rms: float
    position_max: float
    orientation_rms: float
    position_95: float
    inside_95: float
    calibration_rms: float
    validation_rms: float
    cost: float
    optimum: float
    model_std: float
    free: int
    planted: int
    found: int
    flagged: int
    evaluations: int
    seconds: float
    failure: str = ""

    @property
    def reached(self) -> bool:
        """Whether the search ended at the optimum, to `REACHED`."""
        return self.cost <= (1.0 + REACHED) ** 2 * self.optimum

    @property
    def numbers(self) -> tuple[float | int | str, ...]:
        """Everything but the time, to compare."""
        return tuple(getattr(self, field.name) for field in fields(self) if field.name != "seconds")

    @classmethod
    def failed(cls, why: str, free: int) -> Outcome:
        """Returns the outcome of a run that could not be made."""
        told: dict[str, Any] = {"free": free, "failure": why}
        none: dict[str, Any] = {"float": float("nan"), "int": 0, "str": ""}
        return cls(**{field.name: told.get(field.name, none[str(field.type)]) for field in fields(cls)})
