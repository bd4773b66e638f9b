"""Simulated campaigns: a perturbed truth, configurations that see their targets, and noisy readings.

Random numbers come from Philox under (seed, purpose), so that drawing more of one thing changes no other.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float, Int

from boresight.errors import InputError
from boresight.geometry import Plane, vector_rotation
from boresight.sensing import Cell, LaserRanger, PlaneContact, PointContact, Pose, Readings
from boresight.sensing.pairs import of_distances, pairs_of
from boresight.synthetic.touching import touching

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
    slides = [joint.type == "prismatic" for joint in cell.arm.driven]
    limits[slides] = cell.arm.limits[slides]
    joints = np.empty((rows, len(limits)))
    target = np.arange(rows) % len(cell.aims)
    for place, aim in enumerate(cell.aims):
        wanted = np.flatnonzero(target == place)
        random = _random(seed, _CONFIGURATIONS, part, place)
        found = np.empty((0, len(limits)))
        for _ in range(_TRIES):
            if len(found) >= len(wanted):
                break
            drawn = random.uniform(limits[:, 0], limits[:, 1], (max(64, 4 * len(wanted)), len(limits)))
            if isinstance(cell.sensors[aim.sensor], PlaneContact | PointContact):
                drawn = touching(cells[-1], drawn, place)
                good = np.all((drawn >= limits[:, 0]) & (drawn <= limits[:, 1]), axis=1)
            else:
                good = np.all([_sees(each, drawn, place) for each in cells], axis=0)
            found = np.concatenate([found, drawn[good]])
        if len(found) < len(wanted) and isinstance(cell.sensors[aim.sensor], PointContact):
            raise InputError(
                f"hardly any configuration within the joints' limits touches point {aim.target!r}: check its position "
                "and the limits; a point that is unknown needs one that is about right, which a campaign may state "
                "with `position_std`"
            )
        if len(found) < len(wanted):
            raise InputError(
                f"hardly any configuration within the joints' limits sees target {aim.target!r} from at least "
                f"{NEAREST_M * 1e3:.0f} mm, or touches it: check the plane's normal "
                "and offset, the limits, and the mount's direction"
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
    exact = exact_readings(cell, joints, target)
    std = np.where(exact.read, exact.std, 0.0)
    noise = _random(seed, _NOISE, part).normal(0.0, std)
    reference, moved, target = exact.reference, np.array(exact.joints, dtype=float), exact.target
    for place in np.unique(target).tolist():
        rows, sensor = np.flatnonzero(target == place), cell.sensors[cell.aims[place].sensor]
        if isinstance(sensor, Pose) and reference is not None:
            turned = reference[rows] @ vector_rotation(noise[rows, 3:6] / sensor.lever)
            reference = _with_rows(reference, rows, turned)
            noise[rows, 3:6] = 0.0
        elif isinstance(sensor, PlaneContact | PointContact):  # they read nothing: noise is where the arm is then
            own = slice(0, len(sensor.channels))
            moved[rows] = touching(cell, moved[rows], place, noise[rows, own])
            noise[rows, own] = -exact.values[rows, own]
    return replace(exact, joints=moved, values=exact.values + noise, reference=reference)


def _with_rows(array: np.ndarray, rows: np.ndarray, part: np.ndarray) -> np.ndarray:
    changed = array.copy()
    changed[rows] = part
    return changed


def exact_readings(cell: Cell, joints: Float[np.ndarray, "rows joints"], target: Int[np.ndarray, "rows"]) -> Readings:
    """Returns what a cell's sensors would report without noise, with the standard deviations that they state.

    Args:
        cell: the true cell.
        joints: configurations [rad or m].
        target: for each row the index of its aim.
    """
    joints, target, since = in_pairs(cell, joints, np.asarray(target))
    sensors = [cell.sensors[cell.aims[place].sensor] for place in target]
    std = np.full((len(joints), cell.channels), np.inf)
    for row, sensor in enumerate(sensors):
        std[row, : len(sensor.channels)] = sensor.noise_std / np.sqrt(sensor.repeats)
    turned = np.array([isinstance(sensor, Pose) for sensor in sensors], dtype=bool)
    reference = None
    if turned.any():
        reference = np.where(turned[:, None, None], cell.poses(joints, None, target)[:, :3, :3], np.eye(3))
    values = cell.predict(joints, target, None, reference, since)
    return Readings(joints, values, std, target, np.arange(len(joints)) + 2, reference, None, since)


def in_pairs(
    cell: Cell, joints: Float[np.ndarray, "all joints"], target: Int[np.ndarray, "all"]
) -> tuple[Float[np.ndarray, "rows joints"], Int[np.ndarray, "rows"], Float[np.ndarray, "rows joints"] | None]:
    """Returns configurations, aims and, where distances between two are read, the other configuration of each."""
    first, second = pairs_of(cell, target, None)
    if not len(second):
        return joints, target, None
    since = joints.copy()
    since[first] = joints[second]
    kept = np.setdiff1d(np.arange(len(joints)), np.setdiff1d(of_distances(cell, target), first))
    return joints[kept], target[kept], since[kept]


def _sees(cell: Cell, joints: Float[np.ndarray, "rows joints"], place: int) -> np.ndarray:
    aim = cell.aims[place]
    sensor = cell.sensors[aim.sensor]
    if not isinstance(sensor, LaserRanger) or aim.target is None:
        return np.ones(len(joints), dtype=bool)
    poses, plane = cell.poses(joints, None, np.full(len(joints), place)), cell.targets[aim.target]
    assert isinstance(plane, Plane)
    ranges = sensor.predict(poses, plane, poses)[:, 0]
    cosine = np.abs(poses[:, :3, 2] @ np.asarray(plane.normal))
    return (np.nan_to_num(ranges, nan=0.0) > NEAREST_M) & (cosine > GRAZING)


def _random(*key: int) -> np.random.Generator:
    return np.random.Generator(np.random.Philox(np.random.SeedSequence(key)))
