"""The joint posterior of all parameters, estimated or not: by brute force, and by Monte Carlo."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import NOISE, measured, ranger_cell

from boresight.calibration import Campaign
from boresight.calibration.campaign import Freedom
from boresight.calibration.complete_model import complete_model
from boresight.calibration.freedom import freedoms_of
from boresight.calibration.noise_size import NoiseSize
from boresight.calibration.priors import default_priors, unestimated
from boresight.calibration.problem import Problem
from boresight.calibration.robust import fit
from boresight.geometry import Plane
from boresight.inference import spread_configurations, tool_accuracy

STATED = NoiseSize(1.0, np.inf)
FLAT = {"deck": Plane.of((0.0, 0.0, 1.0), 0.4)}


def fitted(cell, truth, names, rows=60, seed=0):
    priors = default_priors(cell.arm)
    problem = Problem(cell, measured(cell, truth, rows, seed), tuple(Freedom(n, 0.1, priors[n]) for n in names))
    return fit(problem, np.zeros(len(names)))


def test_it_is_the_inverse_of_all_information_at_once():
    cell = ranger_cell()
    found = fitted(cell, cell, ("j2.theta", "j3.a", "j5.alpha"))
    others = {"j4.theta": 0.01, "j2.a": 0.003, "deck.offset": 0.002}
    known = complete_model(found, others, STATED)
    every = tuple(Freedom(n, None, std) for n, std in others.items())
    whole = replace(found.problem, freedoms=(*found.problem.freedoms, *every))
    columns = whole.sensitivity(np.append(found.x, np.zeros(3)))
    expected = np.linalg.inv(columns.T @ columns + np.diag(1.0 / whole.prior_std**2))
    np.testing.assert_allclose(known.covariance - np.outer(known.mean, known.mean), expected, rtol=1e-6, atol=1e-16)
    assert known.names == ("j2.theta", "j3.a", "j5.alpha", "j4.theta", "j2.a", "deck.offset")
    assert known.prior_of == pytest.approx(others)


def test_conditional_on_the_others_it_is_what_the_fit_itself_says():
    cell = ranger_cell()
    found = fitted(cell, cell, ("j2.theta", "j3.a"))
    known = complete_model(found, {"deck.offset": 0.005}, STATED)
    np.testing.assert_allclose(known.conditional_covariance, found.problem.covariance(found.x), rtol=1e-9)
    assert np.all(np.diag(known.free_covariance) >= np.diag(known.conditional_covariance) * (1 - 1e-12))
    assert known.covariance[0, 2] != 0.0


def test_an_unknown_that_nothing_sees_is_a_gauge_and_not_an_enormous_variance():
    cell = ranger_cell()
    free = (Freedom("j2.theta", 0.1, 0.03), *(Freedom(f"mount.{n}", None, None) for n in ("roll", "pitch", "yaw")))
    found = fit(Problem(cell, measured(cell, rows=60), free), np.zeros(4))
    known = complete_model(found, {}, STATED)
    assert known.in_gauge.tolist() == [False, False, False, True]
    assert np.sqrt(np.diag(known.covariance)).max() < 0.03


def test_readings_that_contradict_an_unestimated_parameter_widen_what_they_contradict():
    cell = ranger_cell(planes=3)
    truth = cell.corrected({"deck.offset": 0.01})
    found = fitted(cell, truth, ("j2.theta", "j3.a"))
    every_row = replace(found, problem=replace(found.problem, row_weights=np.ones(60)))
    known = complete_model(every_row, {"deck.offset": 0.02}, STATED)
    assert known.mean[2] == pytest.approx(0.01, abs=3e-3)
    assert np.sqrt(known.covariance[2, 2]) > 0.007


@pytest.mark.long
def test_on_a_level_plane_the_claimed_radius_holds_truths_drawn_from_the_priors():
    """Every independent parameter is drawn from its prior, searched or not: a level plane cannot see j1.theta."""
    cell = replace(ranger_cell(), targets=FLAT)
    priors = default_priors(cell.arm)
    inside, claimed, missed = [], [], []
    for seed in range(200):
        random = np.random.default_rng(seed)
        truth = cell.corrected({name: float(random.normal(0.0, 0.2 * std)) for name, std in priors.items()})
        campaign = Campaign(
            "flat", cell, measured(cell, truth, 60, seed), priors={n: 0.2 * s for n, s in priors.items()}
        )
        freedoms = tuple(replace(f, prior_std=0.2 * priors[f.parameter]) for f in freedoms_of(campaign, cell))
        assert "j1.theta" not in {freedom.parameter for freedom in freedoms}
        found = fit(Problem(cell, campaign.readings, freedoms), np.zeros(len(freedoms)))
        others = {name: 0.2 * priors[name] for name in unestimated(campaign, cell, freedoms)}
        known = complete_model(found, others, STATED)
        identified = found.problem.fitted(found.x)
        joints = spread_configurations(cell, 30)
        radius = tool_accuracy(identified, known.moments, joints).absolute.pose.position_95
        away = np.linalg.norm((identified.poses(joints) - truth.poses(joints))[:, :3, 3], axis=1)
        inside.append(np.mean(away <= radius))
        claimed.append(np.median(radius))
        missed.append(np.median(away))
    assert np.median(missed) > 10 * NOISE
    assert np.mean(inside) == pytest.approx(0.95, abs=0.03)
    assert np.mean(missed) < np.mean(claimed) < 5 * np.mean(missed)
