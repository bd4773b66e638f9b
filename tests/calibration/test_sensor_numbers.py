"""A ranger's own bias and scale: estimated where they can be seen, and said where not."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import boresight
from boresight.calibration import Freedom, Solver
from boresight.calibration.simulate import simulate
from boresight.inference import identify_directions

EXAMPLES = Path(__file__).parents[2] / "examples"
OWN = (Freedom("sensor.bias", 0.01, 0.005), Freedom("sensor.scale", 0.01, 0.005))


@pytest.fixture(scope="module")
def campaign():
    given = boresight.load_campaign(EXAMPLES / "space-arm-three-planes" / "campaign.yaml")
    return replace(given, freedoms=(*given.freedoms, *OWN))


@pytest.mark.parametrize("solver", ["evolution+least-squares", "least-squares"])
def test_bias_and_scale_are_recovered(campaign, solver):
    rehearsal = simulate(campaign, seed=4, size=0.5)
    result = boresight.calibrate(
        replace(campaign, readings=rehearsal.readings, validation=rehearsal.validation), Solver(solver)
    )
    found = {estimate.name: estimate for estimate in result.estimates}
    for name in ("sensor.bias", "sensor.scale"):
        assert abs(found[name].identified - rehearsal.truth.values[name]) < 4 * found[name].std
        assert found[name].source == "data"
    assert abs(rehearsal.truth.values["sensor.bias"]) > 1e-4


def test_a_wildcard_does_not_free_them():
    given = boresight.load_campaign(EXAMPLES / "space-arm-three-planes" / "campaign.yaml")
    assert not any(freedom.parameter.startswith("sensor.") for freedom in given.freedoms)


def test_a_bias_is_the_mount_along_the_beam(campaign):
    """Both lengthen every range alike; nothing tells them apart."""
    names = ("mount.z", "sensor.bias")
    _, jacobian = campaign.cell.linearise(campaign.readings.joints, campaign.readings.target)
    columns = [campaign.cell.index[name] for name in names]
    found = identify_directions(names, jacobian[:, 0, columns], np.ones(2))
    assert found.rank == 1
