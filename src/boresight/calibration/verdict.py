"""Whether to use a result: held-out errors must have fallen for certain, and no bound may hold it back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.calibration.campaign import Term
from boresight.calibration.holdout import HeldOut
from boresight.calibration.problem import Problem
from boresight.calibration.result import Verdict
from boresight.calibration.robust import Fit, NoiseCheck, check_noise
from boresight.inference import listed
from boresight.units import in_millimetres

RESAMPLES = 2000
CONFIDENCE = 0.95
GROUPS = 10_000
"""Groups that many rows are resampled in: 2,000 times a million rows would take a minute for the same interval."""

FEWEST_ROWS = 6
"""That n rows all improve by luck has probability 2^-n, either way 2^(1-n): below 5 % from six rows on. The
bootstrap cannot say so: two rows that happen to improve make an interval that is certain of it."""

AT_BOUND = 1e-4
"""A parameter is held back by its bound where it is nearer to it than this share of its half-width."""

UNLIKELY = 4.0
"""Standard deviations of chi-square beyond which residuals are too small for the stated noise."""

LOUD = 2.0
"""Residuals this many times the stated noise are worth saying."""

_SUSPECTS = {"gears": "harmonics", "gravity": "gravity", "backlash": "", "a wrong noise_std": ""}
"""What makes an arm move in ways that geometry does not have, and the term that would model it."""


@dataclass(frozen=True, slots=True)
class Improvement:
    """How much of the held-out error is left.

    Attributes:
        ratio: RMS after over RMS before.
        low, high: 95 % confidence interval of the ratio, by the bootstrap over rows.
    """

    ratio: float
    low: float
    high: float


def improvement(held_out: HeldOut, seed: int) -> Improvement:
    """Returns what is left of the held-out error, with its confidence interval (Efron & Tibshirani 1993).

    Args:
        held_out: error sizes before and after, row by row.
        seed: of the resampling.
    """
    both = np.isfinite(held_out.before) & np.isfinite(held_out.after)
    before, after = held_out.before[both] ** 2, held_out.after[both] ** 2
    if not len(before):
        return Improvement(np.nan, np.nan, np.nan)
    whole, random = _ratio(before, after), np.random.Generator(np.random.Philox(seed))
    before, after = _grouped(random, before, after)
    ratios = np.array([_ratio(before[rows], after[rows]) for rows in _resamples(random, len(before))])
    low, high = np.quantile(ratios, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    return Improvement(whole, float(low), float(high))


def judge(held_out: HeldOut, fit: Fit, seed: int, uncalibrated: str | None, beyond: tuple[Term, ...] = ()) -> Verdict:
    """Returns the verdict and its reasons.

    Args:
        held_out: errors on rows that were not fitted.
        fit: the final fit.
        seed: of the bootstrap.
        uncalibrated: what of the tool's pose the readings cannot see, in words, if anything.
        beyond: what the model has beyond geometry.
    """
    problem = fit.problem
    change, size = improvement(held_out, seed), held_out.residuals
    fell = f"from {in_millimetres(size.before.rms)} to {in_millimetres(size.after.rms)} RMS on {held_out.method}"
    interval = f"what is left is {change.low:.1%} to {change.high:.1%} of it, with 95 % confidence"
    enough = size.count >= FEWEST_ROWS
    improved = change.high < 1.0 and enough
    if improved:
        reasons = [f"Held-out error fell {fell}: {interval}."]
    elif size.count == 0:
        reasons = ["No held-out row could be predicted: every beam looks away from its plane. Check planes and units."]
    elif not enough:
        reasons = [
            f"Held-out error went {fell}, but {size.count} held-out rows prove nothing: {FEWEST_ROWS} is the least "
            "that can, with 95 % confidence. Take more readings."
        ]
    else:
        reasons = [
            f"Held-out error did not fall for certain, {fell}: {interval}. "
            "Take more readings, spread over the joints' ranges, or free fewer parameters."
        ]
    stuck = [name for name, at in zip(problem.names, _at_bound(problem, fit.x), strict=True) if at]
    if stuck:
        verb = "sits at its bound" if len(stuck) == 1 else "sit at their bounds"
        reasons.append(f"{listed(stuck)} {verb}: widen `within` for them, or look for a wrong nominal value or unit.")
    if uncalibrated:
        reasons.append(uncalibrated)
    said = _noise_in_words(check_noise(fit), problem.model_std, beyond)
    if said:
        reasons.append(said)
    return Verdict(improved and not stuck, tuple(reasons))


def _noise_in_words(check: NoiseCheck, model_std: float, beyond: tuple[Term, ...]) -> str | None:
    """Returns what a person should know where residuals disagree with the stated noise."""
    test = f"chi-square {check.chi_square:.3g} where {check.freedom:.3g} is expected"
    if model_std > 0.0 and check.ratio > LOUD:
        suspects = [cause for cause, term in _SUSPECTS.items() if term not in beyond]
        return (
            f"The arm moves in ways this model does not have: residuals are {check.ratio:.0f}x the stated noise "
            f"({test}). Intervals are widened to match; {', '.join(suspects[:-1])} or {suspects[-1]} may explain it."
        )
    if model_std > 0.0:
        return (
            f"Residuals are {check.ratio:.2f}x the stated noise ({test}): noise_std is too small, or the arm moves in "
            "ways this model does not have. Intervals are widened to match."
        )
    if check.deviation < -UNLIKELY:
        return (
            f"Residuals are only {check.ratio:.2f}x the stated noise ({test}): noise_std may be too large, and "
            "intervals with it; they stay as stated."
        )
    return None


def _ratio(before: Float[np.ndarray, "rows"], after: Float[np.ndarray, "rows"]) -> float:
    return float(np.sqrt(np.sum(after) / max(float(np.sum(before)), 1e-300)))


def _grouped(
    random: np.random.Generator, before: Float[np.ndarray, "rows"], after: Float[np.ndarray, "rows"]
) -> tuple[Float[np.ndarray, "groups"], Float[np.ndarray, "groups"]]:
    """Returns the squares of many rows summed in groups dealt at random, which vary as the rows' own sums do."""
    if len(before) <= 2 * GROUPS:
        return before, after
    group = random.permutation(len(before)) % GROUPS
    return np.bincount(group, before), np.bincount(group, after)


def _resamples(random: np.random.Generator, count: int):
    for _ in range(RESAMPLES):
        yield random.integers(0, count, count)


def _at_bound(problem: Problem, x: Float[np.ndarray, "parameters"]) -> Float[np.ndarray, "parameters"]:
    return np.abs(x) > problem.half_width * (1.0 - AT_BOUND)
