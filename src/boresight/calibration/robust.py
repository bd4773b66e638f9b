"""Least squares that gross errors do not pull: rows that do not fit with the others lose their say.

Where plain least squares leaves more than chance allows, every row's weight falls with its residual
(pseudo-Huber, iteratively reweighted), then rows beyond what chance allows are left out altogether and may come
back, until the same rows stay (Huber & Ronchetti 2009; Maronna et al. 2019). On clean normal data one row in a
million is left out, so nothing is lost by it. Beside the rows, the standard deviation that the model itself
leaves unexplained is found (`inference.model_std`).
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Float, Int

from boresight.calibration.concentration import concentrated
from boresight.calibration.problem import Problem
from boresight.inference import model_std
from boresight.search import LeastSquares, Outcome, tall_least_squares

CHANCE = 1e-6
"""A row is left out where its residual is so large that chance alone gives one in a million."""

SOFT_ROUNDS, ROUNDS, HARD_ROUNDS = 8, 40, 6
"""Rounds of falling weights before rows are left out, and rounds in all; clean data take three or four. From rows
that agree, weights do not fall first (a weight of 0.02 on a row 1,600 standard deviations off still bends a fit of
35 rows), and six rounds are enough or were in vain."""

ROUGH, THOROUGH = 10, 200
"""Evaluations a round while weights are still coming, and once they have. Readings that are stated far better
than the arm can be modelled drag parameters they hardly see to the ends of their bounds: 1,350 evaluations for
400 real positions if every round is followed to its end, 60 so."""

TRUSTING = 50
"""Evaluations of plain least squares, every row believed; clean campaigns take 13 to 33."""

PLENTY = 20
"""With this many values for each parameter, falling weights find gross errors by themselves."""

_SETTLED = 0.01
_SOFT = 2.0
_ORDINARY = 0.3
_CLOSE = 1e-9


@dataclass(frozen=True)
class Fit:
    """A robust fit.

    Attributes:
        problem: what was fitted in the end: its rows' weights 1 or 0, its model_std what was left unexplained.
        search: where it ended, over all rounds.
        ratio: (rows,) size of each row's studentised residual, in standard deviations of such a residual.
    """

    problem: Problem
    search: LeastSquares
    ratio: Float[np.ndarray, "rows"]

    @property
    def x(self) -> Float[np.ndarray, "parameters"]:
        """The corrections found."""
        return self.search.best

    @property
    def kept(self) -> Bool[np.ndarray, "rows"]:
        """Which rows were used."""
        return self.problem.row_weight > 0.0


@dataclass(frozen=True, slots=True)
class NoiseCheck:
    """The residuals that were used against the noise the campaign states.

    Attributes:
        chi_square: sum of squared residuals over their stated variances.
        freedom: what it should be about: values less the number of parameters that they decide.
    """

    chi_square: float
    freedom: float

    @property
    def ratio(self) -> float:
        """Size of the residuals over that of the stated noise."""
        return float(np.sqrt(self.chi_square / self.freedom))

    @property
    def deviation(self) -> float:
        """How far chi-square is from what it should be, in its standard deviations."""
        return float((self.chi_square - self.freedom) / np.sqrt(2.0 * self.freedom))


def check_noise(fitted: Fit) -> NoiseCheck:
    """Returns the chi-square test of a fit's residuals against the stated noise."""
    problem, kept = fitted.problem, fitted.kept
    scaled = (problem.errors(fitted.x) / problem.readings.std)[kept]
    seen = np.isfinite(scaled) & problem.readings.read[kept]
    decided = float(np.sum(problem.leverage(fitted.x)[kept][seen]))
    return NoiseCheck(float(np.sum(scaled[seen] ** 2)), max(float(np.count_nonzero(seen)) - decided, 1.0))


def fit(problem: Problem, start: Float[np.ndarray, "parameters"], *, move: bool = True) -> Fit:
    """Returns the robust least-squares optimum reached from a start.

    Rows are trusted first: plain least squares comes before any weighing. Where that leaves nothing to explain, it
    is the answer; else sets of rows that agree with each other are tried (`concentration`) if readings are not plenty,
    and weights that fall from the start on, until one does; the lowest trimmed cost wins. Weighing first was tried
    alone: at the nominal model residuals are the arm's errors and not the rows', and of 200 clean campaigns of 35
    rows and 25 parameters it ended in a wrong optimum in 15. Without sets that agree, 15 % gross errors were all
    found in 1 of 20 such campaigns, with them in 8 of 8 (more in benchmarks/results.md).

    Of many rows a few are fitted so first (`thinning`), and then all from where those lead.

    Args:
        problem: what to fit; its weights and model_std are starting values.
        start: where to begin.
        move: whether to move from there at all, or only to weigh rows and find what is left unexplained.
    """
    if not move:
        return _settled(problem, LeastSquares.at(start, 0.0), move=False)
    few = problem.thinned()
    if few is not problem:
        return _spread(fit(few, start), problem, ROUNDS)
    best = _settled(problem, refine(problem, start, TRUSTING), move=True)
    tried, others = [best], _other_ways(problem, start)
    while not _explained(best) and (another := next(others, None)) is not None:
        tried.append(another)
        best = lower(best, another)
    seconds, evaluations = (sum(getattr(each.search, name) for each in tried) for name in ("seconds", "evaluations"))
    return replace(best, search=replace(best.search, seconds=seconds, evaluations=evaluations))


