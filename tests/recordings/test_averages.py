"""How certain the mean of a phase is, against many phases whose truth is known."""

import numpy as np
import pytest

from boresight.recordings.averages import averages, step_of, usual

TRUE = 1.234
NOISE = 2e-4


def phases(rng, count=400, readings=12, noise=NOISE):
    return [TRUE + rng.normal(0.0, noise, (readings, 1)) for _ in range(count)]


def z_scores(found):
    return (found.means[:, 0] - TRUE) / found.std[:, 0]


@pytest.mark.parametrize("readings", [3, 12, 50])
def test_white_noise_gives_honest_standard_deviations(readings):
    found = averages(phases(np.random.default_rng(readings), readings=readings), np.zeros(1))
    assert z_scores(found).std() == pytest.approx(1.0, abs=0.08)
    assert found.scatter[0] == pytest.approx(NOISE, rel=0.05)
    assert found.likeness < 1.1


def test_readings_that_are_alike_make_the_mean_less_certain():
    rng = np.random.default_rng(1)
    values = []
    for _ in range(300):
        noise = np.zeros(60)
        for k in range(1, 60):
            noise[k] = 0.6 * noise[k - 1] + rng.normal(0.0, NOISE)
        values.append(TRUE + noise[10:, None])
    found = averages(values, np.zeros(1))
    assert found.likeness > 1.6
    # Believing the noise white would make this 1.9; quarters of 12 readings are themselves somewhat alike.
    assert z_scores(found).std() == pytest.approx(1.0, abs=0.2)


def test_noise_that_differs_between_phases_is_told_apart():
    rng = np.random.default_rng(2)
    found = averages([*phases(rng, 50, 40), *phases(rng, 50, 40, 4 * NOISE)], np.zeros(1))
    assert np.median(found.std[50:]) / np.median(found.std[:50]) == pytest.approx(4.0, rel=0.25)


def test_a_ranger_that_rounds_is_not_certain_beyond_its_step():
    """Noise far below the step: every reading of a phase is the same, and the mean is off by up to half a step."""
    rng, step = np.random.default_rng(3), 1e-3
    true = rng.uniform(0.5, 1.5, 2000)
    rounded = [np.round((t + rng.normal(0.0, 1e-6, (20, 1))) / step) * step for t in true]
    quantum = step_of(np.concatenate(rounded))
    assert quantum[0] == pytest.approx(step, rel=1e-9)
    found = averages(rounded, quantum)
    off = (found.means[:, 0] - true) / found.std[:, 0]
    assert np.sqrt(np.mean(off**2)) == pytest.approx(1.0, abs=0.05)


def test_noise_above_the_step_averages_rounding_out():
    rng, step = np.random.default_rng(4), 1e-3
    true = rng.uniform(0.5, 1.5, 2000)
    rounded = [np.round((t + rng.normal(0.0, step, (25, 1))) / step) * step for t in true]
    found = averages(rounded, step_of(np.concatenate(rounded)))
    assert np.sqrt(np.mean(((found.means[:, 0] - true) / found.std[:, 0]) ** 2)) == pytest.approx(1.0, abs=0.08)


def test_gross_errors_are_left_out_and_good_readings_are_not():
    rng = np.random.default_rng(5)
    values = phases(rng, 200, 10)
    for k in range(0, 200, 4):
        values[k][3] += 0.05
    good = usual(values, np.zeros(1))
    wrong = [(k, i) for k, each in enumerate(good) for i in np.flatnonzero(~each)]
    assert wrong == [(k, 3) for k in range(0, 200, 4)]


def test_single_readings_have_the_scatter_of_the_others():
    found = averages([*phases(np.random.default_rng(6), 50, 10), np.array([[TRUE]])], np.zeros(1))
    assert found.std[-1, 0] == pytest.approx(NOISE, rel=0.1)


def test_channels_are_judged_each_by_itself():
    rng = np.random.default_rng(7)
    values = [rng.normal(0.0, [1e-5, 1e-4, 1e-3], (30, 3)) for _ in range(100)]
    np.testing.assert_allclose(averages(values, np.zeros(3)).scatter, [1e-5, 1e-4, 1e-3], rtol=0.1)
