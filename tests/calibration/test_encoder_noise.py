"""Noise of joint readings: what it adds to a row's standard deviation, and that it is recognised."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import NOISE, measured, ranger_cell, usual_freedoms

from boresight.calibration.encoder_noise import find_encoder_noise, with_joint_noise
from boresight.calibration.problem import Problem
from boresight.calibration.robust import fit

CELL = ranger_cell(planes=3)
STD = 4e-4


def shaken(seed):
    """Readings whose arm stood elsewhere than its encoders said."""
    readings = measured(CELL, rows=120, seed=seed)
    wrong = readings.joints + np.random.default_rng(seed).normal(0.0, STD, readings.joints.shape)
    return replace(readings, joints=wrong)


def fitted(readings):
    freedoms = usual_freedoms(CELL)
    return fit(Problem(CELL, readings, freedoms), np.zeros(len(freedoms)))


def test_rows_are_weighed_by_what_joint_noise_does_to_them():
    readings = measured(CELL, rows=40)
    widened = with_joint_noise(CELL, readings, (STD,) * 6)
    random = np.random.default_rng(0)
    drawn = [
        CELL.predict(readings.joints + random.normal(0.0, STD, readings.joints.shape), readings.target)
        for _ in range(2000)
    ]
    np.testing.assert_allclose(widened.std, np.hypot(np.std(drawn, axis=0), NOISE), rtol=0.12)


def test_without_joint_noise_rows_stay_as_they_are():
    readings = measured(CELL, rows=5)
    assert with_joint_noise(CELL, readings, ()) is readings


def test_it_is_recognised_with_its_size():
    found = [find_encoder_noise(fitted(shaken(seed))) for seed in range(4)]
    assert sum(each is not None for each in found) >= 3
    assert np.median([each.std for each in found if each]) == pytest.approx(STD, rel=0.25)


def test_the_same_error_in_every_reading_is_not_called_encoder_noise():
    for seed in range(4):
        readings = measured(CELL, rows=120, seed=seed)
        noise = np.random.default_rng(seed).normal(0.0, 10 * NOISE, readings.values.shape)
        assert find_encoder_noise(fitted(replace(readings, values=readings.values + noise))) is None