def continued(problem: Problem, start: Float[np.ndarray, "parameters"]) -> Fit:
    """Returns the robust optimum near a start from which rows are weighed and the model's own error is known.

    Args:
        problem: what to fit, its weights and model_std those of a fit of nearly the same model.
        start: that fit's end.
    """
    few = problem.thinned()
    if few is not problem:
        return _spread(continued(few, start), problem, HARD_ROUNDS)
    return _settled(problem, refine(problem, start), move=True, soft_rounds=0, rounds=HARD_ROUNDS)


def _spread(found: Fit, problem: Problem, rounds: int) -> Fit:
    """Returns the fit of all rows, of which those that a few of them speak against are left out from the start."""
    everything = problem.weighed(np.ones(len(problem.readings)), found.problem.model_std)
    whole = _settled(everything, LeastSquares.at(found.x, 0.0), move=True, soft_rounds=0, rounds=rounds)
    seconds, evaluations = (getattr(whole.search, n) + getattr(found.search, n) for n in ("seconds", "evaluations"))
    return replace(whole, search=replace(whole.search, seconds=seconds, evaluations=evaluations))


def _explained(found: Fit) -> bool:
    """Returns whether a fit leaves nothing to explain, and keeps so many rows that it is no coincidence."""
    readings, free = found.problem.readings, len(found.x)
    spare = int(np.sum(readings.channels[found.kept])) - free
    return found.problem.model_std == 0.0 and bool(found.kept.all() or spare > 0.5 * (readings.count - free))


def _other_ways(problem: Problem, start: Float[np.ndarray, "parameters"]) -> Iterator[Fit]:
    """Yields fits that do not begin by believing every row."""
    if problem.readings.count < PLENTY * len(start):
        for rows, x in concentrated(problem, start):
            agreed = problem.weighed(rows.astype(float), problem.model_std)
            search = refine(agreed, x, TRUSTING)
            yield _settled(agreed, search, move=True, soft_rounds=0, rounds=HARD_ROUNDS)
    yield _settled(problem, LeastSquares.at(start, 0.0), move=True)


def lower(first: Fit, second: Fit) -> Fit:
    """Returns the fit of lower trimmed cost, the first if they are level, both judged by the smaller model_std."""
    judge = min((first, second), key=lambda each: each.problem.model_std).problem
    return second if trimmed_cost(judge, second.x) < trimmed_cost(judge, first.x) else first


def _settled(
    problem: Problem, search: LeastSquares, *, move: bool, soft_rounds: int = SOFT_ROUNDS, rounds: int = ROUNDS
) -> Fit:
    """Returns the fit once the same rows stay, from a search that may have begun."""
    began, before = time.perf_counter(), search.seconds
    evaluations = 0 if search.seconds == 0.0 else search.evaluations
    ratio, met = np.zeros(len(problem.readings)), set()
    for round_ in range(rounds):
        soft = move and round_ < soft_rounds
        weighed, ratio = _weighed(problem, search.best, soft=soft)
        if weighed is None and (evaluations or not move):
            break
        problem = weighed or problem
        if not move:
            # Where nothing moves, what came once comes again: rows that go and come back would do so to the last round.
            state = (problem.row_weight.tobytes(), problem.model_std)
            if state in met:
                break
            met.add(state)
        if move:
            still_soft = soft and bool(np.any((problem.row_weight > 0.0) & (problem.row_weight < 1.0)))
            search = refine(problem, search.best, ROUGH if still_soft else THOROUGH)
            evaluations += search.evaluations
    cost = problem.square(search.best)
    outcome = search.outcome if move else Outcome.CONVERGED
    seconds = before + time.perf_counter() - began
    return Fit(problem, LeastSquares(search.best, cost, outcome, evaluations, seconds), ratio)


def refine(problem: Problem, start: Float[np.ndarray, "parameters"], evaluations: int = THOROUGH) -> LeastSquares:
    """Returns the least-squares optimum reached from a start, inside the problem's bounds, its weights as given."""
    if not len(start):
        return LeastSquares.at(start, problem.square(start))
    return tall_least_squares(
        problem.square,
        problem.triangle,
        start,
        scale=problem.scale,
        lower=-problem.half_width,
        upper=problem.half_width,
        evaluations=evaluations,
    )


