"""What a campaign's model may lack: each effect that is not estimated, as derivatives of the readings.

Numbers of the cell itself (the sensor's bias and scale, a plane's normal and offset, base and mount, link parameters
that were not estimated), what joints do beside turning by their reading (gain, harmonics), and slow changes in time.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.arm import HARMONICS, is_further
from boresight.calibration.freedom import link_candidates
from boresight.calibration.jumps import Jump
from boresight.calibration.linear import equipped
from boresight.calibration.problem import Problem
from boresight.calibration.scale_held import scale_held
from boresight.geometry import Point
from boresight.sensing import Cell, Readings
from boresight.sensing.cell import FRAME_NUMBERS
from boresight.sensing.linear import model_of, slopes_of
from boresight.units import Quantity


@dataclass(frozen=True, eq=False)
class Effect:
    """One effect that is not in the model.

    Attributes:
        name: what it is called: `sensor.bias`, `deck.offset`, `base`, `j3.gain`, `drift of j3.a`.
        parameters: the cell's parameters that would model it; empty where none does.
        quantity: what a unit of its first column measures.
        columns: (rows, channels, numbers) derivative of the predicted values [m].
    """

    name: str
    parameters: tuple[str, ...]
    quantity: Quantity
    columns: Float[np.ndarray, "rows channels numbers"]


def effects_of(problem: Problem, x: Float[np.ndarray, "free"], *, gravity: bool) -> list[Effect]:
    """Returns every effect that is not estimated, constants first, linearised at a fit.

    Args:
        problem: what was fitted; all of its rows are taken.
        x: where.
        gravity: whether links may give way under their weight.
    """
    cell, readings = problem.cell, problem.readings
    slopes = all_slopes(cell, readings, problem.corrections(x))
    free = set(problem.names)
    names = tuple(name for name in cell.index if name in free.union(link_candidates(cell.arm)))
    free |= {scale_held(cell, readings, names) or ""}  # a smaller arm leaves less of contacts, and explains nothing
    found = [*_constants(cell, readings, slopes, free), *_of_joints(cell, readings, slopes, free)]
    if gravity:
        found += _sag(cell, readings, problem.corrections(x))
    return [*found, *_drifts(readings, found)]


def joint_slopes(
    cell: Cell, readings: Readings, slopes: Float[np.ndarray, "rows channels parameters"]
) -> Float[np.ndarray, "rows channels joints"]:
    """Returns the derivative of the readings by each joint reading [m per rad or m]."""
    names = list(cell.arm.joint_names)
    by_joint = np.zeros((*slopes.shape[:2], len(names)))
    for joint in cell.arm.joints:
        number = "theta" if joint.type == "revolute" else "d"
        ratio = joint.ratio if joint.follows else 1.0
        by_joint[:, :, names.index(joint.follows or joint.name)] += (
            ratio * slopes[:, :, cell.index[f"{joint.name}.{number}"]]
        )
    return by_joint


def all_slopes(
    cell: Cell, readings: Readings, corrections: Float[np.ndarray, "parameters"]
) -> Float[np.ndarray, "rows channels parameters"]:
    """Returns the derivatives of the predicted values by every parameter of a cell; zeros where a beam misses."""
    names = [parameter.name for parameter in cell.parameters]
    scales = {f"{name}.scale" for name in cell.sensors}
    if any(corrections[cell.index[name]] for name in scales & set(names)):
        return np.nan_to_num(cell.slopes(readings, corrections))
    plain = [name for name in names if name not in scales or cell.targets]
    slopes = np.zeros((*readings.values.shape, len(names)))
    at = [cell.index[name] for name in plain]
    model = model_of(cell, readings, plain)
    slopes[:, :, at] = slopes_of(model, corrections[at], readings)
    predicted = readings.values if len(plain) == len(names) else readings.values + model.errors(corrections[at])
    for place, name in enumerate(names):
        if name not in plain:  # a tracker's, whose readings are positions and then turns
            sensor = name.partition(".")[0]
            rows = np.array([aim.sensor == sensor for aim in cell.aims])[readings.target]
            slopes[rows, :3, place] = predicted[rows, :3]
    return slopes


def _constants(cell: Cell, readings: Readings, slopes: np.ndarray, free: set[str]) -> Iterator[Effect]:
    """Yields what is wrong in every row alike: the sensor's numbers, targets, frames, and links."""
    for name, parameters in _groups(cell):
        held = [p for p in parameters if p not in free]
        columns = slopes[:, :, [cell.index[p] for p in held]]
        if held and columns.any():
            yield Effect(name, tuple(held), cell.parameters[cell.index[held[0]]].quantity, columns)


