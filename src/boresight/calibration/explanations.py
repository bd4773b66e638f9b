"""Which missing effects explain the residuals: score tests of all of them, and a fit of the best few."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from boresight.arm import is_further
from boresight.calibration.campaign import TERMS, Freedom
from boresight.calibration.configurations import configurations_of
from boresight.calibration.effects import Effect, drifting_links, effects_of, step
from boresight.calibration.jumps import Jump
from boresight.calibration.linear import equipped
from boresight.calibration.problem import Problem
from boresight.calibration.robust import Fit, check_noise, continued
from boresight.calibration.thinning import thinned
from boresight.inference.coverage import interval_factor
from boresight.inference.score_tests import LinearFit, fit_robustly, scores
from boresight.sensing.linear import slopes_of
from boresight.units import UNIT_OF, Quantity, in_millimetres

_QUANTITY: dict[str, Quantity] = {unit: quantity for quantity, unit in UNIT_OF.items()}

ROWS = 500
"""Rows that stand for many: what these do not show is not worth naming."""

TRIED, REFITTED, TOLD = 12, 5, 3
"""Effects fitted linearly, of those fitted in full, and told at most."""

FALSE_ALARMS = 1e-3
"""Probability with which chance alone has any effect explained in a campaign."""

MATERIAL = 0.8
"""Squared residuals, gross ones by their size, must fall to this share at least, or the tool move."""

AS_WELL = 1.5
"""Effects that leave so many times what the best one leaves are no explanation beside it."""

USUAL: dict[Quantity, float] = {"length": 0.05, "angle": 0.05, "number": 0.02}
"""How large [m, rad, 1] an effect may be, as a standard deviation."""

COMMON = 1.3
"""Where a value's variance is so many times the stated one, repeats of one reading share what is not noise."""

CERTAIN = 6.0
"""Standard deviations from zero at which an effect counts that moves the tool and hardly changes residuals."""

FAR = 4.0
"""An effect of more than so many times its usual size is none of those that are looked for."""


@dataclass(frozen=True, slots=True)
class Explanation:
    """An effect that explains residuals.

    Attributes:
        effect: its name: `sensor.bias`, `deck.offset`, `j3.gain`, `drift of j3.a`.
        parameters: the parameters that would model it; empty where none can.
        value: its size [m, rad or 1], of the first number where there are several.
        std: standard deviation of that.
        unit: m, rad or 1.
        numbers: how many numbers it has.
        ratio_before: residuals over the stated noise as the result is.
        ratio_after: the same with the effect estimated.
        left_out_before: rows left out as the result is.
        left_out_after: the same with the effect estimated.
        cost: squared residuals that are left over their variances, gross ones by size.
        tool_m: how far the tool would move over the work space [m], root mean square; NaN where not found.
    """

    effect: str
    parameters: tuple[str, ...]
    value: float
    std: float
    unit: str
    numbers: int
    ratio_before: float
    ratio_after: float
    left_out_before: int
    left_out_after: int
    cost: float
    tool_m: float = math.nan


def explain(fit: Fit, jumps: tuple[Jump, ...], *, gravity: bool, radius_m: float) -> tuple[Explanation, ...]:
    """Returns the effects that explain what a fit leaves, the best first; none where chance may have left it.

    Args:
        fit: the final fit.
        jumps: steps between blocks of rows that were found in it: they compete with effects that are constant.
        gravity: whether links may give way under their weight.
        radius_m: how far from the truth the tool is said to be at most: effects that move it further are material.
    """
    full = fit
    rows = thinned(fit.problem.readings, ROWS)
    if len(rows) < len(fit.ratio):
        fit = replace(fit, problem=fit.problem.on(rows), ratio=fit.ratio[rows])
    effects = [*effects_of(fit.problem, fit.x, gravity=gravity), *drifting_links(fit.problem, fit.x)]
    effects += [step(fit.problem.readings, fit.problem.cell, jump) for jump in jumps[:1]]
    tests = _Tests.of(fit)
    columns = [tests.normalised(effect.columns) for effect in effects]
    stds = [np.full(effect.columns.shape[2], USUAL[effect.quantity]) for effect in effects]
    found = scores(tests.base, columns, stds)
    spread = tests.spread(tests.base)
    sizes = np.array([own.shape[1] for own in columns])
    order = np.argsort(-(found - 2.0 * spread * sizes))[:TRIED]
    limits = _critical(sizes, len(effects))
    before = _state(full)
    candidates = []
    for place in order:
        if found[place] < 0.25 * limits[place]:
            continue
        effect = effects[place]
        trial = tests.with_effect(columns[place], stds[place])
        if tests.base.cost - trial.cost > limits[place] * tests.spread(trial):
            candidates.append(tests.explanation(effect, trial, before))
    candidates.sort(key=lambda each: each.cost + 4.0 * spread * each.numbers)
    refitted = [_refitted(full, each, before) for each in candidates[:REFITTED]] + candidates[REFITTED:]
    told = [each for each in refitted if _material(each, tests.base.cost, radius_m)]
    told.sort(key=lambda each: each.cost + 4.0 * spread * each.numbers)
    return tuple(_distinct([each for each in told if each.cost <= AS_WELL * told[0].cost]))[:TOLD]


