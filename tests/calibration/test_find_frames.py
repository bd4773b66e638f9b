"""Frames that nobody has measured are found from the data, whatever they are."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import NOISE, measured, position_cell, ranger_cell

from boresight.calibration.placement import find_frames
from boresight.errors import InputError
from boresight.geometry import Frame, Plane

AXES = ("x", "y", "z", "roll", "pitch", "yaw")


def any_frame(rng, reach):
    """A frame of uniform orientation."""
    q = rng.normal(size=4)
    w, x, y, z = q / np.linalg.norm(q)
    rpy = (
        np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
        np.arcsin(np.clip(2 * (w * y - z * x), -1, 1)),
        np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
    )
    return Frame(tuple(map(float, rng.uniform(-reach, reach, 3))), tuple(map(float, rpy)))


def rms(cell, readings):
    errors = cell.predict(readings.joints, readings.target) - readings.values
    return np.sqrt(np.mean(errors**2))


@pytest.mark.long
@pytest.mark.parametrize("seed", range(6))
def test_a_trackers_base_and_reflector_are_found(seed):
    rng = np.random.default_rng(seed)
    truth = position_cell("ur10", base=any_frame(rng, 3.0), mount=Frame(tuple(map(float, rng.uniform(-0.2, 0.2, 3)))))
    readings = measured(truth, rows=60, seed=seed)
    unknown = frozenset([*(f"base.{a}" for a in AXES), *(f"mount.{a}" for a in "xyz")])
    found = find_frames(replace(truth, base=Frame(), mount=Frame()), readings, unknown, seed).cell
    assert rms(found, readings) < 2 * NOISE


@pytest.mark.long
@pytest.mark.parametrize("seed", range(6))
def test_a_rangers_mount_is_found_from_known_planes(seed):
    rng = np.random.default_rng(seed)
    truth = ranger_cell(planes=3, mount=any_frame(rng, 0.2))
    readings = measured(truth, rows=60, seed=seed)
    found = find_frames(replace(truth, mount=Frame()), readings, frozenset(f"mount.{a}" for a in AXES), seed).cell
    assert rms(found, readings) < 2 * NOISE


def test_without_unknown_frames_the_cell_is_as_it_was():
    cell = ranger_cell()
    assert find_frames(cell, measured(cell, rows=5), frozenset(), 0).cell is cell


def test_the_same_seed_finds_the_same_frames():
    truth = position_cell("ur10", base=Frame((1.0, -0.5, 0.2), (0.3, 0.2, -2.0)))
    readings = measured(truth, rows=20)
    unknown = frozenset(f"base.{a}" for a in AXES)
    start = replace(truth, base=Frame())
    assert find_frames(start, readings, unknown, 3).cell.base == find_frames(start, readings, unknown, 3).cell.base


def test_readings_that_no_placement_explains_are_an_error():
    truth = ranger_cell(planes=1)
    readings = measured(truth, rows=30)
    away = replace(truth, targets={"deck": Plane.of((0.0, 0.0, 1.0), 1e6)})
    with pytest.raises(InputError, match=r"no placement of `mount`.* explains the readings"):
        find_frames(away, readings, frozenset(f"mount.{a}" for a in "xyz"), 0)
