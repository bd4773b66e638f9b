"""robot.yaml: what it says, what it may not say, and that it is written to the bit."""

import math
import random

import pytest

from boresight.arm import Arm, Joint
from boresight.errors import InputError
from boresight.files import dump_robot, load_robot
from boresight.geometry import Frame
from factory_arms import factory_arm


@pytest.fixture
def robot(folder):
    def robot(text):
        folder.write(robot=text)
        return load_robot("robot.yaml")

    return robot


@pytest.fixture
def problems(robot):
    def problems(text):
        with pytest.raises(InputError) as caught:
            robot(text)
        return caught.value.problems

    return problems


def test_units_are_converted_once(folder):
    first, second = load_robot("robot.yaml").joints
    assert (first.d, first.alpha) == (0.3, -math.pi / 2)
    assert first.limits == pytest.approx((math.radians(-170), math.radians(170)))
    assert second == Joint("j2", a=0.4)


def test_units_default_to_metres_and_radians(robot):
    (joint,) = robot("name: one\njoints: [{name: j, alpha: 0.5, d: 2}]\n").joints
    assert (joint.alpha, joint.d, joint.limits) == (0.5, 2.0, (-math.pi, math.pi))


def test_limits_of_a_prismatic_joint_are_lengths(robot, robot_with):
    arm = robot(robot_with(("a: 400", "type: prismatic, limits: [0, 500]")))
    assert arm.joints[1].limits == (0.0, 0.5)


def test_a_prismatic_joint_needs_limits(problems, robot_with):
    assert problems(robot_with(("a: 400", "type: prismatic"))) == (
        "robot.yaml, line 5: joints[1]: expected limits for a prismatic joint, in the length unit: limits: [0, 0.5]",
    )


def test_modified_dh_is_a_convention(robot, robot_with):
    assert robot(robot_with(("joints:", "convention: modified-dh\njoints:"))).convention == "modified-dh"


def test_all_faults_of_a_robot_are_told_at_once(problems, robot_with):
    text = robot_with(("name: j2, a: 400", "name: j1, a: '400', bta: 1"), ("-170, 170", "170, -170"), ("mm", "inch"))
    assert problems(text) == (
        "robot.yaml, line 5: joints[1].name: 'j1' is the name of an earlier joint; expected another",
        "robot.yaml, line 2: units.length: got 'inch'; expected one of m, mm",
        "robot.yaml, line 4: joints[0].limits: got [170, -170]; expected two finite numbers, "
        "the lower limit and then the upper: [-170, 170]; or none",
        "robot.yaml, line 5: joints[1].a: got '400'; expected a number",
        "robot.yaml, line 5: joints[1].bta: unknown key (did you mean beta?); "
        "expected one of name, type, theta, d, a, alpha, beta, "
        "cos1, sin1, cos2, sin2, sag, limits, follows, ratio",
    )


@pytest.mark.parametrize("name", ["", "a.b", "base", "mount", "sensor", "j*", "' j'", "'a#b'", "'a,b'", "7"])
def test_names_that_would_be_ambiguous_are_refused(problems, robot_with, name):
    (problem,) = problems(robot_with(("name: j2", f"name: {name}")))
    assert problem.startswith("robot.yaml, line 5: joints[1].name: got ")


@pytest.mark.parametrize("number", ["true", ".nan", ".inf", "1e999", "9" * 400, "[1]", "null"])
def test_only_finite_numbers_are_numbers(problems, robot_with, number):
    (problem,) = problems(robot_with(("a: 400", f"a: {number}")))
    assert "joints[1].a: got " in problem


def test_an_arm_has_a_joint(problems):
    (problem,) = problems("name: none\njoints: []\n")
    assert problem == "robot.yaml, line 2: joints: got []; expected a list of at least 1"


def test_a_table_has_no_links_to_stand_between():
    with pytest.raises(InputError, match=r"robot\.yaml: base and tip are links of a URDF; a robot\.yaml has none"):
        load_robot("robot.yaml", tip="tool0")


