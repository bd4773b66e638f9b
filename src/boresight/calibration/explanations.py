"""Which missing effects explain the residuals: score tests of all of them, and a fit of the best few."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from boresight.arm import is_further
from boresight.calibration.campaign import TERMS, Freedom
from boresight.calibration.effect_tests import EffectTests, critical, state_of
from boresight.calibration.effects import drifting_links, effects_of, step
from boresight.calibration.explanation import Explanation
from boresight.calibration.jumps import Jump
from boresight.calibration.linear import equipped
from boresight.calibration.problem import Problem
from boresight.calibration.robust import Fit, continued
from boresight.calibration.thinning import thinned
from boresight.inference.score_tests import scores
from boresight.units import UNIT_OF, Quantity

_QUANTITY: dict[str, Quantity] = {unit: quantity for quantity, unit in UNIT_OF.items()}

ROWS = 500
"""Rows that stand for many: what these do not show is not worth naming."""

TRIED, REFITTED, TOLD = 12, 5, 3
"""Effects fitted linearly, of those fitted in full, and told at most."""

MATERIAL = 0.8
"""Squared residuals, gross ones by their size, must fall to this share at least, or the tool move."""

AS_WELL = 1.5
"""Effects that leave so many times what the best one leaves are no explanation beside it."""

USUAL: dict[Quantity, float] = {"length": 0.05, "angle": 0.05, "number": 0.02}
"""How large [m, rad, 1] an effect may be, as a standard deviation."""

CERTAIN = 6.0
"""Standard deviations from zero at which an effect counts that moves the tool and hardly changes residuals."""

BENT = 5.0
"""A fit whose residuals are so many times the stated noise may have bent so far that a score there misleads."""

FAR = 4.0
"""An effect of more than so many times its usual size is none of those that are looked for."""


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
    tests = EffectTests.of(fit)
    columns = [tests.normalised(effect.columns) for effect in effects]
    stds = [np.full(effect.columns.shape[2], USUAL[effect.quantity]) for effect in effects]
    found = scores(tests.base, columns, stds)
    spread = tests.spread(tests.base)
    sizes = np.array([own.shape[1] for own in columns])
    order = np.argsort(-(found - 2.0 * spread * sizes))[:TRIED]
    limits = critical(sizes, len(effects))
    before = state_of(full)
    candidates = []
    for place in order:
        if found[place] < 0.25 * limits[place]:
            continue
        effect = effects[place]
        trial = tests.with_effect(columns[place], stds[place])
        if tests.base.cost - trial.cost > limits[place] * tests.spread(trial):
            candidates.append(tests.explanation(effect, trial, before))
    candidates.sort(key=lambda each: each.cost + 4.0 * spread * each.numbers)
    refitted = [_refitted(full, each, before, full.x) for each in candidates[:REFITTED]] + candidates[REFITTED:]
    if before[0] > BENT:
        refitted += _from_nominal(full, fit, before)
    told = [each for each in refitted if _material(each, tests.base.cost, radius_m)]
    told.sort(key=lambda each: each.cost + 4.0 * spread * each.numbers)
    return tuple(_distinct([each for each in told if each.cost <= AS_WELL * told[0].cost]))[:TOLD]


def _from_nominal(full: Fit, few: Fit, before: tuple[float, int]) -> Iterator[Explanation]:
    """Yields what the constants that are likeliest from the nominal model explain: a bad fit has bent to them.

    Args:
        full: the fit.
        few: the same on a few of its rows.
        before: what it leaves, and how many rows it leaves out.
    """
    nominal = replace(few, search=replace(few.search, best=np.zeros(len(few.x))))
    effects = [each for each in effects_of(nominal.problem, nominal.x, gravity=False) if each.parameters]
    tests = EffectTests.of(nominal)
    columns = [tests.normalised(effect.columns) for effect in effects]
    stds = [np.full(effect.columns.shape[2], USUAL[effect.quantity]) for effect in effects]
    for place in np.argsort(-scores(tests.base, columns, stds))[:REFITTED]:
        trial = tests.with_effect(columns[place], stds[place])
        found = tests.explanation(effects[place], trial, before)
        yield _refitted(full, found, before, trial.step[: len(full.x)])


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


def _refitted(fit: Fit, found: Explanation, before: tuple[float, int], near: Float[np.ndarray, "free"]) -> Explanation:
    """Returns an explanation as a full fit from near given corrections has it, where parameters model the effect."""
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
    start = np.append(np.clip(near, -problem.half_width, problem.half_width), np.zeros(len(added)))
    start[len(fit.x)] = found.value
    again = continued(larger, start)
    ratio, left_out = state_of(again)
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
