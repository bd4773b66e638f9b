"""Which parameters are free when the campaign does not say."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import measured, position_cell, ranger_cell

from boresight.arm import Arm, Joint, catalogue
from boresight.calibration import Campaign
from boresight.calibration.campaign import Freedom
from boresight.calibration.freedom import freedoms_of, link_candidates
from boresight.calibration.problem import Problem
from boresight.geometry import Plane
from boresight.inference import identify_directions


def default_freedom(cell, rows=80, **more):
    campaign = Campaign("default", cell, measured(cell, rows=rows), **more)
    return campaign, freedoms_of(campaign, cell)


def rank_of(campaign, freedoms):
    problem = Problem(campaign.cell, campaign.readings, freedoms)
    return identify_directions(problem.names, problem.sensitivity(np.zeros(len(freedoms))), problem.scale).rank


def names_of(freedoms):
    return [freedom.parameter for freedom in freedoms]


@pytest.mark.parametrize(
    ("arm", "parallel"),
    [
        ("space-arm", ["j2"]),
        ("puma560", ["j2"]),
        ("ur10", ["shoulder_lift_joint", "elbow_joint"]),
        ("iiwa14", []),
        ("panda", []),
    ],
)
def test_beta_stands_in_for_d_exactly_where_axes_are_parallel(arm, parallel):
    candidates = link_candidates(catalogue.load(arm))
    assert [name for name in candidates if name.endswith(".beta")] == [f"{joint}.beta" for joint in parallel]
    for joint in catalogue.load(arm).joint_names:
        assert (f"{joint}.d" in candidates) != (joint in parallel)


@pytest.mark.parametrize(("alpha_deg", "parallel"), [(0.0, True), (4.9, True), (5.1, False), (180.0, True)])
def test_axes_within_five_degrees_count_as_parallel(alpha_deg, parallel):
    arm = Arm("two", (Joint("j1", alpha=np.radians(alpha_deg)), Joint("j2")))
    assert ("j1.beta" in link_candidates(arm)) == parallel


def test_a_prismatic_joint_keeps_its_d():
    arm = Arm("slide", (Joint("j1", "prismatic", limits=(0.0, 1.0)), Joint("j2")))
    assert {"j1.d", "j1.beta"} <= set(link_candidates(arm))


@pytest.mark.parametrize("planes", [1, 2, 3])
@pytest.mark.parametrize("arm", ["space-arm", "puma560", "iiwa14", "panda"])
def test_every_parameter_that_is_freed_is_seen(arm, planes):
    campaign, freedoms = default_freedom(ranger_cell(arm, planes))
    assert rank_of(campaign, freedoms) == len(freedoms)


def test_a_level_plane_hides_the_turn_of_the_first_joint_and_two_more_as_the_paper_says():
    level = replace(ranger_cell(), targets={"deck": Plane.of((0.0, 0.0, 1.0), -0.15)})
    _, freedoms = default_freedom(level)
    assert len(freedoms) == 21
    assert not {"j1.theta", "j1.a"} & set(names_of(freedoms))
    assert "j2.beta" in names_of(freedoms)
    assert "j2.d" not in names_of(freedoms)


def test_nothing_more_could_be_freed():
    cell = ranger_cell(planes=3)
    campaign, freedoms = default_freedom(cell)
    left = [name for name in link_candidates(cell.arm) if name not in names_of(freedoms)]
    for name in left:
        assert rank_of(campaign, (*freedoms, Freedom(name, 0.02, None))) == len(freedoms)


def test_the_turn_about_the_beam_is_left_out():
    puma = ranger_cell("puma560", 3)  # its beam is axis 6
    _, freedoms = default_freedom(puma)
    assert "j6.theta" not in names_of(freedoms)


def test_fixed_parameters_stay_fixed():
    _, freedoms = default_freedom(ranger_cell(planes=3), fixed=frozenset({"j3.a"}))
    assert "j3.a" not in names_of(freedoms)


def test_unknown_frames_come_first_and_crowd_out_the_links_they_stand_for():
    unknown = frozenset(f"base.{n}" for n in ("x", "y", "z", "roll", "pitch", "yaw"))
    campaign, freedoms = default_freedom(position_cell("ur10"), unknown=unknown)
    assert set(names_of(freedoms)[:6]) == unknown
    assert all(f.within is None and f.prior_std is None for f in freedoms[:6])
    assert "shoulder_pan_joint.theta" not in names_of(freedoms)
    assert rank_of(campaign, freedoms) == len(freedoms)


def test_what_the_campaign_names_is_freed_seen_or_not():
    cell = ranger_cell(planes=1)
    named = (Freedom("j1.theta", 0.1, 0.05), Freedom("deck.normal_x", 0.1, 0.05))
    campaign = Campaign("named", cell, measured(cell, rows=10), freedoms=named)
    assert freedoms_of(campaign, cell) == named
    assert freedoms_of(replace(campaign, fixed=frozenset({"j1.theta"})), cell) == named[1:]