def trimmed_cost(problem: Problem, x: Float[np.ndarray, "parameters"]) -> float:
    """Returns the squared residuals over their variances, no row's counted for more than one left out, and priors."""
    channels = problem.readings.channels
    ratio = np.minimum(_sizes(problem.errors(x) / problem.std, channels), _thresholds(channels))
    return float(np.sum(channels * ratio**2) + np.sum((x / problem.prior_std) ** 2))


@lru_cache
def threshold(channels: int) -> float:
    """Returns the root mean square of a row's studentised channels that chance exceeds once in 1 / `CHANCE`."""
    return _quantile(channels, 1.0 - CHANCE)


def _thresholds(channels: Int[np.ndarray, "rows"]) -> Float[np.ndarray, "rows"]:
    """Returns the threshold of each row by its number of channels."""
    return np.array([0.0, *(threshold(count) for count in range(1, channels.max() + 1))])[channels]


def _quantile(channels: int, probability: float) -> float:
    from scipy import special

    return float(np.sqrt(2.0 * special.gammaincinv(channels / 2.0, probability) / channels))


def _weighed(problem: Problem, x: np.ndarray, *, soft: bool) -> tuple[Problem | None, np.ndarray]:
    """Returns the problem with rows weighed anew by their residuals, or None where nothing changes; and their sizes."""
    errors, read, channels = problem.errors(x), problem.readings.read, problem.readings.channels
    factor = _studentising(problem, x)
    typical = _typical_excess(errors / factor, problem.readings.std, channels)
    ratio = _sizes(errors / factor / np.hypot(problem.readings.std, typical), channels)
    kept = ratio <= _thresholds(channels)
    if soft and not kept.all():
        return problem.weighed(1.0 / np.sqrt(1.0 + (ratio / _SOFT) ** 2), typical), ratio
    seen = np.isfinite(errors) & kept[:, None] & read
    excess = model_std(errors[seen], problem.readings.std[seen], len(x))
    same_rows = np.array_equal(problem.row_weight, kept.astype(float))
    if same_rows and abs(excess - problem.model_std) <= _SETTLED * max(excess, problem.model_std):
        return None, ratio
    return problem.weighed(kept.astype(float), excess), ratio


def _studentising(problem: Problem, x: np.ndarray) -> Float[np.ndarray, "rows channels"]:
    """Returns what a fit does to the standard deviation of a row's errors (Cook & Weisberg 1982).

    Those of a row that was fitted shrink by sqrt(1 - leverage), those of one left out grow by sqrt(1 + leverage).
    """
    leverage = problem.leverage(x)
    fitted = (problem.row_weight > 0.0)[:, None]
    return np.sqrt(np.where(fitted, np.maximum(1.0 - leverage, 1e-3), 1.0 + leverage))


def _sizes(
    studentised: Float[np.ndarray, "rows channels"], channels: Int[np.ndarray, "rows"]
) -> Float[np.ndarray, "rows"]:
    """Returns the root mean square of each row's channels; infinite where a beam misses."""
    return np.nan_to_num(np.sqrt(np.sum(studentised**2, axis=1) / channels), nan=np.inf)


def _typical_excess(
    errors: Float[np.ndarray, "rows channels"],
    std: Float[np.ndarray, "rows channels"],
    channels: Int[np.ndarray, "rows"],
) -> float:
    """Returns the model's own standard deviation [m] that makes the median row an ordinary one.

    Up to half of the rows may be grossly wrong without moving it; 0 where the stated noise suffices.
    """
    medians = np.array([1.0, *(_quantile(count, 0.5) for count in range(1, channels.max() + 1))])
    ordinary = medians[channels]

    def surplus(variance: float) -> float:
        """Returns the share of the median row's variance that is lacking with so much more of it.

        As long as the same row of one channel is the median, it is linear: a few steps find where it is 0.
        """
        size = float(np.median(_sizes(errors / np.sqrt(std**2 + variance), channels) / ordinary))
        return 1.0 - size**-2.0 if size > 0.0 else -math.inf

    if surplus(0.0) <= 1.0 - (1.0 + _ORDINARY) ** -2.0:
        return 0.0
    largest = float(np.nanmax(np.abs(errors), initial=1e-12)) / float(ordinary.min())
    return math.sqrt(_root(surplus, largest**2))


def _root(falling: Callable[[float], float], end: float) -> float:
    """Returns where a falling function is 0 between 0 and an end, by false position (Illinois); else the end."""
    low, high, at_low, at_high = 0.0, end, falling(0.0), falling(end)
    if at_high > 0.0:
        return end
    while high - low > _CLOSE * high:
        middle = (high * at_low - low * at_high) / (at_low - at_high)
        value = falling(middle)
        if value == 0.0 or not low < middle < high:
            return middle
        if value > 0.0:
            low, at_low, at_high = middle, value, 0.5 * at_high
        else:
            high, at_high, at_low = middle, value, 0.5 * at_low
    return high
