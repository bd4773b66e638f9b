"""What could these data know? Everything about identifiability and accuracy that needs no measured value."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from boresight.calibration.campaign import Campaign
from boresight.calibration.freedom import freedoms_of
from boresight.calibration.left_out import LeftOut, left_out
from boresight.calibration.placement import find_frames
from boresight.calibration.problem import Problem
from boresight.errors import InputError
from boresight.geometry import Frame, rpy_matrix
from boresight.inference import (
    HardlySeen,
    Observability,
    UnseenDirection,
    everett_count,
    hardly_seen,
    identify_directions,
    movements_of,
    observability,
    posterior_covariance,
    sources,
    unseen_in_words,
)
from boresight.inference.posterior import FLAT_PRIOR
from boresight.sensing import Cell, Readings
from boresight.sensing.cell import FRAME_NUMBERS
from boresight.sensing.linear import model_of, seen_by
from boresight.synthetic import draw_configurations, exact_readings, with_reachable_points
from boresight.units import UNIT_OF

USUAL_ROWS = 100
"""Configurations drawn where a campaign has none."""

_FRAME_SCALE = {"length": 0.02, "angle": 0.05, "number": 0.02}
"""A typical size [m, rad, 1] of every number of a cell, to count what its configurations could see in all."""


@dataclass(frozen=True, slots=True)
class Prediction:
    """How well a parameter will be known.

    Attributes:
        parameter: its name.
        unit: m, rad or 1.
        prior_std: what is believed before; None where nothing is.
        std: what remains after readings with the stated noise; infinite where nothing is known even then.
        source: whether its value will come from the `data` or from the `prior`.
    """

    parameter: str
    unit: str
    prior_std: float | None
    std: float
    source: str


@dataclass(frozen=True)
class Inspection:
    """What a campaign's configurations can and cannot know.

    Attributes:
        name: of the campaign.
        seed: of drawn configurations and of the search for unknown frames.
        rows: number of configurations.
        drawn: whether they were drawn at random within the joints' limits.
        missed: beams that look away from their planes, of all values.
        values: number of values, `rows` times the sensor's channels.
        noise_std: median standard deviation [m] of a value.
        targets: names of the targets measured against.
        free: the free parameters.
        rank: how many directions of them the readings see.
        condition: largest over smallest singular value seen, of the scaled Jacobian.
        singular_values: of the scaled Jacobian, largest first.
        observability: O1 to O5.
        everett: C = 4 R + 2 P + 6, the independent parameters of such an arm.
        arm_rank: how many of those these configurations could see, were all free and the targets known.
        unseen: what changes no reading, why, and the mend.
        hardly: what is seen too faintly to say more than the prior.
        left_out: what the default choice of free parameters leaves out, and why.
        predictions: the accuracy that the stated noise allows, a parameter each.
        warnings: what a person should look at.
        notes: choices a person should know.
    """

    name: str
    seed: int
    rows: int
    drawn: bool
    missed: int
    values: int
    noise_std: float
    targets: tuple[str, ...]
    free: tuple[str, ...]
    rank: int
    condition: float
    singular_values: tuple[float, ...]
    observability: Observability
    everett: int
    arm_rank: int
    unseen: tuple[UnseenDirection, ...]
    hardly: tuple[HardlySeen, ...]
    left_out: tuple[LeftOut, ...]
    predictions: tuple[Prediction, ...]
    warnings: tuple[str, ...]
    notes: tuple[str, ...]


def inspect(campaign: Campaign, *, rows: int | None = None, seed: int = 0) -> Inspection:
    """Returns what a campaign's configurations could identify, were they measured with the stated noise.

    The campaign's own configurations are used where it has them and `rows` does not ask for others. Frames that
    are unknown are found from readings where there are any, and stand at the identity otherwise.

    Args:
        campaign: cell, configurations if any, and what may be wrong.
        rows: number of configurations to draw; 100 where the campaign has none.
        seed: of the draws.

    Raises:
        InputError: every parameter is fixed, or hardly any configuration sees a target.
    """
    measured = campaign.readings is not None and campaign.readings.measured
    cell, guessed = campaign.cell, bool(campaign.unknown - set(campaign.cell.offsets)) and not measured
    if campaign.readings is not None and measured:
        placed = find_frames(cell, campaign.readings, campaign.sought, seed, campaign.priors)
        cell, campaign = placed.cell, replace(campaign, warnings=(*campaign.warnings, *placed.warnings))
    drawn = rows is not None or campaign.readings is None
    readings = campaign.readings
    if readings is None or rows is not None:
        cell = with_reachable_points(cell, frozenset() if measured else campaign.unknown, seed)
        readings = _drawn(cell, rows or USUAL_ROWS, seed)
    campaign = replace(campaign, readings=readings)
    freedoms = freedoms_of(campaign, cell)
    if not freedoms:
        raise InputError(f"{campaign.name}: every parameter is fixed, so there is nothing to inspect")
    problem = Problem(cell, readings, freedoms)
    nominal = np.zeros(len(freedoms))
    sensitivity = problem.seen(nominal)
    found = identify_directions(problem.names, sensitivity, problem.scale)
    moves = movements_of(cell, readings.joints, readings.target, problem.names)
    kinds = [joint.type for joint in cell.arm.joints]
    missed = int(np.count_nonzero(np.isnan(_predicted(cell, readings))))
    return Inspection(
        name=campaign.name,
        seed=seed,
        rows=len(readings),
        drawn=drawn,
        missed=missed,
        values=readings.count,
        noise_std=readings.usual_std,
        targets=tuple(moves.aimed_at),
        free=problem.names,
        rank=found.rank,
        condition=found.condition,
        singular_values=tuple(float(value) for value in found.singular_values),
        observability=observability(found.singular_values[: found.rank], len(readings)),
        everett=everett_count(kinds.count("revolute"), kinds.count("prismatic")),
        arm_rank=_arm_rank(cell, readings),
        unseen=tuple(unseen_in_words(found, problem.scale, moves)),
        hardly=hardly_seen(found, sensitivity, problem.scale, moves.quantities),
        left_out=left_out(campaign, cell, freedoms),
        predictions=_predictions(problem, sensitivity),
        warnings=campaign.warnings + _warnings(problem, missed, guessed),
        notes=campaign.notes,
    )


def _drawn(cell: Cell, rows: int, seed: int) -> Readings:
    """Returns configurations that see their targets, with what would be read."""
    return exact_readings(cell, *draw_configurations((cell,), rows, seed))


def _predicted(cell: Cell, readings: Readings) -> np.ndarray:
    """Returns (rows, channels) what the nominal cell would read [m]; NaN where a beam misses."""
    return model_of(cell, replace(readings, values=np.zeros_like(readings.values)), ()).errors(np.empty(0))


def _arm_rank(cell: Cell, readings: Readings) -> int:
    """Returns how many combinations of all the arm's, base's and tool's numbers change the readings.

    Several markers count as one tool of known shape.
    """
    slopes = seen_by(cell, readings, cell.moving)
    own = {name: [cell.index[f"{name}.{number}"] for number in FRAME_NUMBERS] for name in cell.mounts}
    on_flange = sum(slopes[:, own[name]] @ _with_flange(frame) for name, frame in cell.mounts.items())
    shared = [name for name in cell.moving if name.partition(".")[0] not in cell.mounts]
    flat = np.hstack([slopes[:, [cell.index[name] for name in shared]], on_flange])
    quantities = [cell.parameters[cell.index[name]].quantity for name in shared] + ["length"] * 3 + ["angle"] * 3
    names = (*shared, *(f"flange.{number}" for number in FRAME_NUMBERS))
    return identify_directions(names, flat, np.array([_FRAME_SCALE[quantity] for quantity in quantities])).rank


def _with_flange(frame: Frame) -> np.ndarray:
    """Returns how the six numbers of a mount change when it shifts and turns with the flange."""
    x, y, z = frame.xyz
    carried = np.eye(6)
    carried[:3, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
    carried[3:, 3:] = rpy_matrix(frame.rpy).T
    return carried


def _predictions(problem: Problem, sensitivity: np.ndarray) -> tuple[Prediction, ...]:
    std = np.sqrt(np.diag(posterior_covariance(sensitivity, problem.prior_std)))
    source = sources(std, problem.prior_std)
    return tuple(
        Prediction(
            name,
            UNIT_OF[problem.cell.parameters[column].quantity],
            float(prior) if np.isfinite(prior) else None,
            float(remaining) if remaining < 0.5 * FLAT_PRIOR else np.inf,
            where,
        )
        for name, column, prior, remaining, where in zip(
            problem.names, problem.columns, problem.prior_std, std, source, strict=True
        )
    )


def _warnings(problem: Problem, missed: int, guessed: bool) -> tuple[str, ...]:
    said = []
    values, free = problem.readings.count, len(problem.names)
    if values - missed < free:
        said.append(
            f"{values - missed} readings cannot tell {free} parameters: some directions below are unseen only because "
            "there are too few. Take more readings, or free fewer parameters."
        )
    if missed:
        said.append(
            f"{missed} of {values} beams look away from their planes in the nominal model and count for nothing: "
            "check the planes' normals and offsets, and which target each row names."
        )
    if guessed:
        said.append(
            "Frames that the campaign calls unknown stand at the identity here: with a guess for "
            "`base` and `mount`, the numbers are nearer to what you will get."
        )
    return tuple(said)
