"""Whether to use a result, and for what: its causes of rejection first, each as a sentence that a person can act on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.calibration.alternatives import Alternative
from boresight.calibration.campaign import Term
from boresight.calibration.explanation import Explanation
from boresight.calibration.gross import MOST_LEFT_OUT, grossly_off, share_left_out
from boresight.calibration.holdout import HeldOut
from boresight.calibration.improvement import FEWEST, Improvement, held_out_grossly_off, improvement
from boresight.calibration.problem import Problem
from boresight.calibration.result import AcceptedFor, Verdict
from boresight.calibration.robust import Fit, NoiseCheck, check_noise
from boresight.inference import Accuracy, listed, uncalibrated_in_words
from boresight.search import Outcome
from boresight.units import in_millimetres

AT_BOUND = 1e-4
"""A parameter is held back by its bound where it is nearer to it than this share of its half-width."""

UNLIKELY = 4.0
"""Standard deviations of chi-square beyond which residuals are too small for the stated noise."""

LOUD = 2.0
"""Residuals this many times the stated noise are worth saying."""

EXPLAINED, MATERIAL = 0.7, 0.4
"""An effect that brings residuals down to this share, and moves the tool by this share of its 95 % radius, is to be
estimated before the result is used."""

GIVEN, MOSTLY_READ = 1.0 / 3.0, 0.5
"""The readings give an accuracy where they bring the tool's standard deviation down to this share of what it was before
any, in every direction, or where this share of its variance comes from them and not from priors."""

_SUSPECTS = {"gears": "harmonics", "gravity": "gravity", "backlash": "", "a wrong noise_std": ""}
"""What makes an arm move in ways that geometry does not have, and the term that would model it."""


@dataclass(frozen=True)
class Evidence:
    """What a verdict is made from.

    Attributes:
        held_out: errors on rows that were not fitted.
        fit: the final fit.
        accuracy: of the tool, absolute and relative.
        gain: predicted fall of the tool's mean squared position error over what the corrections move it by, squared:
            1 where nothing but they is known.
        explanations: missing effects that explain the residuals, in the order of how well.
        explained: the same as sentences.
        alternatives: slips that explain them.
        assumptions: sentences on what no reading can check.
        beyond: what the model has beyond geometry.
        seed: of the bootstrap.
    """

    held_out: HeldOut
    fit: Fit
    accuracy: Accuracy
    gain: float = 1.0
    explanations: tuple[Explanation, ...] = ()
    explained: tuple[str, ...] = ()
    alternatives: tuple[Alternative, ...] = ()
    assumptions: tuple[str, ...] = ()
    beyond: tuple[Term, ...] = ()
    seed: int = 0


def judge(evidence: Evidence) -> Verdict:
    """Returns the verdict and its reasons."""
    change = improvement(evidence.held_out, evidence.seed)
    causes = tuple(_causes(evidence, change))
    noise = _noise_in_words(check_noise(evidence.fit), evidence.fit.problem.model_std, evidence)
    rest = () if noise is None else (noise,)
    if causes:
        told = change.configurations == 0 or any(_went(evidence.held_out) in cause for cause in causes)
        fell = () if told else (_fell(evidence.held_out, change),)
        return Verdict(False, (*dict.fromkeys((*causes, *fell, *rest)),), None)
    purpose = accepted_for(evidence.accuracy)
    return Verdict(
        True,
        (_fell(evidence.held_out, change), _purpose(purpose, evidence.accuracy), *evidence.assumptions, *rest),
        purpose,
    )


def accepted_for(accuracy: Accuracy) -> AcceptedFor:
    """Returns which accuracy of the tool the readings give: the absolute one, the relative one, or part of it."""
    for name, each in (("absolute", accuracy.absolute), ("relative", accuracy.relative)):
        read = each.remaining <= GIVEN or each.noise_share > MOSTLY_READ
        if each.determined and read:
            return "absolute" if name == "absolute" else "relative"
    return "partial"


def _purpose(purpose: AcceptedFor, accuracy: Accuracy) -> str:
    relative = in_millimetres(accuracy.relative.median)
    if purpose == "absolute":
        return (
            f"Accepted for absolute accuracy: tool position within {in_millimetres(accuracy.absolute.median)} (95 %, "
            f"median over the work space) in the frame of its base and targets, {relative} relative to itself."
        )
    if purpose == "relative":
        absolute = (
            f"within {in_millimetres(accuracy.absolute.median)} only"
            if accuracy.absolute.determined
            else "not determined by these readings"
        )
        return (
            f"Accepted for relative accuracy: tool positions within {relative} after the best rigid motion (95 %, "
            f"median over the work space); in the frame of base and targets {absolute}."
        )
    return f"Accepted in part. {uncalibrated_in_words(accuracy.absolute.pose)}"


def _causes(evidence: Evidence, change: Improvement) -> list[str]:
    """Returns why a result is rejected, the cause before its symptoms; nothing where it is accepted."""
    fit, size = evidence.fit, evidence.held_out.residuals
    problem = fit.problem
    said = [alternative.sentence for alternative in evidence.alternatives[:2]]
    said += [
        words
        for found, words in zip(evidence.explanations, evidence.explained, strict=True)
        if _contradicts(found, evidence.accuracy)
    ][:2]
    if share_left_out(fit) > MOST_LEFT_OUT:
        said.append(
            f"{np.count_nonzero(~fit.kept)} of {len(fit.kept)} rows do not fit with the others and were left out; with "
            f"more than {MOST_LEFT_OUT:.0%}, the others may be the wrong ones: check target names, planes and units."
        )
    if grossly_off(fit):
        said.append(
            f"Residuals stay at {in_millimetres(problem.model_std)}, {check_noise(fit).ratio:.2g}x the stated noise, "
            f"which is more than gears and gravity do to an arm of {problem.cell.arm.reach:.3g} m: something else is "
            "wrong."
        )
    elif held_out_grossly_off(evidence.held_out, problem.cell.arm.reach):
        said.append(
            f"The calibrated arm fits the rows it was fitted to and not the held-out ones, {size.method}: errors of "
            f"{in_millimetres(size.after.rms)} there. Check their joints, targets and units, and whether anything was "
            "moved before they were taken."
        )
    if fit.search.outcome is Outcome.EVALUATIONS:
        said.append(
            "Least squares did not converge: the readings leave directions open in which the fit still moves. "
            "Take more readings, spread over the joints' ranges, or estimate fewer parameters."
        )
    if size.count == 0:
        said.append("No held-out row could be predicted: every beam misses its plane. Check planes and units.")
    elif change.configurations < FEWEST:
        said.append(
            f"{_went(evidence.held_out)}, but {_configurations(change.configurations)} "
            f"cannot prove an improvement: 95 % confidence takes at least {FEWEST}. Take more readings."
        )
    elif not change.high < 1.0:
        advice = "" if said else " Take more readings, spread over the joints' ranges, or estimate fewer parameters."
        said.append(f"No significant improvement. {_went(evidence.held_out)}: {_interval(change)}.{advice}")
    if evidence.gain < 0.0:
        said.append("The corrections are expected to move the tool away from the truth, not towards it.")
    stuck = [name for name, at in zip(problem.names, _at_bound(problem, fit.x), strict=True) if at]
    if stuck:
        verb = "sits at its bound" if len(stuck) == 1 else "sit at their bounds"
        said.append(f"{listed(stuck)} {verb}: widen `within` for them, or look for a wrong nominal value or unit.")
    return said


def _contradicts(found: Explanation, accuracy: Accuracy) -> bool:
    """Returns whether an effect that explains residuals moves the tool too far for a result without it to be loaded.

    The radius is no measure where unexplained residuals have widened it: it grows with what the effect does.
    """
    radius = accuracy.absolute.median if accuracy.absolute.determined else accuracy.relative.median
    explained = found.ratio_after < EXPLAINED * found.ratio_before
    return found.tool_m > radius or (explained and found.tool_m > MATERIAL * radius)


def _went(held_out: HeldOut) -> str:
    size = held_out.residuals
    return (
        f"Held-out error went from {in_millimetres(size.before.rms)} to {in_millimetres(size.after.rms)} RMS on "
        f"{held_out.method}"
    )


def _fell(held_out: HeldOut, change: Improvement) -> str:
    return f"{_went(held_out).replace('went', 'fell') if change.ratio < 1.0 else _went(held_out)}: {_interval(change)}."


def _interval(change: Improvement) -> str:
    return f"what is left is {change.low:.1%} to {change.high:.1%} of it, with 95 % confidence"


def _noise_in_words(check: NoiseCheck, model_std: float, evidence: Evidence) -> str | None:
    """Returns what a person should know where residuals disagree with the stated noise."""
    test = f"chi-square {check.chi_square:.3g} where {check.freedom:.3g} is expected"
    explained = bool(evidence.explanations or evidence.alternatives) or grossly_off(evidence.fit)
    if model_std > 0.0 and check.ratio > LOUD:
        suspects = [cause for cause, term in _SUSPECTS.items() if term not in evidence.beyond]
        may = "" if explained else f" {', '.join(suspects[:-1])} or {suspects[-1]} may explain it."
        return (
            f"Unmodelled error: residuals are {check.ratio:.0f}x the stated noise ({test}). Intervals are widened to "
            f"match.{may[:1] + may[1:2].upper() + may[2:]}"
        )
    if model_std > 0.0:
        why = "" if explained else ": noise_std is stated too small, or the arm has unmodelled errors"
        return f"Residuals are {check.ratio:.2f}x the stated noise ({test}){why}. Intervals are widened to match."
    if check.deviation < -UNLIKELY:
        return (
            f"Residuals are only {check.ratio:.2f}x the stated noise ({test}): noise_std may be too large, and "
            "intervals with it; they stay as stated."
        )
    return None


def _at_bound(problem: Problem, x: Float[np.ndarray, "parameters"]) -> Float[np.ndarray, "parameters"]:
    return np.abs(x) > problem.half_width * (1.0 - AT_BOUND)


def _configurations(count: int) -> str:
    return "1 held-out configuration" if count == 1 else f"{count} held-out configurations"
