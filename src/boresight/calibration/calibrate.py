"""The main job: from a campaign to a result."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from boresight.calibration.campaign import Campaign
from boresight.calibration.estimates import estimates_of
from boresight.calibration.frames import find_frames
from boresight.calibration.freedom import freedoms_of
from boresight.calibration.holdout import by_cross_validation, error_sizes, on_validation_rows, summarise
from boresight.calibration.outliers import find_outliers
from boresight.calibration.problem import Problem
from boresight.calibration.result import Result, Unseen
from boresight.calibration.solve import Progress, Solver, refine, solve
from boresight.calibration.verdict import judge
from boresight.errors import InputError
from boresight.inference import identify_directions, model_std, posterior_covariance, unseen_in_words

_ROUGH = 10
"""Evaluations of the fit that tells what standard deviations to search with."""

_REWEIGHTINGS = 5
"""How often the model's own standard deviation and the fit may be found in turn; they settle in two or three."""


def calibrate(campaign: Campaign, solver: Solver | None = None, on_progress: Progress | None = None) -> Result:
    """Returns the identified arm, how certain it is, and whether to use it (paper, section 3.3).

    Args:
        campaign: cell, readings and what may be wrong.
        solver: how to search; evolution, then least squares, by default.
        on_progress: called now and then with evolution's generation and best cost [m²].

    Raises:
        InputError: there are no readings, or nothing to estimate.
    """
    solver = solver or Solver()
    readings = campaign.readings
    if readings is None or not len(readings):
        raise InputError(f"{campaign.name}: a calibration needs readings; give `observations:` in the campaign")
    nominal = find_frames(campaign.cell, readings, campaign.unknown, solver.seed)
    freedoms = freedoms_of(campaign, nominal)
    if not freedoms:
        raise InputError(f"{campaign.name}: every parameter is fixed, so there is nothing to calibrate")
    problem = _with_rough_excess(Problem(nominal, readings, freedoms))
    solution = solve(problem, solver, on_progress)
    problem, x, excess = _explain_residuals(problem, solution.x, polish=solver.name != "evolution")
    identified = problem.fitted(x)
    sensitivity = problem.sensitivity(x)
    found = identify_directions(problem.names, sensitivity, problem.scale)
    covariance = posterior_covariance(sensitivity, problem.prior_std)
    if campaign.validation is not None:
        held_out = on_validation_rows(nominal, identified, campaign.validation)
    else:
        held_out = by_cross_validation(problem, x, solver.seed)
    return Result(
        name=campaign.name,
        cell=identified,
        nominal=nominal,
        verdict=judge(held_out, problem, x, excess, solver.seed),
        estimates=estimates_of(problem, identified, covariance, campaign.cell, campaign.unknown),
        free=len(freedoms),
        rank=found.rank,
        unseen=tuple(Unseen(names, words) for names, words in unseen_in_words(found, problem.scale)),
        calibration=summarise("calibration rows", error_sizes(nominal, readings), error_sizes(identified, readings)),
        validation=held_out.residuals,
        outliers=find_outliers(problem, x),
        readings=readings,
        errors={"before": problem.errors(np.zeros(len(x))), "after": problem.errors(x)},
        stated_std=float(np.median(readings.std)),
        model_std=excess,
        solution=replace(solution, x=x),
        solver=solver,
        covariance=covariance,
        free_names=problem.names,
        set_aside=campaign.set_aside,
        warnings=campaign.warnings + _warnings(problem, campaign),
        notes=campaign.notes,
        inputs=campaign.inputs,
    )


def _with_rough_excess(problem: Problem) -> Problem:
    """Returns the problem with standard deviations that a quick fit could explain.

    Readings that are stated far better than the arm can be modelled would otherwise drag parameters that they
    hardly see to the ends of their bounds, and the search with them: 270 evaluations instead of 10.
    """
    rough = problem.errors(refine(problem, np.zeros(len(problem.names)), evaluations=_ROUGH).best)
    seen = np.isfinite(rough)
    return problem.with_model_std(model_std(rough[seen], problem.std[seen], len(problem.names)))


def _explain_residuals(
    problem: Problem, x: Float[np.ndarray, "parameters"], polish: bool
) -> tuple[Problem, Float[np.ndarray, "parameters"], float]:
    """Returns the problem whose standard deviations explain its residuals, its optimum, and the model's own std."""
    excess = problem.model_std
    for _ in range(_REWEIGHTINGS):
        errors = problem.errors(x)
        seen = np.isfinite(errors)
        last, excess = excess, model_std(errors[seen], problem.readings.std[seen], len(x))
        if abs(excess - last) <= 0.01 * excess:
            break
        problem = problem.with_model_std(excess)
        if polish:
            x = refine(problem, x).best
    return problem, x, excess


def _warnings(problem: Problem, campaign: Campaign) -> tuple[str, ...]:
    values, free = problem.readings.values.size, len(problem.names)
    said = []
    if values < free:
        said.append(
            f"{values} readings for {free} free parameters: the rest is held by the priors. "
            "Take more readings, or free fewer parameters."
        )
    missed = int(np.count_nonzero(~np.isfinite(problem.errors(np.zeros(free)))))
    if missed:
        said.append(
            f"{missed} of {values} beams look away from their planes in the nominal model, though a range was read: "
            "check the planes' normals and offsets, and which target each row names."
        )
    return tuple(said)
