"""Effects that a model lacks are named, with their size; slips are told where nothing else explains."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import NOISE, measured, position_cell, ranger_cell, usual_freedoms

from boresight.calibration.alternatives import find_alternatives
from boresight.calibration.campaign import Campaign
from boresight.calibration.explanations import explain
from boresight.calibration.problem import Problem
from boresight.calibration.robust import fit
from boresight.geometry import Plane
from boresight.synthetic import perturbed

RADIUS_M = 3e-4
CELL = ranger_cell(planes=3)


def truth_of(cell, seed=1):
    return perturbed(cell, {f.parameter: 0.2 * f.within for f in usual_freedoms(cell)}, seed)


def fitted(cell, readings):
    freedoms = usual_freedoms(cell)
    return fit(Problem(cell, readings, freedoms), np.zeros(len(freedoms)))


def explained(cell, readings):
    return explain(fitted(cell, readings), (), gravity=True, radius_m=RADIUS_M)


def test_nothing_is_explained_where_nothing_is_missing():
    for seed in range(5):
        assert explained(CELL, measured(CELL, truth_of(CELL, seed), 100, seed)) == ()


@pytest.mark.parametrize(
    ("parameter", "size", "effect"),
    [
        ("sensor.bias", 2e-3, "sensor.bias"),
        ("sensor.scale", 0.01, "sensor.scale"),
        ("deck.offset", 5e-3, "deck.offset"),
        ("wall_x.normal_y", 0.03, "wall_x.normal"),
    ],
)
def test_what_is_wrong_in_every_row_is_named_with_its_size(parameter, size, effect):
    truth = truth_of(CELL).corrected({parameter: size})
    found = explained(CELL, measured(CELL, truth, 100, 1))
    assert found[0].effect == effect
    assert found[0].parameters[0].startswith(effect)
    assert abs(found[0].value) == pytest.approx(size, abs=5 * found[0].std + 0.05 * size)
    assert found[0].ratio_after < 1.3
    assert found[0].ratio_before > 2 * found[0].ratio_after or found[0].left_out_before > 20 + found[0].left_out_after


def test_a_link_that_grows_during_the_campaign_is_a_drift_in_time():
    truth = truth_of(CELL)
    start, end = (measured(truth.corrected({"j2.a": side * 5e-4}), rows=100, seed=3) for side in (-1.0, 1.0))
    share = np.linspace(0.0, 1.0, 100)[:, None]
    readings = replace(start, values=(1 - share) * start.values + share * end.values)
    assert explained(CELL, readings)[0].effect == "drift of j2.a"


def test_a_base_that_stands_elsewhere_is_named_of_a_tracker():
    cell = position_cell()
    truth = truth_of(cell).corrected({"base.roll": 0.01, "base.pitch": -0.01})
    found = explained(cell, measured(cell, truth, 60, 2))
    assert found[0].effect.startswith("base")


def alternatives(cell, readings):
    campaign = Campaign("slip", cell, readings)
    return find_alternatives(fitted(cell, readings), cell, campaign, 0)


@pytest.mark.parametrize(
    ("slip", "effect", "words"),
    [
        (lambda r: replace(r, joints=r.joints * [1, 1, -1, 1, 1, 1]), "j3 counts backwards", "Joint j3 counts"),
        (lambda r: replace(r, joints=r.joints[:, [0, 2, 1, 3, 4, 5]]), "joint columns", "columns of joints j2 and j3"),
        (
            lambda r: replace(r, values=np.roll(r.values, 1, axis=0)),
            "row order",
            "configuration and target one row earlier",
        ),
        (lambda r: replace(r, target=np.array([1, 0, 2])[r.target]), "targets", "`deck` and `wall_x` are exchanged"),
    ],
)
def test_slips_in_the_rows_are_told(slip, effect, words):
    readings = slip(measured(CELL, truth_of(CELL), 100, 1))
    found = alternatives(CELL, readings)
    assert found[0].effect == effect
    assert words in found[0].sentence
    assert found[0].ratio_after < 2.0 < 0.1 * found[0].ratio_before


def test_a_plane_with_the_other_sign_is_told():
    readings = measured(CELL, truth_of(CELL), 100, 1)
    wall = CELL.targets["wall_x"]
    wrong = replace(CELL, targets={**CELL.targets, "wall_x": Plane.of(wall.normal, -wall.offset)})
    assert alternatives(wrong, readings)[0].effect == "wall_x flipped"


def test_offsets_of_two_planes_exchanged_are_told():
    readings = measured(CELL, truth_of(CELL), 100, 1)
    deck, wall = CELL.targets["deck"], CELL.targets["wall_x"]
    exchanged = {"deck": Plane.of(deck.normal, wall.offset), "wall_x": Plane.of(wall.normal, deck.offset)}
    found = alternatives(replace(CELL, targets={**CELL.targets, **exchanged}), readings)
    assert found[0].effect == "offsets of deck and wall_x"


def test_no_slip_is_told_of_rows_that_are_as_they_should_be():
    assert alternatives(CELL, measured(CELL, truth_of(CELL), 100, 1)) == ()


def test_noise_of_the_sensor_is_as_stated():
    assert fitted(CELL, measured(CELL, truth_of(CELL), 100, 1)).problem.readings.usual_std == NOISE
