"""The paper's setting: what a seed decides, and what it starts from."""

import numpy as np
import pytest

from boresight.reproduction import setting
from boresight.reproduction.experiment import Assumptions, experiment, non_singular
from boresight.reproduction.variants import ASSUMPTIONS, CHOSEN

SEEDS = range(12)


@pytest.mark.parametrize("rows", setting.CASES.values())
def test_errors_start_above_thirty_millimetres_in_both_cases(rows):
    for seed in SEEDS:
        problem = experiment(seed).on(rows)
        assert 1e3 * np.abs(problem.errors(np.zeros(len(problem.names)))).max() > 30.0


def test_the_truth_lies_within_the_scopes_under_every_assumption():
    for assumed in ASSUMPTIONS.values():
        for seed in range(3):
            drawn = experiment(seed, assumed)
            real = np.array([drawn.truth.values[n] - drawn.problem.cell.values[n] for n in drawn.problem.names])
            assert np.all(np.abs(real) < drawn.problem.half_width)
            assert np.any(real != 0.0)


def test_twenty_five_parameters_are_free_and_a_twenty_sixth_on_request():
    assert len(experiment(0).problem.names) == 25
    free = experiment(0, Assumptions(azimuth=True)).problem.names
    assert len(free) == 26
    assert setting.AZIMUTH in free


def test_the_same_seed_gives_the_same_campaign_and_another_another():
    first, again, other = experiment(3), experiment(3), experiment(4)
    assert np.array_equal(first.readings.values, again.readings.values)
    assert np.array_equal(first.validation, again.validation)
    assert not np.array_equal(first.readings.values, other.readings.values)
    assert not np.array_equal(first.validation, other.validation)


def test_case_1_is_the_beginning_of_case_2():
    drawn = experiment(5)
    few, many = (drawn.on(rows).readings for rows in (35, 100))
    assert np.array_equal(few.joints, many.joints[:35])
    assert np.array_equal(few.values, many.values[:35])


@pytest.mark.parametrize("assumed", [Assumptions(), Assumptions(cosine=0.2), Assumptions(walls=True, azimuth=True)])
def test_beams_meet_their_planes_and_no_configuration_is_singular(assumed):
    drawn = experiment(1, assumed)
    for cell in (drawn.problem.cell, drawn.truth):
        joints, target = drawn.readings.joints, drawn.readings.target
        normals = np.array([plane.normal for plane in cell.targets.values()])[target]
        cosine = np.abs(np.sum(cell.poses(joints)[:, :3, 2] * normals, axis=1))
        assert cosine.min() > assumed.cosine
        assert cell.predict(joints, target).min() >= 0.05
    assert non_singular(drawn.problem.cell, drawn.readings.joints).all()
    assert non_singular(drawn.problem.cell, drawn.validation).all()


def test_a_straight_wrist_is_singular():
    cell = experiment(0).problem.cell
    straight = np.array([[0.3, 0.4, 0.5, 0.6, 0.0, 0.7], [0.3, 0.4, 0.5, 0.6, 1.2, 0.7]])
    assert non_singular(cell, straight).tolist() == [False, True]


def test_averaging_ten_readings_leaves_the_noise_that_section_4_1_says():
    noise = np.concatenate(
        [e.readings.values - e.truth.predict(e.readings.joints, e.readings.target) for e in map(experiment, SEEDS)]
    )
    assert np.std(noise) == pytest.approx(0.0002 / np.sqrt(10), rel=0.05)


def test_errors_of_the_plane_as_printed_are_smaller_than_of_the_unit_normal():
    unit = experiment(0, Assumptions(preset="chosen")).truth.targets["deck"]
    printed = experiment(0, Assumptions(preset="printed")).truth.targets["deck"]
    assert unit.normal[0] == pytest.approx(0.005)
    assert printed.normal[0] * 4.61 / printed.normal[2] == pytest.approx(0.005)
    assert printed.normal[1] * 4.61 / printed.normal[2] == pytest.approx(1.0)


def test_drawn_errors_differ_from_seed_to_seed_and_chosen_ones_do_not():
    def theta(seed, preset):
        return experiment(seed, Assumptions(preset=preset)).truth.values["j2.theta"]

    assert theta(0, "drawn") != theta(1, "drawn")
    assert theta(0, "chosen") == theta(1, "chosen")
    assert CHOSEN in ASSUMPTIONS
