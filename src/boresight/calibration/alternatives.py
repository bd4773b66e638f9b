"""Slips that no small correction mends, tried one by one where a fit is bad.

Each of `slips` is made undone, and told where the readings then fit.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from boresight.calibration.campaign import Campaign
from boresight.calibration.gross import beyond_help
from boresight.calibration.placement import find_frames
from boresight.calibration.problem import MISSED_M, Problem
from boresight.calibration.robust import Fit
from boresight.calibration.slips import slips
from boresight.calibration.thinning import thinned
from boresight.calibration.unit_slips import unit_slips
from boresight.errors import InputError
from boresight.inference.score_tests import QUADRATIC, fit_robustly
from boresight.sensing import Cell
from boresight.sensing.linear import slopes_of

ROWS = 300
"""Rows that stand for many."""

NEARER = 0.8
"""An alternative is fitted where nominal errors typically fall to this share: a slip of 60 mm is no larger than what
wrong links leave."""

BETTER = 0.25
"""It explains the readings where what it leaves falls to this share."""

FITTED, STEPS = 6, 8
FEWEST = 3
SETTLED = 0.01


@dataclass(frozen=True, slots=True)
class Alternative:
    """A slip that explains the readings.

    Attributes:
        effect: what it is: `deck flipped`, `j3 counts backwards`, `targets`, `row order`.
        words: what it is and what to do, a sentence without its full stop.
        ratio_before: residuals over the stated noise as the result is, rows that were left out counted.
        ratio_after: the same with the slip undone.
    """

    effect: str
    words: str
    ratio_before: float
    ratio_after: float

    @property
    def sentence(self) -> str:
        """What a person should know."""
        return (
            f"{self.words}: residuals fall from {self.ratio_before:.2g}x to {self.ratio_after:.2g}x the stated noise."
        )


def find_alternatives(found: Fit, nominal: Cell, campaign: Campaign, seed: int) -> tuple[Alternative, ...]:
    """Returns the slips that explain what a bad fit leaves, the best first.

    Args:
        found: the fit.
        nominal: the cell before it.
        campaign: where unknown frames are found anew for each slip.
        seed: of that search.
    """
    free = tuple(f for f in found.problem.freedoms if f.parameter in nominal.index)
    problem = Problem(nominal, found.problem.readings, free)
    problem = problem.on(thinned(problem.readings, ROWS))
    before, cost = _typical(problem), _fitted_cost(problem)
    promising = []
    for effect, words, cell, readings in chain(
        slips(nominal, problem.readings), unit_slips(nominal, problem.readings, campaign)
    ):
        trial = _placed(replace(problem, cell=cell, readings=readings), campaign, seed)
        if trial is not None and (typical := _typical(trial)) <= NEARER * before:
            promising.append((typical, effect, words, trial))
    told = []
    for _, effect, words, trial in sorted(promising, key=lambda each: each[0])[:FITTED]:
        after = _fitted_cost(trial)
        if after <= BETTER**2 * cost:
            told.append(Alternative(effect, words, _ratio(cost, problem), _ratio(after, problem)))
    return tuple(sorted(told, key=lambda each: each.ratio_after))


def _placed(problem: Problem, campaign: Campaign, seed: int) -> Problem | None:
    """Returns the problem with its unknown frames where these readings put them; None where there is no such place."""
    unknown = campaign.sought
    if not unknown - set(problem.cell.offsets):
        return problem
    try:
        placed = find_frames(problem.cell, problem.readings, unknown, seed, campaign.priors, quick=True)
    except InputError:
        return None
    return replace(problem, cell=placed.cell)


def _typical(problem: Problem) -> float:
    """Returns the mean of the nominal errors' square roots, squared [m]: rows that fit count, gross ones little."""
    errors = np.abs(np.nan_to_num(problem.errors(np.zeros(len(problem.names))), nan=MISSED_M))
    return float(np.mean(np.sqrt(errors[problem.readings.read]))) ** 2


def _fitted_cost(problem: Problem) -> float:
    """Returns what a robust fit within bounds leaves, over the stated variances, gross residuals by their size."""
    x, read, std = np.zeros(len(problem.names)), problem.readings.read, problem.readings.std
    precision, best = 1.0 / problem.prior_std**2, np.inf
    for _ in range(STEPS):
        errors = problem.errors(x)
        seen = read & np.isfinite(errors)
        now = _cost(errors[seen] / std[seen], precision * x**2) + _cost(MISSED_M / std[read & ~seen])
        if now > (1.0 - SETTLED) * best:
            break
        best = now
        columns = (slopes_of(problem.model, x, problem.readings) / std[:, :, None])[seen]
        step = fit_robustly(columns, -errors[seen] / std[seen], precision, x)
        x = np.clip(x + step.step, -problem.half_width, problem.half_width)
    return float(min(best, now))


def _cost(ratio: np.ndarray, of_priors: np.ndarray | float = 0.0) -> float:
    size = np.abs(ratio)
    return float(np.sum(np.minimum(size, QUADRATIC) * (2.0 * size - np.minimum(size, QUADRATIC))) + np.sum(of_priors))


def _ratio(cost: float, problem: Problem) -> float:
    return float(np.sqrt(cost / max(problem.readings.count - len(problem.names), 1)))


def is_bad(found: Fit, unknown: frozenset[str]) -> bool:
    """Returns whether a fit leaves so much that slips are worth trying; frames found anew each time take longer."""
    left_out = int(np.count_nonzero(~found.kept))
    return beyond_help(found) or left_out > 0.1 * len(found.kept) or (not unknown and left_out >= FEWEST)
