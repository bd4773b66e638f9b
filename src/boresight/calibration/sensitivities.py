"""What a result assumes in silence: how far the tool would move if a stated number were off, where no reading can tell.

Where an effect is not identifiable beside the geometry (the only plane's offset, a bias that the last link absorbs), a
score test says nothing: residuals stay as small as ever. The GUM's way is a standard deviation stated for it (Type B);
until one is, this says how much hangs on it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.calibration.complete_model import CompleteModel
from boresight.calibration.effects import all_slopes, joint_slopes
from boresight.calibration.problem import Problem
from boresight.calibration.robust import Fit
from boresight.calibration.thinning import thinned
from boresight.geometry import Point
from boresight.inference import listed, posterior_root
from boresight.inference.accuracy import without_rigid_motion
from boresight.inference.pose import tool_slopes
from boresight.sensing import Cell, Distances
from boresight.sensing.linear import model_of, slopes_of
from boresight.units import UNIT_OF, Quantity, in_millimetres

AMOUNT: dict[Quantity, float] = {"length": 1e-3, "angle": 1e-3, "number": 1e-3}
"""The amount [m, rad, 1] of which the effect is told."""

LARGEST = 10.0
"""So many times the amount may go unnoticed, if the readings do not show it."""

HIDDEN = 3.0
"""Standard deviations up to which an error hides in the readings; a score test would name a larger one."""

TOLD = 3
"""Owners of assumptions that are told: a sensor, a plane, the mount."""
ROWS = 1000

SLIDES = "slides"
"""The owner of all slides' units of length, which are told together."""


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """What one assumption is worth.

    Attributes:
        effect: what is assumed: `deck.offset`, `sensor.bias`, `mount.xyz`.
        amount: of error in it [m, rad or 1].
        unit: m, rad or 1.
        shift_m: how far that would move the tool over the work space [m], root mean square.
        key: what to state in the campaign.
    """

    effect: str
    amount: float
    unit: str
    shift_m: float
    key: str


def sensitivities(
    fit: Fit, known: CompleteModel, joints: Float[np.ndarray, "configurations joints"], radius_m: tuple[float, float]
) -> tuple[Sensitivity, ...]:
    """Returns the assumptions that matter and that the readings cannot check, the weightiest first.

    Args:
        fit: the final fit.
        known: its complete model: what has a prior already is no silent assumption.
        joints: configurations [rad or m] at which the tool is asked for.
        radius_m: 95 % radius [m] of the tool's position there, as claimed: absolute, and after the best rigid motion.
    """
    problem, cell = fit.problem, fit.problem.cell
    groups = [group for group in _assumptions(cell) if not set(group[1]) & set(known.names)]
    others = [name for _, names, _ in groups for name in names]
    few = problem.on(thinned(problem.readings, ROWS))
    names, free = (*problem.names, *others), len(fit.x)
    share = len(problem.readings) / len(few.readings)
    weight = np.sqrt(share * few.row_weight)[:, None] / few.std
    model = model_of(cell, few.readings, names)
    slopes = slopes_of(model, np.append(fit.x, np.zeros(len(others))), few.readings) * weight[:, :, None]
    flat = np.nan_to_num(slopes).reshape(-1, len(names))
    further = list(_unmodelled(few, fit.x))
    K = np.column_stack([flat[:, free:], *(np.nan_to_num(each.columns * weight).ravel() for each in further)])
    if not K.shape[1]:
        return ()
    J = flat[:, :free]
    root = posterior_root(np.linalg.qr(np.vstack([J, np.zeros((free, free))]))[1], problem.prior_std)
    D = root @ (root.T @ (J.T @ K))
    information = np.maximum(np.einsum("vo,vo->o", K, K) - np.einsum("po,po->o", J.T @ K, D), 1e-300)
    direct = np.zeros((len(names), K.shape[1]))
    direct[free:, : len(others)] = np.eye(len(others))
    moved = _tool_shifts(
        problem.fitted(fit.x), names, np.vstack([D, np.zeros((len(others), K.shape[1]))]) - direct, joints, further
    )
    quantity = {parameter.name: parameter.quantity for parameter in cell.parameters}
    told = []
    columns = [(effect, [others.index(name) for name in own], key, quantity[own[0]]) for effect, own, key in groups]
    columns += [(each.effect, [len(others) + k], "", "number") for k, each in enumerate(further)]
    for effect, places, key, kind in columns:
        amount = AMOUNT[kind]
        # What the readings would have shown is no assumption: an error beyond that would be named by a score test.
        size = np.minimum(LARGEST * amount, HIDDEN / np.sqrt(information[places]))
        worst = [float(np.max(each[places] * size)) for each in moved]
        beyond = [each[places] for each, shift, radius in zip(moved, worst, radius_m, strict=True) if shift > radius]
        if beyond:
            told.append(Sensitivity(effect, amount, UNIT_OF[kind], float(np.max(beyond[0])) * amount, key))
    return tuple(sorted(told, key=lambda each: -each.shift_m))


@dataclass(frozen=True, eq=False)
class _Unmodelled:
    """What no parameter is for: the unit of length of a slide, or of a device that reads distances between positions.

    Attributes:
        effect: its name.
        columns: (rows, channels) derivative of the predicted values by the relative error [m].
        joint: the place of the slide among the joints; None where the effect moves no tool by itself.
    """

    effect: str
    columns: Float[np.ndarray, "rows channels"]
    joint: int | None


