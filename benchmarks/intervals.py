"""Whether the stated uncertainty is honest, and whether anything better is possible.

Over many simulated campaigns (truth, configurations and noise drawn afresh, robust least squares from the nominal
model):

- *variance / bound*: squared error of each parameter over its Cramér-Rao bound, the diagonal of (J'J)^-1 with the
  exact Jacobian at the truth and the true noise, no prior. Per campaign the bound is its own. The mean over campaigns
  is noisy (a chi-square with one degree of freedom each), so beside it stands the same with a control variate: the
  linear estimator at the truth, (J'J)^-1 J' noise, whose mean squared error is exactly the bound, is subtracted.
- *coverage*: share of true values within their 95 % intervals, `CompleteModel.half_width_95`.
- *ellipsoids*: share of true tool positions inside the predicted 95 % ellipsoids at 100 configurations spread over
  the work space, `PoseUncertainty.holds`; the model's own error, which simulated arms do not have, left out.

Directions that readings cannot see (`prior`) are left out of the first two.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from benchmarks.parallel import on_all_cores
from benchmarks.report import Figure, Report, Table, percent, spread
from benchmarks.space_arm import Drawn, Setup, draw, one_plane, three_planes, three_planes_estimated
from boresight.calibration import calibrate
from boresight.calibration.complete_model import CompleteModel, complete_model
from boresight.calibration.noise_size import noise_size
from boresight.calibration.robust import fit
from boresight.inference import posterior_covariance, sources, spread_configurations, tool_accuracy
from boresight.sensing import Cell

SETUPS = (one_plane(100), one_plane(35), three_planes(100), three_planes_estimated(100))


@dataclass(frozen=True)
class Trial:
    """What one campaign says of each free parameter, and of the tool.

    Attributes:
        squared: squared error over the bound.
        linear: the same of the linear estimator at the truth.
        covered: whether the truth lies in the stated interval.
        seen: whether the value comes from the data.
        held: share of tool positions inside their ellipsoids.
        left_out: share of rows left out.
        widened: whether some standard deviation was put down to the model.
    """

    squared: np.ndarray
    linear: np.ndarray
    covered: np.ndarray
    seen: np.ndarray
    held: float
    left_out: float
    widened: bool


def trial(seed: int, kind: Setup, stated: float = 1.0) -> Trial:
    """Returns a campaign's outcome; `stated` is the factor by which the campaign misstates its noise."""
    drawn = draw(kind, seed)
    readings = drawn.problem.readings
    found = fit(drawn.with_readings(replace(readings, std=stated * readings.std)), np.zeros(len(drawn.x)))
    known = complete_model(found, {}, noise_size(found))
    std = np.sqrt(np.diag(known.covariance))
    error = found.x - drawn.x
    bound, linear = cramer_rao(drawn)
    return Trial(
        squared=error**2 / bound,
        linear=linear**2 / bound,
        covered=np.abs(error) <= known.half_width_95,
        seen=np.array(sources(std, found.problem.prior_std)) == "data",
        held=held(drawn.truth, found.problem.fitted(found.x), known),
        left_out=float(np.mean(~found.kept)),
        widened=found.problem.model_std > 0.0,
    )


def cramer_rao(drawn: Drawn) -> tuple[np.ndarray, np.ndarray]:
    """Returns each parameter's bound, and the errors of the linear estimator that attains it."""
    sensitivity = drawn.problem.sensitivity(drawn.x)
    covariance = posterior_covariance(sensitivity, np.full(len(drawn.x), np.inf))
    return np.diag(covariance), covariance @ sensitivity.T @ (drawn.noise / drawn.problem.std).ravel()


def held(truth: Cell, identified: Cell, known: CompleteModel) -> float:
    """Returns the share of true tool positions inside the predicted 95 % ellipsoids."""
    moments = replace(known.moments, model_std=0.0)
    predicted = tool_accuracy(identified, moments, spread_configurations(identified, 100)).absolute.pose
    shift = truth.poses(predicted.joints)[:, :3, 3] - identified.poses(predicted.joints)[:, :3, 3]
    return float(np.mean(predicted.holds(shift)))


