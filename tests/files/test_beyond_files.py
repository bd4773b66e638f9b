"""Gravity, harmonics and sags in robot.yaml and campaign.yaml."""

import math

import numpy as np
import pytest

from boresight.arm import Arm, Joint
from boresight.errors import InputError
from boresight.files import dump_robot, load_robot

ESTIMATE = '{parameters: ["*.theta"], within: 0.025}'


def problems(folder):
    with pytest.raises(InputError) as caught:
        folder.load()
    return caught.value.problems


def test_a_bent_arm_is_written_and_read_to_the_bit(folder):
    arm = Arm(
        "bent",
        (
            Joint("j1", d=0.3, alpha=-1.5, harmonics=(1e-4, -2e-4, 3e-5, 1e-300)),
            Joint("j2", a=0.4, sag=((2, 1.25e-4), (3, -1e-5))),
            Joint("j3", d=0.1),
        ),
        gravity=(0.6, 0.0, -0.8),
    )
    folder.write(robot=dump_robot(arm))
    assert load_robot("robot.yaml") == arm


def test_harmonics_and_sags_are_angles(folder, robot_with):
    folder.write(robot=robot_with(("a: 400", "a: 400, sin1: 0.01, sag: {2: 0.02}")))
    joint = load_robot("robot.yaml").joints[1]
    assert joint.harmonics == (0.0, math.radians(0.01), 0.0, 0.0)
    assert joint.sag == ((2, math.radians(0.02)),)


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("sag: {1: 0.1}", "'j2' sags under link 1; expected its own link, 2, or one after it, to 2"),
        ("sag: {3: 0.1}", "'j2' sags under link 3; expected its own link, 2, or one after it, to 2"),
        ("sag: [0.1]", "expected turns by number of the link whose weight they come from"),
        ("sag: {2: much}", "expected a finite number for each link"),
        ("type: prismatic, limits: [0, 1], cos1: 0.1", "no harmonics or sag for a prismatic joint"),
    ],
)
def test_what_cannot_bend_so_is_an_error(folder, robot_with, said, told):
    folder.write(robot=robot_with(("a: 400", said)))
    assert told in problems(folder)[0]


@pytest.mark.parametrize(
    ("line", "beyond", "gravity", "weightless"),
    [
        ("", None, None, False),
        ("gravity: level\nbeyond: off", (), None, False),
        ("gravity: off\nbeyond: [harmonics]", ("harmonics",), None, True),
        ("gravity: [0, 3, -4]\nbeyond: [gravity, harmonics]", ("gravity", "harmonics"), (0.0, 0.6, -0.8), False),
    ],
)
def test_a_campaign_says_what_may_be_added_and_where_gravity_points(
    folder, campaign_with, line, beyond, gravity, weightless
):
    campaign = folder.write(campaign=campaign_with(("fixed:", f"{line}\nfixed:"))).load()
    assert (campaign.beyond, campaign.gravity, campaign.weightless) == (beyond, gravity, weightless)


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("gravity: [0, 0, 0]", "expected level, off, or gravity's direction in the world: [0, 0, -1]"),
        ("gravity: down", "expected level, off, or gravity's direction"),
        ("beyond: [weather]", "expected off, or a list of what may be added: [gravity, harmonics]"),
        ("beyond: gravity", "expected off, or a list of what may be added"),
    ],
)
def test_other_words_are_errors(folder, campaign_with, line, told):
    folder.write(campaign=campaign_with(("fixed:", f"{line}\nfixed:")))
    assert told in problems(folder)[0]


def test_gravity_in_the_world_is_turned_into_the_base(folder, campaign_with):
    text = campaign_with(("sensor:", f"gravity: [0, 0, -1]\nbase: {{rpy: [{math.pi / 2}, 0, 0]}}\nsensor:"))
    gravity = folder.write(campaign=text).load().cell.arm.gravity
    np.testing.assert_allclose(gravity, (0.0, -1.0, 0.0), atol=1e-15)


def test_harmonics_and_sags_can_be_named_to_be_estimated(folder, campaign_with):
    named = '{parameters: ["j2.cos1", "*.sag2"], within: 0.01, prior_std: 0.001}'
    campaign = folder.write(campaign=campaign_with((ESTIMATE, named))).load()
    assert [freedom.parameter for freedom in campaign.freedoms] == ["j1.sag2", "j2.cos1", "j2.sag2"]


def test_an_arm_does_not_sag_in_orbit(folder, robot_with, campaign_with):
    robot, campaign = (
        robot_with(("a: 400", "a: 400, cos1: 0.01, sag: {2: 0.02}")),
        campaign_with(("fixed:", "gravity: off\nfixed:")),
    )
    on_ground = folder.write(robot=robot).load().cell.arm.joints[1]
    in_orbit = folder.write(robot=robot, campaign=campaign).load().cell.arm.joints[1]
    assert on_ground.sag == ((2, math.radians(0.02)),)
    assert in_orbit.sag == ()
    assert in_orbit.harmonics == on_ground.harmonics == (math.radians(0.01), 0.0, 0.0, 0.0)
