"""Rehearsals: what is perturbed, by how much, and what stays."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import position_cell, ranger_cell, rehearsed_campaign

from boresight.calibration import Campaign, simulate
from boresight.calibration.freedom import USUAL_WITHIN


def test_the_truth_is_off_by_no_more_than_within_and_only_where_free():
    campaign, _ = rehearsed_campaign()
    truth = simulate(campaign, seed=3).truth
    within = {freedom.parameter: freedom.within for freedom in campaign.freedoms}
    for name, value in truth.values.items():
        assert abs(value - campaign.cell.values[name]) <= within.get(name, 0.0) + 1e-12
    assert any(abs(truth.values[n] - campaign.cell.values[n]) > 0.5 * w for n, w in within.items())


def test_size_scales_the_errors_and_nothing_else():
    campaign, _ = rehearsed_campaign()
    whole, half = (simulate(campaign, seed=3, size=size).truth.values for size in (1.0, 0.5))
    for freedom in campaign.freedoms:
        nominal = campaign.cell.values[freedom.parameter]
        assert half[freedom.parameter] - nominal == pytest.approx((whole[freedom.parameter] - nominal) / 2)


def test_no_errors_and_hardly_any_noise_give_the_nominal_ranges():
    cell = replace(ranger_cell(), sensor=replace(ranger_cell().sensor, noise_std=1e-12))
    rehearsal = simulate(Campaign("exact", cell), size=0.0, rows=10)
    ranges = cell.predict(rehearsal.readings.joints, rehearsal.readings.target)
    assert np.allclose(rehearsal.readings.values, ranges, atol=1e-10)


def test_the_campaigns_own_configurations_are_kept_unless_others_are_asked_for():
    campaign, _ = rehearsed_campaign(rows=30)
    assert np.array_equal(simulate(campaign).readings.joints, campaign.readings.joints)
    assert len(simulate(campaign, rows=12).readings) == 12


def test_noise_of_a_row_falls_with_the_root_of_its_repeats():
    cell = replace(ranger_cell(), sensor=replace(ranger_cell().sensor, noise_std=1e-3, repeats=16))
    rehearsal = simulate(Campaign("noisy", cell), size=0.0, rows=2000)
    errors = rehearsal.readings.values - cell.predict(rehearsal.readings.joints, rehearsal.readings.target)
    assert np.std(errors) == pytest.approx(1e-3 / 4, rel=0.05)
    assert np.all(rehearsal.readings.std == 1e-3 / 4)


def test_more_validation_rows_change_no_other_number():
    campaign, _ = rehearsed_campaign(rows=30)
    one, two = simulate(campaign, validation_rows=5, seed=2), simulate(campaign, validation_rows=50, seed=2)
    assert np.array_equal(one.readings.values, two.readings.values)
    assert one.truth == two.truth


def test_without_estimate_every_link_is_a_little_off():
    campaign = Campaign("default", position_cell("ur10"))
    truth = simulate(campaign, rows=5).truth
    for parameter in campaign.cell.parameters:
        error = abs(truth.values[parameter.name] - campaign.cell.values[parameter.name])
        assert error <= 0.2 * USUAL_WITHIN[parameter.quantity]


def test_frames_called_unknown_are_somewhere_else():
    campaign = Campaign("unknown", position_cell("ur10"), unknown=frozenset({"base.x", "base.yaw"}))
    truth = simulate(campaign, rows=5, seed=1).truth
    assert truth.base.xyz[0] != 0.0
    assert truth.base.xyz[1:] == (0.0, 0.0)
