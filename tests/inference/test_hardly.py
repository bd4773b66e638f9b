"""Faint directions: how much of the prior they leave, and how noise is amplified."""

import numpy as np
import pytest

from boresight.inference import hardly_seen, identify_directions

NAMES, SCALE = ("j1.a", "j1.theta", "deck.normal_x"), np.array([0.01, 0.02, 0.5])


def faint(sizes):
    jacobian = np.diag(sizes) / SCALE
    return hardly_seen(identify_directions(NAMES, jacobian, SCALE), jacobian, SCALE, ("length", "angle", "number"))


def test_data_that_leave_more_than_a_tenth_of_the_prior_variance_hardly_see():
    assert [each.parameters for each in faint([2.9, 3.1, 50.0])] == [("j1.a",)]


def test_the_faintest_comes_first_and_the_unseen_not_at_all():
    assert [each.parameters for each in faint([2.0, 1.0, 0.0])] == [("j1.theta",), ("j1.a",)]


def test_amplification_is_what_one_standard_deviation_of_noise_moves():
    (only,) = faint([50.0, 0.5, 50.0])
    assert only.amplification == pytest.approx(0.04)
    assert only.kept == pytest.approx(0.8)
    assert only.words == (
        "j1.theta is hardly seen: noise of one standard deviation moves j1.theta by 40 mrad, "
        "and 80% of the prior variance is left"
    )
    assert only.mend.startswith("about 36 times as many readings")
