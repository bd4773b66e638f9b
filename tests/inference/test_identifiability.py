"""Rank, unseen directions, posterior and unexplained residuals."""

import numpy as np
import pytest

from boresight.inference import (
    identify_directions,
    model_std,
    posterior_covariance,
    select_visible,
    sources,
    unseen_in_words,
)

RNG = np.random.default_rng(7)


def jacobian():
    """Five parameters: a and b collinear, c unseen, d and e free."""
    a, d, e = RNG.normal(size=(3, 40))
    return np.column_stack([a, -2.0 * a, np.zeros(40), d, e])


NAMES = ("a", "b", "c", "d", "e")


def test_rank_counts_what_is_seen():
    found = identify_directions(NAMES, jacobian(), np.ones(5))
    assert found.rank == 3
    assert found.unseen.shape == (2, 5)


def test_unseen_directions_change_no_reading_and_are_short():
    J = jacobian()
    found = identify_directions(NAMES, J, np.ones(5))
    assert np.allclose(J @ found.unseen.T, 0.0, atol=1e-6)
    assert sorted(np.count_nonzero(found.unseen, axis=1)) == [1, 2]


def test_words_name_what_stands_alone_and_what_is_confused():
    said = unseen_in_words(identify_directions(NAMES, jacobian(), np.ones(5)), np.ones(5))
    assert (said[0].parameters, said[0].words) == (("c",), "c does not change any reading")
    assert set(said[1].parameters) == {"a", "b"}
    assert "cannot be told apart" in said[1].words


def test_fewer_rows_than_parameters_leave_the_rest_unseen():
    found = identify_directions(NAMES, RNG.normal(size=(2, 5)), np.ones(5))
    assert found.rank == 2
    assert len(found.unseen) == 3


def test_no_parameters_have_no_rank():
    assert identify_directions((), np.empty((4, 0)), np.empty(0)).rank == 0


def test_visible_columns_are_taken_in_order_of_preference():
    J = jacobian()
    assert select_visible(J, [0, 1, 2, 3, 4]) == [0, 3, 4]
    assert select_visible(J, [4, 1, 0, 2, 3]) == [4, 1, 3]


def test_posterior_is_the_inverse_information():
    J = RNG.normal(size=(50, 3))
    prior = np.array([0.5, 2.0, 1.0])
    expected = np.linalg.inv(J.T @ J + np.diag(prior**-2.0))
    assert np.allclose(posterior_covariance(J, prior), expected, rtol=1e-10)


def test_unseen_parameters_keep_their_prior():
    prior = np.array([0.1, 0.2, 0.3, 0.4, 0.5])
    covariance = posterior_covariance(jacobian() * 1e4, prior)
    assert np.sqrt(covariance[2, 2]) == pytest.approx(0.3)
    assert sources(np.sqrt(np.diag(covariance)), prior)[2:] == ("prior", "data", "data")


def test_stated_noise_that_explains_the_residuals_needs_no_more():
    std = np.full(2000, 0.5)
    assert model_std(RNG.normal(0.0, std), std, 10) == 0.0


def test_what_the_model_leaves_unexplained_is_recovered():
    std = RNG.uniform(0.01, 0.3, 20000)
    errors = RNG.normal(0.0, np.hypot(std, 0.7))
    assert model_std(errors, std, 0) == pytest.approx(0.7, rel=0.03)