def _groups(cell: Cell) -> Iterator[tuple[str, list[str]]]:
    """Yields names of effects and the parameters that would model each."""
    for name, sensor in cell.sensors.items():
        for number in sensor.numbers:
            yield f"{name}.{number}", [f"{name}.{number}"]
    for name, target in cell.targets.items():
        if isinstance(target, Point):
            yield f"{name}.position", [f"{name}.{number}" for number, _ in target.numbers]
            continue
        yield f"{name}.offset", [f"{name}.offset"]
        yield f"{name}.normal", [f"{name}.{number}" for number, _ in target.numbers if number != "offset"]
    for name in ("base", *cell.mounts):
        for part, numbers in ((".xyz", FRAME_NUMBERS[:3]), (".rpy", FRAME_NUMBERS[3:]), ("", FRAME_NUMBERS)):
            yield f"{name}{part}", [f"{name}.{number}" for number in numbers]
    for name in link_candidates(cell.arm):
        yield name, [name]


def _of_joints(cell: Cell, readings: Readings, slopes: np.ndarray, free: set[str]) -> Iterator[Effect]:
    """Yields what joints do beside following their readings: a wrong gain, and waves once and twice a turn."""
    by_joint = joint_slopes(cell, readings, slopes)
    driven = {joint.name: joint for joint in cell.arm.joints}
    for place, name in enumerate(cell.arm.joint_names):
        q, own = readings.joints[:, place, None], by_joint[:, :, place]
        if not own.any():
            continue
        yield Effect(f"{name}.gain", (), "number", (own * q)[:, :, None])
        if driven[name].type == "revolute" and not any(f"{name}.{wave}" in free for wave in HARMONICS):
            waves = np.stack([own * np.cos(q), own * np.sin(q), own * np.cos(2 * q), own * np.sin(2 * q)], axis=2)
            yield Effect(f"{name}.harmonics", tuple(f"{name}.{wave}" for wave in HARMONICS), "angle", waves)


def _sag(cell: Cell, readings: Readings, corrections: np.ndarray) -> Iterator[Effect]:
    """Yields the give of all joints under gravity, as one effect."""
    if any(joint.follows for joint in cell.arm.joints) or any(joint.sag for joint in cell.arm.joints):
        return
    bent = equipped(cell, ("gravity",))
    names = tuple(name for name in bent.index if name not in cell.index)
    if names:
        at = np.zeros(len(bent.parameters))
        at[[bent.index[p.name] for p in cell.parameters]] = corrections
        columns = np.nan_to_num(bent.slopes(readings, at))[:, :, [bent.index[name] for name in names]]
        yield Effect("gravity", names, "angle", columns)


def _drifts(readings: Readings, constants: list[Effect]) -> Iterator[Effect]:
    """Yields each single number of the cell that changes steadily from the first row to the last."""
    order = np.empty(len(readings))
    order[np.argsort(readings.line, kind="stable")] = np.linspace(-0.5, 0.5, len(readings))
    for effect in constants:
        if effect.columns.shape[2] == 1 and len(effect.parameters) == 1:
            yield Effect(f"drift of {effect.name}", (), effect.quantity, effect.columns * order[:, None, None])


def drifting_links(problem: Problem, x: Float[np.ndarray, "free"]) -> list[Effect]:
    """Returns each estimated parameter that changes steadily from the first row to the last."""
    cell, readings = problem.cell, problem.readings
    slopes = slopes_of(problem.model, x, readings)
    order = np.empty(len(readings))
    order[np.argsort(readings.line, kind="stable")] = np.linspace(-0.5, 0.5, len(readings))
    return [
        Effect(f"drift of {name}", (), cell.parameters[column].quantity, slopes[:, :, [k]] * order[:, None, None])
        for k, (name, column) in enumerate(zip(problem.names, problem.columns, strict=True))
        if not is_further(name)
    ]


def step(readings: Readings, cell: Cell, jump: Jump) -> Effect:
    """Returns a step of a sensor's channel that was found, as an effect like others."""
    sensor = np.array([aim.sensor == jump.sensor for aim in cell.aims])[readings.target]
    if jump.session is not None and readings.session is not None:
        block = sensor & (readings.session == jump.session)
    else:
        block = sensor & (readings.line >= jump.line)
    columns = np.zeros((*readings.values.shape, 1))
    columns[block, cell.sensors[jump.sensor].channels.index(jump.channel), 0] = 1.0
    return Effect(f"step of {jump.sensor}", (), "length", columns)
