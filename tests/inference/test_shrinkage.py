"""Learned standard deviations: they find how large parameters are, and hold what the data do not ask for."""

import numpy as np
import pytest

from boresight.inference import Squares, shrink

NOISE = 1.0


def drawn(rng, rows, sizes, std):
    """A linear problem whose groups of parameters are drawn with these standard deviations."""
    group = np.repeat(np.arange(len(sizes)), sizes)
    jacobian = rng.normal(size=(rows, len(group))) * 1e3
    truth = rng.normal(size=len(group)) * np.array(std)[group]
    return jacobian, jacobian @ truth + rng.normal(0.0, NOISE, rows), truth, group


def shrunk(squares, group, start=1e-3):
    count = len(group)
    return shrink(squares, np.zeros(count), np.full(count, np.inf), group, np.full(group.max() + 1, start))


def test_standard_deviations_of_groups_and_of_the_noise_are_found():
    jacobian, y, _, group = drawn(np.random.default_rng(1), 2000, (200, 200), (1e-2, 1e-3))
    found = shrunk(Squares.of(jacobian, y), group)
    assert found.group_std == pytest.approx([1e-2, 1e-3], rel=0.15)
    assert found.noise == pytest.approx(NOISE, rel=0.05)


def test_a_group_that_is_not_there_shrinks_to_nothing():
    jacobian, y, _, group = drawn(np.random.default_rng(2), 400, (20, 20), (1e-2, 0.0))
    found = shrunk(Squares.of(jacobian, y), group)
    assert np.abs(found.step[group == 1]).max() < 2e-5
    assert found.effective[1] < 2.0
    assert found.effective[0] > 19.0


def test_held_parameters_predict_better_than_free_ones_where_rows_are_few():
    off = np.zeros(2)
    for seed in range(20):
        jacobian, y, truth, group = drawn(np.random.default_rng([seed, 3]), 45, (40,), (1e-3,))
        held = shrunk(Squares.of(jacobian, y), group).step
        free = np.linalg.lstsq(jacobian, y, rcond=None)[0]
        off += [np.sum((held - truth) ** 2), np.sum((free - truth) ** 2)]
    assert off[0] < 0.5 * off[1]


def test_without_groups_it_is_least_squares_with_priors():
    rng = np.random.default_rng(4)
    jacobian, y, _, _ = drawn(rng, 60, (5,), (1e-2,))
    at, prior = rng.normal(size=5) * 1e-3, np.full(5, 5e-3)
    found = shrink(Squares.of(jacobian, y), at, prior, np.full(5, -1), np.empty(0))
    stacked = np.vstack([jacobian / found.noise, np.diag(1.0 / prior)])
    expected = np.linalg.lstsq(stacked, np.concatenate([y / found.noise, -at / prior]), rcond=None)[0]
    np.testing.assert_allclose(found.step, expected, rtol=1e-6, atol=1e-12)


def test_rows_subtract():
    jacobian, y, _, _ = drawn(np.random.default_rng(5), 30, (4,), (1e-2,))
    rest = Squares.of(jacobian, y).without(Squares.of(jacobian[:10], y[:10]))
    direct = Squares.of(jacobian[10:], y[10:])
    np.testing.assert_allclose(rest.information, direct.information, rtol=1e-12)
    np.testing.assert_allclose(rest.pull, direct.pull, rtol=1e-9)
    assert (rest.count, rest.square) == (20, pytest.approx(direct.square))
