"""Every parameter as believed and as found, with its standard deviation and where its value comes from."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from boresight.arm import is_further
from boresight.calibration.complete_model import CompleteModel
from boresight.calibration.problem import Problem
from boresight.calibration.result import Estimate
from boresight.geometry import Frame
from boresight.inference import sources
from boresight.sensing import Cell
from boresight.sensing.cell import FRAME_NUMBERS
from boresight.units import UNIT_OF

_TURNS = FRAME_NUMBERS[3:]


MOSTLY = 0.5
"""A value is determined by priors of what was not estimated where these make this share of its variance."""


def estimates_of(
    problem: Problem, identified: Cell, known: CompleteModel, believed: Cell, unknown: frozenset[str]
) -> tuple[Estimate, ...]:
    """Returns an estimate of every parameter that is free or belongs to the arm or a target.

    What could turn a joint further, but was neither added nor there before, is left out.

    Turns of a frame are listed as its roll, pitch and yaw, their deviations carried over from the turns about
    its own axes that were fitted.

    Args:
        problem: what was fitted.
        identified: the cell found.
        known: what is known of the estimated parameters and the others.
        believed: the cell as the files gave it.
        unknown: parameters the files called unknown.
    """
    std, alone = (
        dict(zip(problem.names, np.sqrt(np.diag(each)), strict=True))
        for each in (known.free_covariance, known.conditional_covariance)
    )
    source = dict(zip(problem.names, sources(np.array(list(alone.values())), problem.believed_std), strict=True))
    shared = {name for name in problem.names if alone[name] ** 2 < MOSTLY * std[name] ** 2}
    source |= dict.fromkeys(shared, "prior")
    source |= {name: "gauge" for name, held in zip(known.names, known.in_gauge, strict=True) if held}
    wide = dict(zip(known.names, known.half_width_95.tolist(), strict=True))
    frames = {"base": identified.base, **identified.mounts}
    for name, frame in frames.items():
        std |= _rpy_std(name, frame, problem.names, known.free_covariance)
        alone |= _rpy_std(name, frame, problem.names, known.conditional_covariance)
    listed = []
    for parameter in problem.cell.parameters:
        owner = parameter.name.split(".")[0]
        if owner in (*frames, *identified.sensors) and parameter.name not in std:
            continue
        if is_further(parameter.name) and parameter.name not in std and not identified.values[parameter.name]:
            continue
        found, given = identified.values[parameter.name], believed.values[parameter.name]
        estimate = Estimate(
            name=parameter.name,
            unit=UNIT_OF[parameter.quantity],
            nominal=given,
            identified=found,
            correction=found - given,
            std=float(std.get(parameter.name, known.prior_of.get(parameter.name, 0.0))),
            half_width_95=wide.get(parameter.name, 0.0),
            conditional_std=float(alone.get(parameter.name, 0.0)),
            source=source.get(parameter.name, "prior" if parameter.name in known.prior_of else "fixed"),
        )
        listed.append(replace(estimate, nominal=None, correction=None) if parameter.name in unknown else estimate)
    return tuple(listed)


def _rpy_std(
    name: str, frame: Frame, free: tuple[str, ...], covariance: Float[np.ndarray, "free free"]
) -> dict[str, float]:
    """Returns the deviations of a frame's roll, pitch and yaw, if any of its turns was free."""
    columns = [free.index(f"{name}.{turn}") for turn in _TURNS if f"{name}.{turn}" in free]
    if not columns:
        return {}
    turned = [place for place, turn in enumerate(_TURNS) if f"{name}.{turn}" in free]
    step = 1e-6
    slopes = np.empty((3, len(turned)))
    for column, place in enumerate(turned):
        roll, pitch, yaw = (step if k == place else 0.0 for k in range(3))
        forward = frame.moved((0.0, 0.0, 0.0), (roll, pitch, yaw))
        backward = frame.moved((0.0, 0.0, 0.0), (-roll, -pitch, -yaw))
        change = np.subtract(forward.rpy, backward.rpy)
        slopes[:, column] = (np.mod(change + np.pi, 2 * np.pi) - np.pi) / (2 * step)
    carried = slopes @ covariance[np.ix_(columns, columns)] @ slopes.T
    return {f"{name}.{_TURNS[k]}": float(np.sqrt(carried[k, k])) for k in turned}