def test_root_tip_followers_and_joints_without_limits_are_written_to_the_bit(robot):
    joints = (
        Joint("lift", "prismatic", limits=(0.0, 0.5)),
        Joint("turn", a=0.1, limits=(-math.inf, math.inf)),
        Joint("other", "prismatic", d=0.01, limits=(0.0, 0.5), follows="lift", ratio=-1.0 / 3.0),
        Joint("geared", alpha=0.1, follows="turn", ratio=2.0),
    )
    root, tip = Frame((0.1, 1 / 3, 0.0), (0.0, 0.0, -2.0)), Frame((0.0, 0.0, 1e-7), (1.0, 0.5, 0.25))
    arm = Arm("a", joints, "standard-dh", root, tip)
    assert robot(dump_robot(arm)) == arm


def test_a_followers_ratio_is_in_the_files_units(robot):
    text = (
        "name: a\nunits: {length: mm, angle: deg}\njoints:\n"
        "  - {name: j1}\n  - {name: j2, type: prismatic, follows: j1, ratio: 2}\n"
    )
    assert robot(text).joints[1].ratio == pytest.approx(2e-3 / math.radians(1.0))


def test_a_joint_follows_one_that_has_a_reading(problems):
    (problem,) = problems("name: a\njoints: [{name: j1}, {name: j2, follows: j3}]\n")
    assert problem == ("robot.yaml, line 1: expected joint j2 to follow one that has a reading of its own: j1")


def test_a_robot_is_written_to_the_bit(robot):
    draw = random.Random(1)
    joints = tuple(
        Joint(
            name, kind, *(draw.uniform(-4, 4) * 10.0 ** draw.randint(-12, 3) for _ in range(5)), (-draw.random(), 1 / 3)
        )
        for name, kind in [("j1", "revolute"), ("true", "prismatic"), ("é: '\"x'", "revolute"), ("null", "prismatic")]
        if '"' not in name
    )
    arm = Arm("3.14", joints, "modified-dh")
    assert robot(dump_robot(arm, "made by a test\nover two lines")) == arm


def test_the_header_cannot_leave_its_comment():
    text = dump_robot(Arm("a", (Joint("j"),)), "one\nname: two\r\nthree")
    assert text.splitlines()[:4] == ["# one", "# name: two", "# three", 'name: "a"']


def test_a_campaigns_table_of_nearly_parallel_axes_gets_lengths_of_its_own_size(folder, campaign_with):
    campaign = campaign_with()
    robot = dump_robot(factory_arm("ur10e, 439 m"))
    names = "j1,j2,j3,j4,j5,j6,range"
    folder.write(robot=robot, campaign=campaign, **{"observations.csv": f"{names}\n0.1,0.2,0.3,0.4,0.5,0.6,0.7\n"})
    loaded = folder.load()
    arm = loaded.cell.arm
    assert max(abs(length) for joint in arm.joints for length in (joint.d, joint.a)) < 0.62
    (note,) = (note for note in loaded.notes if "nearly parallel" in note)
    assert note == (
        "robot.yaml: nearly parallel axes carry lengths up to 446 m; the arm is calibrated and written with beta in "
        "place of d there, none of its lengths above 0.61 m. It moves the same."
    )
    assert dump_robot(load_robot("robot.yaml")) == robot  # read alone, a table stays as it is to the bit


@pytest.mark.parametrize("ratio", ["-1", "0.5", "100", "0"])
def test_a_ratio_without_a_joint_to_follow_is_refused(problems, robot_with, ratio):
    assert problems(robot_with(("a: 400", f"a: 400, ratio: {ratio}"))) == (
        "robot.yaml, line 5: joints[1]: expected follows: JOINT beside ratio, which multiplies that joint's reading; a "
        f"joint's own is not multiplied: write column j2 of the observations times {ratio} instead",
    )


def test_a_ratio_of_one_changes_nothing(robot, robot_with):
    assert robot(robot_with(("a: 400", "a: 400, ratio: 1"))).joints[1] == Joint("j2", a=0.4)