def same_as_default(seed: int, kind: Setup) -> float:
    """Returns by how many standard deviations `calibrate`, as it comes, differs from the fit measured here."""
    drawn = draw(kind, seed)
    result = calibrate(drawn.campaign())
    found = fit(drawn.problem, np.zeros(len(drawn.x)))
    std = np.sqrt(np.diag(result.covariance))
    identified = np.array([result.cell.values[n] - drawn.problem.cell.values[n] for n in drawn.problem.names])
    return float(np.max(np.abs(identified - found.x) / std))


def run(quick: bool) -> Report:
    count, checked = (200, 4) if quick else (2000, 20)
    figures, rows, noisy = [], [], []
    for kind in SETUPS:
        trials = on_all_cores(partial(trial, kind=kind), range(count))
        row, of_kind = _summary(kind, trials)
        apart = on_all_cores(partial(same_as_default, kind=kind), range(checked))
        rows.append((*row, f"{max(apart):.1e}"))
        figures += of_kind
    for kind in SETUPS[:2]:
        for stated in (1.0 / 3.0, 0.5, 2.0):
            trials = on_all_cores(partial(trial, kind=kind, stated=stated), range(count // 4))
            noisy.append((kind.name, f"{stated:g} x", *_coverages(trials)[1:]))
    header = ("campaign", "seen", "variance / bound, mean", "with control variate", "worst parameter, c. v.")
    cover = ("coverage, mean", "lowest", "highest", "ellipsoids hold", "rows left out", "widened")
    return Report(
        "intervals",
        f"{count} campaigns of each kind, robust least squares from the nominal model; the module's docstring "
        "says what each column is. ± is the Monte-Carlo standard error. The last column is the largest difference "
        f"between `calibrate` with the default solver and this fit over {checked} campaigns, in standard deviations.",
        tuple(figures),
        (
            Table("Variance and coverage", (*header, *cover, "default solver differs"), tuple(rows)),
            Table(
                f"Noise misstated in the campaign ({count // 4} campaigns each)",
                ("campaign", "stated / true", *cover),
                tuple(noisy),
            ),
        ),
    )


def _summary(kind: Setup, trials: list[Trial]) -> tuple[tuple[str, ...], list[Figure]]:
    squared, linear, seen = (np.array([getattr(t, name) for t in trials]) for name in ("squared", "linear", "seen"))
    used = seen.mean(axis=0) > 0.5
    plain, controlled = squared[:, used], squared[:, used] - linear[:, used] + 1.0
    mean, mean_error = _mean(controlled.mean(axis=1))
    each, each_error = _mean(controlled)
    worst = int(np.argmax(each))
    covered, *shown = _coverages(trials)
    row = (
        kind.name,
        f"{int(used.sum())} of {len(used)}",
        spread(*_mean(plain.mean(axis=1))),
        spread(mean, mean_error),
        f"{spread(each[worst], each_error[worst])} ({np.array([f.parameter for f in kind.freedoms])[used][worst]})",
    )
    holds, _ = _mean(np.array([t.held for t in trials]))
    ok = each[worst] - 2 * each_error[worst] <= 1.05
    figures = [
        Figure(f"worst variance / bound: {kind.name}", spread(each[worst], each_error[worst]), "<= 1.05", bool(ok)),
        Figure(f"coverage: {kind.name}", percent(covered), "93 to 97 %", 0.93 <= covered <= 0.97),
        Figure(f"ellipsoids: {kind.name}", percent(holds), "93 to 97 %", bool(0.93 <= holds <= 0.97)),
    ]
    return (*row, *shown), figures


def _coverages(trials: list[Trial]) -> tuple[float, str, str, str, str, str, str]:
    covered, seen = np.array([t.covered for t in trials]), np.array([t.seen for t in trials])
    each = covered.mean(axis=0)[seen.mean(axis=0) > 0.5]
    inside, error = _mean(np.array([t.held for t in trials]))
    return (
        float(each.mean()),
        percent(each.mean()),
        percent(each.min()),
        percent(each.max()),
        f"{100 * inside:.1f} ± {100 * error:.1f} %",
        percent(float(np.mean([t.left_out for t in trials])), 3),
        percent(float(np.mean([t.widened for t in trials]))),
    )


def _mean(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return values.mean(axis=0), values.std(axis=0, ddof=1) / np.sqrt(len(values))
