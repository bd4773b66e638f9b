"""Joints whose readings start again after a full turn."""

import numpy as np
import pytest

from boresight.recordings import Rules, Signal, Trajectory, still_phases
from boresight.recordings.wrapping import put_back, turns_of

RANGES = {"half turns": lambda x: (x + np.pi) % (2 * np.pi) - np.pi, "whole turns": lambda x: x % (2 * np.pi)}


def trajectory(time, angles, sliding=()):
    return Trajectory.of(["a"], {"a": Signal.of(time, np.asarray(angles)[:, None])}, sliding=sliding)


def apart(a, b):
    return np.abs((a - b + np.pi) % (2 * np.pi) - np.pi)


@pytest.mark.parametrize("wrap", RANGES.values(), ids=RANGES)
@pytest.mark.parametrize("seam", [0.0, np.pi])
def test_a_pause_at_the_seam_is_a_pause(wrap, seam):
    time = np.arange(0.0, 2.0, 0.01)
    angles = wrap(seam + np.random.default_rng(1).normal(0.0, 2e-5, len(time)))
    found = trajectory(time, angles)
    assert len(still_phases(found, Rules())) == 1
    assert apart(found.during(0.5, 1.5, 1.0)[0], seam) < 1e-5


@pytest.mark.parametrize("wrap", RANGES.values(), ids=RANGES)
def test_several_turns_are_interpolated_and_stay_where_they_were_reported(wrap):
    time = np.arange(0.0, 20.0, 0.1)
    angle, when = 1.5 * time + 0.2 * np.sin(time), np.arange(0.25, 19.0, 0.13)
    reported = wrap(angle)
    found = trajectory(time, reported).at(when)[:, 0]
    assert apart(found, 1.5 * when + 0.2 * np.sin(when)).max() < 1e-3
    assert reported.min() - 0.2 < found.min()
    assert found.max() < reported.max() + 0.2


def test_readings_of_several_turns_and_rails_are_left_alone():
    many = np.array([-4.0, 2.2, 4.0, -2.2])
    assert not turns_of(many).any()
    rail = trajectory(np.array([0.0, 1.0]), np.array([0.0, 6.0]), sliding=("a",))
    assert rail.at(np.array([0.5]))[0, 0] == 3.0
    assert not rail.wrapped


def test_angles_come_back_within_the_turn_of_the_readings():
    readings = np.array([-np.pi + 1e-4, np.pi - 1e-4])
    np.testing.assert_allclose(put_back(np.array([np.pi + 0.5, 7.0]), readings), [0.5 - np.pi, 7.0 - 2 * np.pi])
