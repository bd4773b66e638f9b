"""One run of a study: a campaign drawn, calibrated and compared with its truth."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from boresight.calibration.problem import Problem, rms
from boresight.calibration.robust import Fit
from boresight.calibration.solve import Solution, evolution_task, solve
from boresight.errors import BoresightError
from boresight.geometry import rotation_angle
from boresight.inference import pose_uncertainty
from boresight.kernels.cuda.batches import Task
from boresight.search import Evolved
from boresight.sensing import Cell
from boresight.studies.grid import Point
from boresight.studies.outcome import Outcome
from boresight.synthetic import draw_configurations, named_errors, simulated_readings, spoiled

_NEAR = 1e-6
_STEPS = 20


class Drawn(NamedTuple):
    """One simulated campaign.

    Attributes:
        problem: what is to be calibrated.
        truth: the cell that was measured.
        planted: (rows,) which are grossly wrong.
    """

    problem: Problem
    truth: Cell
    planted: Bool[np.ndarray, " rows"]


def run(point: Point, seed: int, evolved: Evolved | None = None) -> Outcome:
    """Returns the outcome of a point and a seed, a function of these alone (its `seconds` aside).

    Points share what they can of a seed: a parameter's true error, the first configurations of each target, and
    the noise in standard deviations are the same, so that differences between points are not differences of luck.

    Args:
        point: the kind of campaign.
        seed: which of them.
        evolved: its evolution, where that has run already.
    """
    try:
        return _run(point, seed, evolved)
    except (BoresightError, np.linalg.LinAlgError) as error:
        return Outcome.failed(f"{type(error).__name__}: {error}", len(point.freedoms))


def evolution_of(point: Point, seed: int) -> Task | None:
    """Returns the evolution of a point and a seed as a card is given it, None where there is none to run."""
    if not point.evolves:
        return None
    try:
        return evolution_task(draw(point, seed).problem, replace(point.solver, seed=seed))
    except (BoresightError, np.linalg.LinAlgError):
        return None  # which `run` will say


def draw(point: Point, seed: int) -> Drawn:
    """Returns the campaign of a point and a seed."""
    cell, freedoms, settings = point.cell, point.freedoms, point.settings
    truth = cell.corrected(named_errors({f.parameter: f.within or 0.0 for f in freedoms}, seed))
    if settings.rows is None:
        assert point.bench.joints is not None
        assert point.bench.target is not None
        joints, target = point.bench.joints, point.bench.target
    else:
        joints, target = draw_configurations((cell, truth), settings.rows, seed)
    good = simulated_readings(truth, joints, target, seed)
    readings, planted = spoiled(good, settings.gross_errors, seed)
    return Drawn(Problem(cell, readings, freedoms), truth, planted)


def _run(point: Point, seed: int, evolved: Evolved | None) -> Outcome:
    problem, truth, planted = draw(point, seed)
    solution = solve(problem, replace(point.solver, seed=seed), evolved=evolved)
    x_true = np.array([truth.values[name] - point.cell.values[name] for name in problem.names])
    oracle = problem.weighed((~planted).astype(float), 0.0)
    return _judged(solution, truth, oracle, x_true, point.settings.validation_rows, seed)


def _judged(
    solution: Solution, truth: Cell, oracle: Problem, x_true: Float[np.ndarray, " free"], rows: int, seed: int
) -> Outcome:
    """Returns how a solution compares with the truth.

    Args:
        solution: where the search ended.
        truth: the cell that was measured.
        oracle: the problem, its weights 0 where a row is grossly wrong.
        x_true: true corrections.
        rows: configurations to validate with.
        seed: of these.
    """
    fit, nominal = solution.fit, oracle.cell
    found = fit.problem.fitted(fit.x)
    joints, target = draw_configurations((nominal, truth), rows, seed, part=1)
    held_out = simulated_readings(truth, joints, target, seed, part=1)
    real, before, after = (each.poses(joints) for each in (truth, nominal, found))
    shift = after[:, :3, 3] - real[:, :3, 3]
    predicted = pose_uncertainty(found, fit.problem.names, fit.problem.covariance(fit.x), joints)
    planted = oracle.row_weight == 0.0
    return Outcome(
        nominal_position_rms=_length_rms(before[:, :3, 3] - real[:, :3, 3]),
        nominal_orientation_rms=rms(rotation_angle(real[:, :3, :3], before[:, :3, :3])),
        position_rms=_length_rms(shift),
        position_max=float(np.max(np.linalg.norm(shift, axis=1))),
        orientation_rms=rms(rotation_angle(real[:, :3, :3], after[:, :3, :3])),
        position_95=float(np.median(predicted.position_95)),
        inside_95=float(np.mean(predicted.holds(shift))),
        calibration_rms=rms(fit.problem.errors(fit.x)[fit.kept]),
        validation_rms=rms(found.predict(joints, target) - held_out.values),
        cost=_cost(oracle, fit.x),
        optimum=_optimum(oracle, x_true),
        model_std=fit.problem.model_std,
        free=len(fit.x),
        planted=int(np.count_nonzero(planted)),
        found=_count(~fit.kept & planted),
        flagged=_count(~fit.kept & ~planted),
        **_effort(solution, fit),
    )


def _effort(solution: Solution, fit: Fit) -> dict:
    stages = {id(stage): stage for stage in (*solution.stages, *([solution.nominal] if solution.nominal else []))}
    return {
        "evaluations": sum(stage.evaluations for stage in stages.values()),
        "seconds": sum(stage.seconds for stage in stages.values()),
    }


def _optimum(oracle: Problem, start: Float[np.ndarray, " free"]) -> float:
    """Returns the lowest cost near the truth, by Gauss-Newton: from there one or two steps do.

    A general search takes three times as long. A step that does not descend is halved; the last is one that promises
    next to nothing.
    """
    x, residual = start, oracle.residual(start)
    cost = float(residual @ residual)
    for _ in range(_STEPS):
        slopes = oracle.jacobian(x) * oracle.scale
        step = np.linalg.lstsq(slopes, -residual, rcond=None)[0]
        promised = float(np.sum((slopes @ step) ** 2))
        if promised <= _NEAR * cost:
            return cost - promised
        for halved in range(_STEPS):
            tried = x + 0.5**halved * step * oracle.scale
            residual_there = oracle.residual(tried)
            if float(residual_there @ residual_there) <= cost:
                break
        else:
            return cost
        x, residual = tried, residual_there
        cost = float(residual @ residual)
    return cost


def _cost(problem: Problem, x: Float[np.ndarray, " free"]) -> float:
    return float(np.sum(problem.residual(x) ** 2))


def _length_rms(vectors: Float[np.ndarray, "rows 3"]) -> float:
    return float(np.sqrt(np.mean(np.sum(vectors**2, axis=1))))


def _count(rows: Bool[np.ndarray, " rows"]) -> int:
    return int(np.count_nonzero(rows))
