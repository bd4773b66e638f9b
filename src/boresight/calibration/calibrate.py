"""The main job: from a campaign to a result."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from boresight.calibration.beyond import Beyond, beyond_in_words, go_beyond
from boresight.calibration.by_sensor import errors_by_sensor
from boresight.calibration.campaign import Campaign
from boresight.calibration.complete_model import complete_model
from boresight.calibration.encoder_noise import with_joint_noise
from boresight.calibration.estimates import estimates_of
from boresight.calibration.expected_gain import expected_gain
from boresight.calibration.freedom import freedoms_of
from boresight.calibration.gross import MOST_LEFT_OUT, beyond_help, grossly_off, share_left_out
from boresight.calibration.holdout import HeldOut, by_cross_validation, on_validation_rows, row_sizes, summarise
from boresight.calibration.left_out import left_out, left_out_in_words
from boresight.calibration.missing import find_missing
from boresight.calibration.model_error import model_error
from boresight.calibration.moved_base import moved_base_in_words
from boresight.calibration.noise_size import noise_size
from boresight.calibration.outliers import find_outliers
from boresight.calibration.placement import find_frames
from boresight.calibration.priors import assumed, unestimated
from boresight.calibration.problem import Problem
from boresight.calibration.result import Result, Unseen
from boresight.calibration.robust import Fit, check_noise
from boresight.calibration.sensitivities import sensitivities, sensitivities_in_words
from boresight.calibration.solve import Progress, Solution, Solver, Step, continued_by, solve, unheard
from boresight.calibration.thinning import thinned
from boresight.calibration.verdict import LOUD, Evidence, judge
from boresight.errors import InputError
from boresight.inference import (
    identify_directions,
    listed,
    movements_of,
    spread_configurations,
    tool_accuracy,
    unseen_in_words,
)
from boresight.sensing import Cell

WORKSPACE_CONFIGURATIONS = 500
"""Configurations at which the tool's uncertainty over the work space is told."""

MANY_LEFT_OUT = 0.1
"""Share of rows left out beyond which a person should look before using the result."""

FEW = 3
"""With fewer values than this for each free parameter, gross errors can hide: a fit bends to them."""


def calibrate(
    campaign: Campaign,
    solver: Solver | None = None,
    on_progress: Progress | None = None,
    on_step: Step = unheard,
) -> Result:
    """Returns the identified arm, how certain it is, and whether to use it (paper, section 3.3).

    Args:
        campaign: cell, readings and what may be wrong.
        solver: how to search; evolution, then least squares, by default.
        on_progress: called now and then with evolution's generation and best cost [m²].
        on_step: called with what is done next, in words.

    Raises:
        InputError: there are no readings, or nothing to estimate.
    """
    try:
        with np.errstate(all="ignore"):  # what is not finite is told as such, in words
            return _calibrated(campaign, solver or Solver(), on_progress, on_step)
    except np.linalg.LinAlgError:
        raise InputError(
            f"{campaign.name}: the readings are so far from the model that least squares cannot be solved; check the "
            "units of lengths and angles, the joint columns, and which target each row names"
        ) from None


