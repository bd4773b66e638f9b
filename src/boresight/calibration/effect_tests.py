"""A fit, linearised, to which effects can be added one at a time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.calibration.configurations import configurations_of
from boresight.calibration.effects import Effect
from boresight.calibration.explanation import Explanation
from boresight.calibration.robust import Fit, check_noise
from boresight.inference.coverage import interval_factor
from boresight.inference.score_tests import LinearFit, fit_robustly
from boresight.sensing.linear import slopes_of
from boresight.units import UNIT_OF

FALSE_ALARMS = 1e-3
"""Probability with which chance alone has any effect explained in a campaign."""

COMMON = 1.3
"""Where a value's variance is so many times the stated one, repeats of one reading share what is not noise."""


def critical(sizes: np.ndarray, effects: int) -> np.ndarray:
    """Returns the chi-square that chance exceeds for one of so many effects in `FALSE_ALARMS` of all campaigns."""
    from scipy import special

    return special.chdtri(sizes, FALSE_ALARMS / max(effects, 1))


def state_of(fit: Fit) -> tuple[float, int]:
    """Returns the residuals over the stated noise, and how many rows are left out."""
    return check_noise(fit).ratio, int(np.count_nonzero(~fit.kept))


@dataclass(frozen=True)
class EffectTests:
    """A fit, linearised, over all of its rows.

    Attributes:
        fit: it.
        read: (rows, channels) which values there are.
        base: robust linear fit without any effect.
        precision: of each free parameter's prior.
    """

    fit: Fit
    read: np.ndarray
    base: LinearFit
    precision: Float[np.ndarray, "free"]

    @classmethod
    def of(cls, fit: Fit) -> EffectTests:
        """Returns the tests of a fit, over all of its rows."""
        problem, x = fit.problem, fit.x
        errors, std = problem.errors(x), problem.readings.std
        read = np.isfinite(errors) & problem.readings.read
        columns = (slopes_of(problem.model, x, problem.readings) / std[:, :, None])[read]
        precision = 1.0 / problem.prior_std**2
        return cls(fit, read, fit_robustly(columns, -errors[read] / std[read], precision, x), precision)

    def spread(self, fit: LinearFit) -> float:
        """Returns the variance of a value over the stated one; where it is more, repeats of one reading count once."""
        values = float(len(fit.residual))
        if fit.cost > COMMON * max(values - fit.decided, 1.0):
            readings = self.fit.problem.readings
            own = np.column_stack([configurations_of(readings.joints), readings.target])
            values *= len(np.unique(own, axis=0)) / len(readings)
        return max(fit.cost / max(values - fit.decided, 1.0), 1.0)

    def normalised(self, columns: Float[np.ndarray, "rows channels numbers"]) -> Float[np.ndarray, "values numbers"]:
        """Returns an effect's derivatives over the readings' standard deviations."""
        return (columns / self.fit.problem.readings.std[:, :, None])[self.read]

    def with_effect(self, own: Float[np.ndarray, "values numbers"], std: Float[np.ndarray, "numbers"]) -> LinearFit:
        """Returns the robust linear fit with an effect, `normalised`, whose numbers have prior standard deviations."""
        base = self.base
        return fit_robustly(
            np.hstack([base.columns, own]),
            base.residual + base.columns @ base.step,
            np.append(self.precision, 1.0 / std**2),
            np.append(self.fit.x, np.zeros(len(std))),
            base.weight,
        )

    def explanation(self, effect: Effect, trial: LinearFit, before: tuple[float, int]) -> Explanation:
        """Returns what a fit with an effect says of it; before is `state_of` the fit without."""
        free = len(self.precision)
        scale = max(1.4826 * float(np.median(np.abs(trial.residual))), 1.0)
        fits = np.abs(trial.residual) <= 5.0 * scale
        values = max(float(np.count_nonzero(fits)) - trial.decided, 1.0)
        ratio = float(np.sqrt(np.sum(trial.residual[fits] ** 2) / values))
        good = np.ones(self.read.shape, dtype=bool)
        good[self.read] = fits
        std = max(ratio, 1.0) * float(np.sqrt(max(trial.inverse[free, free], 0.0)))
        k = float(interval_factor(np.array([values]))[0] / interval_factor(np.array([np.inf]))[0])
        return Explanation(
            effect.name,
            effect.parameters,
            float(trial.step[free]),
            k * std,
            UNIT_OF[effect.quantity],
            len(trial.step) - free,
            before[0],
            ratio,
            before[1],
            int(np.count_nonzero(~good.all(axis=1))),
            trial.cost,
        )
