"""Simulated campaigns: a perturbed truth, configurations that see their targets, and noisy readings.

Random numbers come from Philox under (seed, purpose), so that drawing more of one thing changes no other.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float, Int

from boresight.errors import InputError
from boresight.sensing import Cell, Readings

_TRUTH, _CONFIGURATIONS, _NOISE = range(3)

NEAREST_M = 0.05
"""A ranger this close to its plane would collide with it, or be out of its own range."""

GRAZING = 0.2
"""A beam is drawn to meet its plane at no less than this cosine to the normal (78 degrees)."""

_TRIES = 400


def perturbed(cell: Cell, widths: Mapping[str, float], seed: int) -> Cell:
    """Returns the cell with each named parameter off by a uniform error within its width [m, rad or 1]."""
    random = _random(seed, _TRUTH)
    return cell.corrected({name: float(random.uniform(-width, width)) for name, width in widths.items()})


def draw_configurations(
    cells: tuple[Cell, ...], rows: int, seed: int, part: int = 0
) -> tuple[Float[np.ndarray, "rows joints"], Int[np.ndarray, "rows"]]:
    """Returns configurations within the joints' limits in which every given cell sees its target.

    The first configurations of a target are the same however many rows and targets there are.

    Args:
        cells: the nominal cell and the true one, say; the first decides limits and targets.
        rows: how many; they take the targets in turn.
        seed: of the draws.
        part: which batch of that seed: calibration rows, validation rows.

    Raises:
        InputError: hardly any configuration within the limits sees a target.
    """
    cell = cells[0]
    limits = np.clip(cell.arm.limits, -np.pi, np.pi)
    slides = [joint.type == "prismatic" for joint in cell.arm.joints]
    limits[slides] = cell.arm.limits[slides]
    names = list(cell.targets) if cell.sensor.needs_target else [""]
    joints = np.empty((rows, len(limits)))
    target = np.arange(rows) % len(names)
    for place, name in enumerate(names):
        wanted = np.flatnonzero(target == place)
        random = _random(seed, _CONFIGURATIONS, part, place)
        found = np.empty((0, len(limits)))
        for _ in range(_TRIES):
            if len(found) >= len(wanted):
                break
            drawn = random.uniform(limits[:, 0], limits[:, 1], (max(64, 4 * len(wanted)), len(limits)))
            good = np.all([_sees(each, drawn, place) for each in cells], axis=0)
            found = np.concatenate([found, drawn[good]])
        if len(found) < len(wanted):
            raise InputError(
                f"hardly any configuration within the joints' limits sees target {name!r} from at least "
                f"{NEAREST_M * 1e3:.0f} mm: check the plane's normal and offset, the limits, and the mount's direction"
            )
        joints[wanted] = found[: len(wanted)]
    return joints, target


def simulated_readings(
    cell: Cell, joints: Float[np.ndarray, "rows joints"], target: Int[np.ndarray, "rows"], seed: int, part: int = 0
) -> Readings:
    """Returns what a cell's sensor would report: the mean of `repeats` noisy readings (paper, eq. 20).

    Args:
        cell: the true cell.
        joints: configurations [rad or m].
        target: for each row the index of its target.
        seed: of the noise.
        part: which batch of that seed.
    """
    random = _random(seed, _NOISE, part)
    sensor = cell.sensor
    real = cell.predict(joints, target)
    std = np.full(real.shape, sensor.noise_std / np.sqrt(sensor.repeats))
    return Readings(joints, real + random.normal(0.0, std), std, np.asarray(target), np.arange(len(joints)) + 2)


def _sees(cell: Cell, joints: Float[np.ndarray, "rows joints"], place: int) -> np.ndarray:
    if not cell.sensor.needs_target:
        return np.ones(len(joints), dtype=bool)
    ranges = cell.predict(joints, np.full(len(joints), place))[:, 0]
    plane = list(cell.targets.values())[place]
    cosine = np.abs(cell.poses(joints)[:, :3, 2] @ np.asarray(plane.normal))
    return (np.nan_to_num(ranges, nan=0.0) > NEAREST_M) & (cosine > GRAZING)


def _random(*key: int) -> np.random.Generator:
    return np.random.Generator(np.random.Philox(np.random.SeedSequence(key)))
