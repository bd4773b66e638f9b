"""What is said about each parameter."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import measured, position_cell, rehearsed_campaign

from boresight.calibration import Campaign, Solver, calibrate
from boresight.geometry import Frame

QUICK = Solver("least-squares")


@pytest.fixture(scope="module")
def rehearsal():
    campaign, truth = rehearsed_campaign(planes=3, rows=100)
    return campaign, truth, calibrate(campaign, QUICK)


def by_name(result):
    return {estimate.name: estimate for estimate in result.estimates}


def test_every_link_and_target_number_is_listed_and_no_frame_that_is_known(rehearsal):
    campaign, _, result = rehearsal
    listed = [estimate.name for estimate in result.estimates]
    assert listed == [name for name in campaign.cell.index if not name.startswith(("base.", "mount.", "sensor."))]


def test_a_correction_is_identified_minus_nominal(rehearsal):
    for estimate in rehearsal[2].estimates:
        assert estimate.correction == pytest.approx(estimate.identified - estimate.nominal, abs=1e-15)


def test_what_was_not_estimated_keeps_its_prior_unless_it_is_fixed(rehearsal):
    campaign, _, result = rehearsal
    free = {freedom.parameter for freedom in campaign.freedoms}
    for estimate in result.estimates:
        if estimate.name in result.priors:
            assert (estimate.source, estimate.correction) == ("prior", 0.0)
            assert estimate.std == result.priors[estimate.name]
        else:
            assert (estimate.source == "fixed") == (estimate.name not in free)
        if estimate.source == "fixed":
            assert (estimate.correction, estimate.std) == (0.0, 0.0)


def test_units_are_metres_radians_and_1(rehearsal):
    found = by_name(rehearsal[2])
    assert [found[name].unit for name in ("j1.d", "j1.alpha", "deck.normal_x", "deck.offset")] == ["m", "rad", "1", "m"]


def test_values_from_data_are_the_truth_within_their_deviations(rehearsal):
    _, truth, result = rehearsal
    off = [abs(e.identified - truth.values[e.name]) / e.std for e in result.estimates if e.source == "data"]
    assert len(off) > 15
    assert max(off) < 4.5
    assert np.mean(np.array(off) < 2.0) > 0.85


def test_a_frame_nobody_measured_has_no_nominal_value_and_its_turns_a_deviation():
    truth = position_cell("ur10", base=Frame((1.0, -0.5, 0.2), (0.3, 0.2, -2.0)))
    readings = measured(truth, rows=40)
    unknown = frozenset(f"base.{n}" for n in ("x", "y", "z", "roll", "pitch", "yaw"))
    result = calibrate(Campaign("frame", replace(truth, base=Frame()), readings, unknown=unknown), QUICK)
    found = by_name(result)
    for name in unknown:
        assert found[name].nominal is None
        assert found[name].correction is None
        assert 0.0 < found[name].conditional_std < 1e-2
        assert found[name].conditional_std <= found[name].std
        assert abs(found[name].identified - truth.values[name]) < 5.0 * found[name].conditional_std + 1e-9
    # The base's turn about the first axis and that joint's zero are linearly dependent: only their sum is identified.
    assert found["base.yaw"].source == "prior"
