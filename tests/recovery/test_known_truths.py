"""Truth -> noise -> identified, on several arms and numbers of planes.

Alone this would be an inverse crime; tests/oracles has the truths of others.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from boresight.arm import Arm, Joint, catalogue
from boresight.calibration import Campaign, Solver, calibrate, simulate
from boresight.calibration.freedom import freedoms_of
from boresight.geometry import Frame, Plane
from boresight.sensing import Cell, LaserRanger

PLANES = {
    "deck": Plane.of((0.0, 1.0, 4.6), -0.69),
    "wall_x": Plane.of((-1.0, 0.15, 0.2), 1.6),
    "wall_y": Plane.of((0.1, -1.0, 0.15), 1.7),
}

SCARA = Arm(
    "scara",
    (
        Joint("j1", d=0.4, a=0.35, limits=(-2.5, 2.5)),
        Joint("j2", a=0.25, alpha=math.pi, limits=(-2.5, 2.5)),
        Joint("j3", "prismatic", limits=(0.0, 0.3)),
        Joint("j4", d=0.05, limits=(-3.0, 3.0)),
    ),
)

QUICK = Solver("least-squares")

MOUNT = Frame((0.05, 0.02, 0.03), (0.5, 0.3, 0.0))
"""Off the last axis, whose turn could not be seen otherwise."""


def rehearsed(arm, planes, seed):
    """A campaign of an arm that is off by the usual errors, its truth, and configurations that were not fitted."""
    cell = Cell(
        SCARA if arm == "scara" else catalogue.load(arm),
        LaserRanger(2e-4, repeats=10),
        mount=MOUNT,
        targets=dict(list(PLANES.items())[:planes]),
    )
    rehearsal = simulate(Campaign(arm, cell), rows=120, validation_rows=40, seed=seed)
    campaign = Campaign(arm, cell, rehearsal.readings, rehearsal.validation)
    return campaign, rehearsal.truth


def position_rms_mm(cell, truth, joints):
    off = cell.poses(joints)[:, :3, 3] - truth.poses(joints)[:, :3, 3]
    return 1e3 * float(np.sqrt(np.mean(np.sum(off**2, axis=1))))


@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("arm", ["space-arm", "puma560", "iiwa14", "panda"])
def test_three_planes_bring_position_near_the_truth(arm, seed):
    campaign, truth = rehearsed(arm, 3, seed)
    result = calibrate(campaign, QUICK)
    joints = campaign.validation.joints
    assert result.verdict.accepted
    assert result.rank == result.free
    assert position_rms_mm(campaign.cell, truth, joints) > 2.0
    assert position_rms_mm(result.cell, truth, joints) < 0.35


@pytest.mark.parametrize("planes", [1, 2, 3])
@pytest.mark.parametrize("arm", ["space-arm", "puma560", "iiwa14", "panda", "scara"])
def test_ranges_that_were_not_fitted_are_predicted_to_the_noise(arm, planes):
    campaign, _ = rehearsed(arm, planes, seed=2)
    result = calibrate(campaign, QUICK)
    assert result.verdict.accepted
    assert result.validation.after.rms < 0.1 * result.validation.before.rms
    assert result.validation.after.rms < 3.0 * result.stated_std


@pytest.mark.parametrize("arm", ["space-arm", "puma560", "iiwa14", "panda", "scara"])
def test_ranges_are_where_the_truth_is_within_the_stated_deviations(arm):
    """The default freedom lets one of several confused parameters speak for all: what is seen is compared."""
    campaign, truth = rehearsed(arm, 3, seed=3)
    result = calibrate(campaign, QUICK)
    joints, target = campaign.validation.joints, campaign.validation.target
    found = result.cell.predict(joints, target) - truth.predict(joints, target)
    _, slopes = result.cell.linearise(joints, target)
    slopes = slopes[:, 0, [result.cell.index[name] for name in result.free_names]]
    std = np.sqrt(np.einsum("ri,ij,rj->r", slopes, result.covariance, slopes))
    off = np.abs(found[:, 0]) / std
    assert off.max() < 5.0
    assert np.sqrt(np.mean(off**2)) < 2.0


@pytest.mark.parametrize("arm", ["space-arm", "puma560", "iiwa14", "panda", "scara"])
def test_values_from_data_are_the_truth_within_the_stated_deviations(arm):
    campaign, _ = rehearsed(arm, 3, seed=6)
    freedoms = tuple(replace(f, within=0.2 * f.within) for f in freedoms_of(campaign, campaign.cell))
    campaign = replace(campaign, freedoms=freedoms)
    rehearsal = simulate(campaign, seed=6)  # off in these parameters alone, so that each has one true value
    measured = replace(campaign, readings=rehearsal.readings, validation=rehearsal.validation)
    result = calibrate(replace(measured, freedoms=tuple(replace(f, within=1.0) for f in freedoms)), QUICK)
    values = rehearsal.truth.values
    off = [abs(e.identified - values[e.name]) / e.std for e in result.estimates if e.source == "data"]
    assert len(off) >= 0.5 * result.free
    assert max(off) < 4.5
    assert np.mean(np.array(off) < 2.0) > 0.8


def test_prismatic_joints_are_identified():
    campaign, truth = rehearsed("scara", 3, seed=4)
    result = calibrate(campaign, QUICK)
    joints = campaign.validation.joints
    assert position_rms_mm(campaign.cell, truth, joints) > 1.0
    assert position_rms_mm(result.cell, truth, joints) < 0.5


def test_evolution_alone_recovers_what_least_squares_does():
    campaign, truth = rehearsed("space-arm", 3, seed=5)
    result = calibrate(campaign, Solver("evolution"))
    assert result.verdict.accepted
    assert position_rms_mm(result.cell, truth, campaign.validation.joints) < 0.5