def _calibrated(campaign: Campaign, solver: Solver, on_progress: Progress | None, on_step: Step) -> Result:
    readings = campaign.readings
    if readings is None or not len(readings):
        raise InputError(f"{campaign.name}: a calibration needs readings; give `observations:` in the campaign")
    if not readings.measured:
        raise InputError(f"{campaign.name}: there are configurations but no readings; measure them, then calibrate")
    on_step("frames")
    placed = find_frames(campaign.cell, readings, campaign.sought, solver.seed, campaign.priors)
    nominal = placed.cell if campaign.gravity is None else placed.cell.under(campaign.gravity)
    readings = with_joint_noise(nominal, readings, campaign.joint_noise_std)
    campaign = replace(campaign, readings=readings)
    freedoms = freedoms_of(campaign, nominal)
    if not freedoms:
        raise InputError(f"{campaign.name}: every parameter is fixed, so there is nothing to calibrate")
    geometric = solve(Problem(nominal, readings, freedoms), solver, on_progress, on_step=on_step)
    on_step("non-geometric terms")
    solution, beyond = _beyond(campaign, geometric, solver.seed)
    problem, x = solution.fit.problem, solution.fit.x
    nominal = problem.cell
    identified = problem.fitted(x)
    on_step("identifiability")
    found = identify_directions(problem.names, problem.seen(x), problem.scale)
    moves = movements_of(problem.cell, readings.joints, readings.target, problem.names, problem.corrections(x))
    others = unestimated(campaign, nominal, problem.freedoms)
    known = complete_model(solution.fit, others, noise_size(solution.fit))
    covariance = known.free_covariance
    on_step("held-out rows")
    if campaign.validation is not None:
        held_out = on_validation_rows(solution.fit, campaign.validation)
    else:
        held_out = by_cross_validation(solution.fit, solver.seed)
    on_step("pose uncertainty")
    spread = spread_configurations(identified, WORKSPACE_CONFIGURATIONS)
    tool = replace(known.moments, model_std=model_error(solution.fit, held_out, campaign.validation))
    mirrored = bool(placed.warnings)
    accuracy = tool_accuracy(identified, tool, spread, mirrored=mirrored)
    in_workspace = accuracy.absolute.pose
    errors = {"before": problem.errors(np.zeros(len(x))), "after": problem.errors(x)}
    asked = readings if campaign.validation is None else campaign.validation
    on_step("what explains the residuals")
    missing = find_missing(solution.fit, campaign, nominal, accuracy, solver.seed)
    assumptions = sensitivities(solution.fit, known, spread, (accuracy.absolute.median, accuracy.relative.median))
    unseen = tuple(Unseen(each.parameters, each.words) for each in unseen_in_words(found, problem.scale, moves))
    verdict = judge(
        Evidence(
            held_out=held_out,
            fit=solution.fit,
            accuracy=accuracy,
            gain=expected_gain(identified, known, x, spread),
            explanations=missing.explanations,
            explained=missing.explained,
            alternatives=missing.alternatives,
            assumptions=sensitivities_in_words(assumptions),
            beyond=beyond.chosen if beyond is not None else (),
            seed=solver.seed,
        )
    )
    return Result(
        name=campaign.name,
        cell=identified,
        nominal=nominal,
        verdict=verdict,
        estimates=estimates_of(problem, identified, known, replace(campaign.cell, arm=nominal.arm), campaign.sought),
        free=len(problem.names),
        rank=found.rank,
        unseen=unseen,
        calibration=summarise("calibration rows", *(row_sizes(each)[solution.fit.kept] for each in errors.values())),
        validation=held_out.residuals,
        by_sensor=errors_by_sensor(identified, readings, solution.fit.kept, errors),
        outliers=find_outliers(solution.fit),
        readings=readings,
        errors=errors,
        stated_std=readings.usual_std,
        model_std=problem.model_std,
        noise=check_noise(solution.fit),
        beyond=beyond,
        solution=solution,
        solver=solver,
        covariance=covariance,
        free_names=problem.names,
        at_rows=tool_accuracy(identified, tool, asked.joints[thinned(asked)], mirrored=mirrored).absolute.pose,
        accuracy=accuracy,
        assumed=assumed(campaign, nominal),
        priors=others,
        explanations=missing.explanations,
        alternatives=missing.alternatives,
        sensitivities=assumptions,
        in_workspace=in_workspace,
        set_aside=campaign.set_aside,
        warnings=(
            *campaign.warnings,
            *placed.warnings,
            *_warnings(solution.fit),
            *_gross_in_validation(held_out),
            *(words for words in missing.words if words not in verdict.reasons),
        ),
        jumps=missing.jumps,
        notes=(
            *campaign.notes,
            *_notes(campaign, identified, solver),
            *moved_base_in_words(campaign, identified),
            *beyond_in_words(beyond),
            *left_out_in_words(left_out(campaign, nominal, freedoms)),
        ),
        inputs=campaign.inputs,
        robot_file=campaign.robot_file,
    )


def _beyond(campaign: Campaign, solution: Solution, seed: int) -> tuple[Solution, Beyond | None]:
    """Returns the solution with what held-out rows ask for beyond geometry, and what was tried."""
    if beyond_help(solution.fit):
        return solution, None
    found, beyond = go_beyond(solution.fit, campaign.terms, campaign.chosen_by_default, seed)
    return (solution if found is solution.fit else continued_by(solution, found)), beyond


def _notes(campaign: Campaign, identified: Cell, solver: Solver) -> tuple[str, ...]:
    said = []
    if solver.name != "least-squares" and any(not sensor.readouts for sensor in identified.sensors.values()):
        slow = [sensor.type for sensor in identified.sensors.values() if not sensor.readouts]
        said.append(
            f"Evolution ran a thousand times slower than it can, as {slow[0]} has no compiled form; `--solver "
            "least-squares` finds the same where the nominal model is near."
        )
    if campaign.robot_file is not None and identified.arm.is_bent:
        said.append(
            "robot-calibrated.urdf holds the geometry alone, since a URDF has no words for sag and harmonics; "
            "robot-calibrated.yaml holds all."
        )
    return tuple(said)


def _gross_in_validation(held_out: HeldOut) -> tuple[str, ...]:
    lines = held_out.gross
    if not lines:
        return ()
    do, plural = ("do", "s") if len(lines) > 1 else ("does", "")
    return (
        f"{len(lines)} validation row{plural} {do} not fit with the others (line{plural} "
        f"{listed([str(line) for line in lines])}): they are as wrong as no fit would use, so the result is not "
        "judged by them. Look at them before you use it.",
    )


def _warnings(fit: Fit) -> tuple[str, ...]:
    problem = fit.problem
    values, free = problem.readings.count, len(problem.names)
    said = []
    if values < free:
        said.append(
            f"{values} reading{'s' if values != 1 else ''} for {free} free parameters: priors hold the rest. "
            "Take more readings, or free fewer parameters."
        )
    left_out = int(np.count_nonzero(~fit.kept))
    if MANY_LEFT_OUT < share_left_out(fit) <= MOST_LEFT_OUT:
        said.append(
            f"{left_out} of {len(fit.kept)} rows do not fit with the others and were left out. With so many, the rest "
            "may be wrong together: check target names, planes, units and the ranger before you use this result."
        )
    if (
        not grossly_off(fit)
        and values < FEW * free
        and problem.model_std > 0.0
        and (ratio := check_noise(fit).ratio) > LOUD
    ):
        said.append(
            f"Residuals are {ratio:.0f}x the stated noise, and {values} readings for {free} free parameters cannot "
            "tell whether the arm moves so or rows are grossly wrong. Take more readings before you use this result."
        )
    missed = int(np.count_nonzero(~np.isfinite(problem.errors(np.zeros(free)))))
    if missed:
        said.append(
            f"{missed} of {values} beams look away from their planes in the nominal model, though a range was read: "
            "check the planes' normals and offsets, and which target each row names."
        )
    return tuple(said)
