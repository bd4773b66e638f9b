"""When an arm is found to stand still, and where its joints are then."""

import numpy as np
import pytest

from boresight.recordings import Rules, Signal, Trajectory, still_phases
from boresight.recordings.stillness import speeds
from ros_bags import motion, stops

RULES = Rules()
REST, MOVE = 1.2, 0.8


def trajectory(time, joints, longest_gap=None):
    names = [f"j{k + 1}" for k in range(joints.shape[1])]
    signals = {name: Signal.of(time, joints[:, [k]]) for k, name in enumerate(names)}
    return Trajectory.of(names, signals, longest_gap)


def noisy(joints, kind, rng):
    if kind == "quantised":
        return np.round(joints / 1e-4) * 1e-4
    if kind == "coarse":  # an encoder of a tenth of a degree that cannot decide between two of its steps
        return np.round((joints + rng.normal(0.0, 5e-4, joints.shape)) / 1.7e-3) * 1.7e-3
    return joints + rng.normal(0.0, kind, joints.shape)


@pytest.mark.parametrize("rate", [20.0, 100.0, 1000.0])
@pytest.mark.parametrize("kind", [0.0, 1e-6, 1e-4, 1e-3, "quantised", "coarse"])
def test_every_rest_is_found_and_nothing_else(kind, rate):
    at = stops(12, 3)
    time, joints = motion(at, REST, MOVE, rate)
    seen = noisy(joints, kind, np.random.default_rng(5))
    phases = still_phases(trajectory(time, seen), RULES)
    assert len(phases) == len(at)
    for k, (start, end) in enumerate(phases):
        assert k * (REST + MOVE) <= start < end <= k * (REST + MOVE) + REST
        assert end - start > 0.5


def test_an_arm_in_motion_is_never_still():
    time = np.arange(0.0, 20.0, 0.01)
    joints = np.stack([0.5 * np.sin(time), 0.3 * np.cos(1.3 * time)], axis=1)
    assert len(still_phases(trajectory(time, joints), RULES)) == 0


def test_one_moving_joint_is_enough_to_move():
    time, joints = motion(stops(4, 1))
    joints[:, 1] = 0.01 * time
    assert len(still_phases(trajectory(time, joints), RULES)) == 0


def test_the_ringing_after_a_stop_is_left_out():
    time = np.arange(0.0, 6.0, 0.01)
    ringing = np.where(time < 3.0, np.clip(time, 0.0, 2.0), 2.0) + 0.02 * np.exp(-5.0 * np.abs(time - 3.0)) * np.sin(
        40.0 * (time - 3.0)
    )
    (phase,) = still_phases(trajectory(time, ringing[:, None]), Rules(settle=0.3))[-1:]
    assert phase[0] > 3.6
    within = (time > phase[0]) & (time < phase[1])
    assert np.ptp(ringing[within]) < 1e-3


def test_a_pause_that_is_too_short_is_none():
    time, joints = motion(stops(5, 2), rest_s=0.6)
    assert len(still_phases(trajectory(time, joints), RULES)) == 0
    assert len(still_phases(trajectory(time, joints), Rules(still_time=0.1, settle=0.0))) == 5


def test_a_gap_in_the_joint_states_parts_a_pause():
    time = np.arange(0.0, 6.0, 0.01)
    kept = (time < 2.5) | (time > 3.5)
    phases = still_phases(trajectory(time[kept], np.full((kept.sum(), 1), 0.3)), RULES)
    assert len(phases) == 2
    assert phases[0, 1] <= 2.5 < 3.5 <= phases[1, 0]


def test_joints_published_by_two_nodes_at_two_rates_are_one_arm():
    at = stops(5, 4)
    fast, slow = motion(at, rate=100.0), motion(at, rate=12.0)
    signals = {"a": Signal.of(fast[0], fast[1][:, :1]), "b": Signal.of(slow[0] + 0.001, slow[1][:, 1:])}
    found = Trajectory.of(["b", "a"], signals)
    phases = still_phases(found, RULES)
    assert len(phases) == 5
    for (start, end), stop in zip(phases, at, strict=True):
        np.testing.assert_allclose(found.during(start, end, (start + end) / 2), stop[[1, 0]], atol=1e-6)


def test_speed_is_that_of_a_steady_motion_and_its_noise_is_what_it_scatters_by():
    rng = np.random.default_rng(0)
    time = np.arange(0.0, 100.0, 0.01)
    speed, uncertain = speeds(Signal.of(time, (0.2 * time + rng.normal(0.0, 1e-4, len(time)))[:, None]))
    middle = slice(50, -50)
    assert speed[middle].mean() == pytest.approx(0.2, rel=1e-3)
    # The sample itself is in both means, so the scatter is a little less than that of two independent ones.
    assert 0.6 < speed[middle].std() / uncertain[middle].mean() < 1.2


def test_joints_are_interpolated_and_not_across_gaps():
    time = np.array([0.0, 0.1, 0.2, 1.0, 1.1])
    found = trajectory(time, np.array([[0.0], [1.0], [2.0], [10.0], [11.0]]), longest_gap=0.2)
    at = found.at(np.array([-0.1, 0.05, 0.2, 0.5, 1.05, 1.2]))[:, 0]
    np.testing.assert_allclose(at, [np.nan, 0.5, 2.0, np.nan, 10.5, np.nan])


def test_a_joint_that_creeps_is_where_it_was_when_the_sensor_read():
    time = np.arange(0.0, 2.0, 0.01)
    found = trajectory(time, 1.0 + 5e-4 * time[:, None])
    assert found.during(0.5, 1.5, 1.4)[0] == pytest.approx(1.0 + 5e-4 * 1.4, abs=1e-12)


def test_of_samples_at_one_time_the_last_counts():
    found = Signal.of(np.array([2.0, 1.0, 2.0]), np.array([[5.0], [4.0], [6.0]]))
    assert found.time.tolist() == [1.0, 2.0]
    assert found.values[:, 0].tolist() == [4.0, 6.0]


@pytest.mark.parametrize("samples", [1, 2])
def test_hardly_any_samples_are_no_pause(samples):
    time = np.arange(samples) * 10.0
    assert len(still_phases(trajectory(time, np.zeros((samples, 1))), RULES)) == 0


def test_a_joint_without_a_sample_in_a_phase_is_interpolated():
    fast, slow = np.arange(0.0, 30.0, 0.01), np.arange(0.0, 31.0, 5.0)
    signals = {"a": Signal.of(fast, np.ones((len(fast), 1))), "b": Signal.of(slow, 0.001 * slow[:, None])}
    found = Trajectory.of(["a", "b"], signals)
    np.testing.assert_allclose(found.during(6.0, 7.0, 6.5), [1.0, 0.0065])
