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
from boresight.calibration.robust import Fit
from boresight.calibration.thinning import thinned
from boresight.geometry import Point
from boresight.inference import listed, posterior_root
from boresight.inference.pose import tool_slopes
from boresight.sensing import Cell
from boresight.sensing.linear import model_of, triangle_of
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
    fit: Fit, known: CompleteModel, joints: Float[np.ndarray, "configurations joints"], radius_m: float
) -> tuple[Sensitivity, ...]:
    """Returns the assumptions that matter and that the readings cannot check, the weightiest first.

    Args:
        fit: the final fit.
        known: its complete model: what has a prior already is no silent assumption.
        joints: configurations [rad or m] at which the tool is asked for.
        radius_m: 95 % radius [m] of the tool's position there, as claimed.
    """
    problem, cell = fit.problem, fit.problem.cell
    groups = [group for group in _assumptions(cell) if not set(group[1]) & set(known.names)]
    others = [name for _, names, _ in groups for name in names]
    if not others:
        return ()
    rows = thinned(problem.readings, ROWS)
    few, share = problem.on(rows), len(problem.readings) / len(rows)
    free, names = len(fit.x), (*problem.names, *others)
    weight = np.sqrt(share * few.row_weight)[:, None] / few.std
    slopes = triangle_of(model_of(cell, few.readings, names), np.append(fit.x, np.zeros(len(others))), weight).slopes
    J, K = slopes[:, :free], slopes[:, free:]
    root = posterior_root(J, problem.prior_std)
    D = root @ (root.T @ (J.T @ K))
    information = np.maximum(np.einsum("ij,ij->j", K, K) - np.einsum("ij,ij->j", J.T @ K, D), 0.0)
    moved = _tool_shifts(problem.fitted(fit.x), names, np.vstack([D, -np.eye(len(others))]), joints)
    quantity = {parameter.name: parameter.quantity for parameter in cell.parameters}
    told = []
    for effect, parameters, key in groups:
        amount = AMOUNT[quantity[parameters[0]]]
        places = [others.index(name) for name in parameters]
        # What the readings would have shown is no assumption: an error beyond that would be named by a score test.
        hidden = [HIDDEN / np.sqrt(max(information[p], 1e-300)) for p in places]
        shift = max(float(moved[p]) * min(LARGEST * amount, size) for p, size in zip(places, hidden, strict=True))
        if shift > radius_m:
            unit = UNIT_OF[quantity[parameters[0]]]
            told.append(Sensitivity(effect, amount, unit, max(float(moved[p]) for p in places) * amount, key))
    return tuple(sorted(told, key=lambda each: -each.shift_m))


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
    effects: Float[np.ndarray, "parameters others"],
    joints: Float[np.ndarray, "configurations joints"],
) -> Float[np.ndarray, "others"]:
    """Returns how far a unit of each effect moves the estimated tool from the true one [m], root mean square."""
    slopes, columns = tool_slopes(cell, names, joints)
    shifts = np.einsum("rpi,po->roi", slopes[:, :, :3], effects[columns])
    return np.sqrt(np.mean(np.sum(shifts**2, axis=2), axis=0))


def sensitivities_in_words(found: tuple[Sensitivity, ...]) -> tuple[str, ...]:
    """Returns a sentence for each of the weightiest owners of assumptions."""
    owners = list(dict.fromkeys(_owner(each) for each in found))
    return tuple(_in_words(owner, [each for each in found if _owner(each) == owner]) for owner in owners[:TOLD])


def _owner(found: Sensitivity) -> str:
    return found.effect.rpartition(".")[0]


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
    numbers = [each.effect.rpartition(".")[2] for each in found]
    moved = [
        f"{_AMOUNTS[n]} would move the tool by {in_millimetres(e.shift_m)}" for n, e in zip(numbers, found, strict=True)
    ]
    exact = "reads without bias or scale error" if {*numbers} & {"bias", "scale"} else "stands exactly where stated"
    keys = listed([f"`{each.key}`" for each in found])
    return (
        f"Assumes that `{owner}` {exact}, which no reading here can check: {listed(moved)}. State {keys} to include it."
    )