def _unmodelled(problem: Problem, x: Float[np.ndarray, "free"]) -> Iterator[_Unmodelled]:
    cell, readings = problem.cell, problem.readings
    slides = [k for k, joint in enumerate(cell.arm.driven) if joint.type == "prismatic"]
    if slides:
        by_joint = joint_slopes(cell, readings, all_slopes(cell, readings, problem.corrections(x)))
        for k in slides:
            name = cell.arm.joint_names[k]
            yield _Unmodelled(f"{name}.gain", by_joint[:, :, k] * readings.joints[:, k, None], k)
    for name, sensor in cell.sensors.items():
        if isinstance(sensor, Distances):
            own = np.array([aim.sensor == name for aim in cell.aims])[readings.target]
            yield _Unmodelled(f"{name}.scale", np.where(own[:, None], readings.values, 0.0), None)


def _assumptions(cell: Cell) -> Iterator[tuple[str, list[str], str]]:
    """Yields what a campaign states as certain: its name, its parameters, and the key that says how certain."""
    for name, sensor in cell.sensors.items():
        for number in sensor.numbers:
            yield f"{name}.{number}", [f"{name}.{number}"], f"{number}_std"
    for name, target in cell.targets.items():
        if isinstance(target, Point):
            yield f"{name}.position", [f"{name}.{number}" for number, _ in target.numbers], "position_std"
            continue
        yield f"{name}.offset", [f"{name}.offset"], "offset_std"
        yield f"{name}.normal", [f"{name}.{n}" for n, _ in target.numbers if n != "offset"], "normal_std"
    for name in (*(() if cell.targets else ("base",)), *cell.mounts):
        yield f"{name}.xyz", [f"{name}.{axis}" for axis in "xyz"], "xyz_std"
        yield f"{name}.rpy", [f"{name}.{turn}" for turn in ("roll", "pitch", "yaw")], "rpy_std"


def _tool_shifts(
    cell: Cell,
    names: tuple[str, ...],
    effects: Float[np.ndarray, "parameters effects"],
    joints: Float[np.ndarray, "configurations joints"],
    further: list[_Unmodelled],
) -> tuple[Float[np.ndarray, "effects"], Float[np.ndarray, "effects"]]:
    """Returns how far a unit of each effect moves the estimated tool from the true one [m], root mean square.

    Absolute, and after the best rigid motion. The last effects are `further`; of these a slide moves the true tool too.
    """
    slopes, columns = tool_slopes(cell, names, joints)
    apart = np.einsum("rpi,po->roi", slopes, effects[columns])
    for place, each in enumerate(further, apart.shape[1] - len(further)):
        if each.joint is not None:
            joint = cell.arm.driven[each.joint]
            along, _ = tool_slopes(cell, (f"{joint.name}.d",), joints)
            apart[:, place] -= along[:, 0] * joints[:, each.joint, None]
    relative = without_rigid_motion(apart, cell.poses(joints)[:, :3, 3])
    absolute, rest = (np.sqrt(np.mean(np.sum(each[:, :, :3] ** 2, axis=2), axis=0)) for each in (apart, relative))
    return absolute, rest


def sensitivities_in_words(found: tuple[Sensitivity, ...]) -> tuple[str, ...]:
    """Returns a sentence for each of the weightiest owners of assumptions."""
    owners = list(dict.fromkeys(_owner(each) for each in found))
    return tuple(_in_words(owner, [each for each in found if _owner(each) == owner]) for owner in owners[:TOLD])


def _owner(found: Sensitivity) -> str:
    owner, _, number = found.effect.rpartition(".")
    return SLIDES if number == "gain" else owner


_AMOUNTS = {
    "bias": "1 mm of bias",
    "scale": "0.1 % of scale",
    "offset": "1 mm of offset",
    "normal": "1 mrad of tilt",
    "xyz": "1 mm of position",
    "rpy": "1 mrad of orientation",
    "position": "1 mm of position",
}


def _in_words(owner: str, found: list[Sensitivity]) -> str:
    if owner == SLIDES:
        return _slides_in_words(found)
    numbers = [each.effect.rpartition(".")[2] for each in found]
    moved = [
        f"{_AMOUNTS[n]} would move the tool by {in_millimetres(e.shift_m)}" for n, e in zip(numbers, found, strict=True)
    ]
    keys = listed([f"`{each.key}`" for each in found if each.key]) if any(each.key for each in found) else ""
    exact = "stands exactly where stated"
    if {*numbers} & {"bias", "scale"}:
        exact = "reads without bias or scale error"
    state = f" State {keys} to include it." if keys else " Measure it by a known length to be sure of it."
    return f"Assumes that `{owner}` {exact}, which no reading here can check: {listed(moved)}.{state}"


def _slides_in_words(found: list[Sensitivity]) -> str:
    names = listed([f"`{each.effect.rpartition('.')[0]}`" for each in found])
    moved = listed([in_millimetres(each.shift_m) for each in found])
    travel, their = (
        ("travel exactly as far as they read", "their")
        if len(found) > 1
        else (
            "travels exactly as far as it reads",
            "its",
        )
    )
    return (
        f"Assumes that {names} {travel}, which no reading here can check: 0.1 % of {their} unit of length would move "
        f"the tool by {moved}. Measure a known length to be sure of it."
    )