def _distinct(found: list[Explanation]) -> Iterator[Explanation]:
    """Yields explanations without those that only add numbers to a better one."""
    for place, each in enumerate(found):
        if not any(set(other.parameters) < set(each.parameters) for other in found[:place] if other.parameters):
            yield each


def _material(found: Explanation, cost: float, radius_m: float) -> bool:
    if abs(found.value) > FAR * USUAL[_QUANTITY[found.unit]]:
        return False
    moved = math.isfinite(found.tool_m) and found.tool_m > 0.5 * radius_m and abs(found.value) > CERTAIN * found.std
    return found.cost <= MATERIAL * cost or moved


def _critical(sizes: np.ndarray, effects: int) -> np.ndarray:
    """Returns the chi-square that chance exceeds for one of so many effects in `FALSE_ALARMS` of all campaigns."""
    from scipy import special

    return special.chdtri(sizes, FALSE_ALARMS / max(effects, 1))


def _state(fit: Fit) -> tuple[float, int]:
    """Returns the residuals over the stated noise, and how many rows are left out."""
    return check_noise(fit).ratio, int(np.count_nonzero(~fit.kept))


@dataclass(frozen=True)
class _Tests:
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
    def of(cls, fit: Fit) -> _Tests:
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
        return (columns / self.fit.problem.readings.std[:, :, None])[self.read]

    def with_effect(self, own: Float[np.ndarray, "values numbers"], std: Float[np.ndarray, "numbers"]) -> LinearFit:
        base = self.base
        return fit_robustly(
            np.hstack([base.columns, own]),
            base.residual + base.columns @ base.step,
            np.append(self.precision, 1.0 / std**2),
            np.append(self.fit.x, np.zeros(len(std))),
            base.weight,
        )

    def explanation(self, effect: Effect, trial: LinearFit, before: tuple[float, int]) -> Explanation:
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


def _refitted(fit: Fit, found: Explanation, before: tuple[float, int]) -> Explanation:
    """Returns an explanation as a full fit has it, where parameters model the effect."""
    if not found.parameters:
        return found
    problem = fit.problem
    cell = problem.cell
    for term in TERMS:
        if any(is_further(name) for name in found.parameters) and not set(found.parameters) <= set(cell.index):
            cell = equipped(cell, (term,))
    quantity = {parameter.name: parameter.quantity for parameter in cell.parameters}
    names = [name for name in found.parameters if name in quantity]
    added = tuple(Freedom(name, None, USUAL[quantity[name]]) for name in names)
    larger = Problem(cell, problem.readings, (*problem.freedoms, *added))
    start = np.append(fit.x, np.zeros(len(added)))
    start[len(fit.x)] = found.value
    again = continued(larger, start)
    ratio, left_out = _state(again)
    first = len(fit.x)
    std = math.sqrt(max(float(again.problem.covariance(again.x)[first, first]), 0.0))
    cost = _huber_cost(again)
    if cost > found.cost * 1.5 and ratio > found.ratio_after * 1.2:
        return found
    return replace(
        found,
        value=float(again.x[first]),
        std=std,
        ratio_after=ratio,
        left_out_after=left_out,
        cost=cost,
        tool_m=_moved(fit, again),
    )


def _huber_cost(fit: Fit) -> float:
    problem = fit.problem
    scaled = problem.errors(fit.x) / problem.readings.std
    size = np.abs(scaled[np.isfinite(scaled) & problem.readings.read])
    return float(np.sum(np.where(size <= 3.0, size**2, 3.0 * (2.0 * size - 3.0))))


def _moved(fit: Fit, again: Fit) -> float:
    """Returns how far the tool of one fit is from the other's at the readings' configurations [m], root mean square."""
    joints = fit.problem.readings.joints[:ROWS]
    first, second = (each.problem.fitted(each.x).poses(joints)[:, :3, 3] for each in (fit, again))
    return float(np.sqrt(np.mean(np.sum((first - second) ** 2, axis=1))))


def explanation_in_words(found: Explanation, line: str | None) -> str:
    """Returns an explanation as a sentence.

    Args:
        found: the explanation.
        line: what to write into the campaign to estimate it, where that can be.
    """
    size = f" = {_amount(found.value, found.std, found.unit)}" if found.numbers == 1 else f" ({found.numbers} numbers)"
    back = ""
    if found.left_out_after != found.left_out_before:
        back = f", rows left out from {found.left_out_before} to {found.left_out_after}"
    how = "explains the residuals" if found.ratio_after < 2.0 else "explains part of the residuals"
    fell = f"from {found.ratio_before:.2g}x to {found.ratio_after:.2g}x the stated noise"
    said = f"`{found.effect}`{size} {how}: {fell}{back}."
    return said if line is None else f"{said} To estimate it: `{line}`."


def _amount(value: float, std: float, unit: str) -> str:
    if unit == "m":
        return f"{in_millimetres(value)} ± {in_millimetres(std)}"
    factor, name = (1e3, "mrad") if unit == "rad" else (1e2, "%")
    return f"{factor * value:.3g} ± {factor * std:.2g} {name}"
