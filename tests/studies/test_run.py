"""A run hangs on its point and seed alone, and is judged against its truth."""

from dataclasses import replace

import numpy as np
import pytest
from small_studies import bench, planes, point, settings

from boresight.geometry import Plane
from boresight.studies import Bench, run
from boresight.studies.grid import Point
from boresight.studies.outcome import Outcome
from boresight.synthetic import draw_configurations, named_errors


def test_the_same_point_and_seed_give_the_same_numbers_and_another_seed_others():
    one, again, other = run(point(), 1), run(point(), 1), run(point(), 2)
    assert one.numbers == again.numbers
    assert one.position_rms != other.position_rms


def test_a_calibration_beats_the_nominal_model_and_ends_at_the_optimum():
    outcome = run(point(), 3)
    assert outcome.position_rms < 0.02 * outcome.nominal_position_rms
    assert outcome.reached
    assert outcome.cost == pytest.approx(outcome.optimum, rel=1e-6)
    assert outcome.position_rms <= outcome.position_max
    assert outcome.free == len(point().freedoms)


def test_no_search_ends_below_the_optimum():
    outcomes = [run(point(solver="evolution", generations=40, population=40), seed) for seed in range(4)]
    assert all(o.cost >= o.optimum * (1.0 - 1e-8) for o in outcomes)
    assert not any(o.reached for o in outcomes)  # 40 generations are far from enough
    assert all(o.evaluations == 41 * 40 for o in outcomes)


def test_least_squares_after_evolution_reaches_what_evolution_alone_does_not():
    short = {"generations": 40, "population": 40}
    assert run(point(solver="evolution+least-squares", **short), 0).reached


def test_gross_errors_are_planted_and_found():
    outcome = run(point(gross_errors=0.1), 0)
    assert (outcome.planted, outcome.found, outcome.flagged) == (4, 4, 0)
    assert outcome.reached
    clean = run(point(), 0)
    assert (clean.planted, clean.found) == (0, 0)
    assert outcome.position_rms < 3.0 * clean.position_rms


def test_points_share_truth_and_validation_of_a_seed():
    few, many, noisy = run(point(rows=30), 5), run(point(rows=60), 5), run(point(noise_std=1e-3), 5)
    assert few.nominal_position_rms == many.nominal_position_rms == noisy.nominal_position_rms


def test_true_errors_hang_on_their_own_names():
    both = named_errors({"j1.theta": 0.01, "j2.a": 0.002}, 4)
    alone = named_errors({"j2.a": 0.002}, 4)
    assert both["j2.a"] == alone["j2.a"]
    assert named_errors({"j2.a": 0.004}, 4)["j2.a"] == pytest.approx(2 * alone["j2.a"])
    assert named_errors({"j2.a": 0.002}, 5) != alone


def test_named_errors_are_uniform_within_their_widths():
    drawn = np.array([named_errors({"j3.alpha": 0.02}, seed)["j3.alpha"] for seed in range(4000)])
    assert np.abs(drawn).max() <= 0.02
    assert drawn.mean() == pytest.approx(0.0, abs=4 * 0.02 / np.sqrt(3 * 4000))
    assert drawn.std() == pytest.approx(0.02 / np.sqrt(3), rel=0.04)


def test_more_rows_or_planes_keep_a_targets_first_configurations():
    cell, one = point().cell, point(planes=planes(1)).cell
    few, many = draw_configurations((cell,), 6, 2)[0], draw_configurations((cell,), 30, 2)[0]
    assert np.array_equal(few, many[:6])
    deck = draw_configurations((one,), 10, 2)[0]
    assert np.array_equal(deck, many[::3])


def test_averaging_a_hundred_readings_is_a_ranger_ten_times_better():
    averaged, better = run(point(noise_std=1e-3, repeats=100), 1), run(point(noise_std=1e-4, repeats=1), 1)
    assert averaged.position_rms == pytest.approx(better.position_rms, rel=1e-6)


def test_a_run_that_cannot_be_made_says_why_and_is_no_exception():
    cell = bench().cell
    stiff = tuple(replace(joint, limits=(-1e-3, 1e-3)) for joint in cell.arm.joints)
    away = {"deck": Plane.of((0.0, 0.0, 1.0), 50.0)}
    blind = replace(cell, arm=replace(cell.arm, joints=stiff), targets=away)
    outcome = run(Point("blind", Bench(blind, bench().freedoms), settings(planes=planes(1))), 0)
    assert "hardly any configuration" in outcome.failure
    assert np.isnan(outcome.position_rms)
    assert not outcome.reached


def test_own_configurations_are_used_where_no_rows_are_asked_for():
    joints, target = draw_configurations((bench().cell,), 37, 9)
    own = Point("space-arm", Bench(bench().cell, bench().freedoms, joints, target), settings(rows=None))
    assert own.label("rows") == 37
    assert own.key != point().key
    assert run(own, 0).reached


def test_an_outcomes_numbers_leave_out_its_time():
    failed = Outcome.failed("no", 3)
    assert len(failed.numbers) == 18
    assert failed.failure == "no"
