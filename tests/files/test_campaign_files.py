"""campaign.yaml: what it says, what it may not say, and which parameters its patterns mean."""

import hashlib
import math

import pytest

from boresight.geometry import Plane

PLANE = "deck: {type: plane, normal: [0, 1, 4.6], offset: -0.69}"
ESTIMATE = '{parameters: ["*.theta"], within: 0.025}'


def free(campaign):
    return [freedom.parameter for freedom in campaign.freedoms]


def test_a_campaign_is_read_whole(folder):
    campaign = folder.load(need_readings=True)
    assert campaign.name == folder.path.name
    assert campaign.cell.targets == {"deck": Plane.of((0.0, 1.0, 4.6), -0.69)}
    assert campaign.cell.sensor.repeats == 4
    assert campaign.readings.values.ravel().tolist() == [0.3, 0.4]
    assert campaign.readings.std.ravel().tolist() == [0.0001, 0.0001]
    assert campaign.validation is None
    assert free(campaign) == ["j2.theta"]
    assert campaign.freedoms[0].prior_std == 0.025 / math.sqrt(3)
    assert campaign.fixed == {"j1.theta"}
    assert (campaign.warnings, campaign.notes, campaign.set_aside) == ((), (), ())
    files = ("campaign.yaml", "robot.yaml", "observations.csv")
    assert campaign.inputs == {f: hashlib.sha256((folder.path / f).read_bytes()).hexdigest() for f in files}


def test_lengths_and_angles_are_in_the_campaigns_units(folder, campaign_with):
    text = campaign_with(
        ("sensor:", "units: {length: mm, angle: deg}\nbase: {xyz: [1, 2, 3], rpy: [0, 0, 90]}\nsensor:"),
        ("0.0002", "0.2"),
        ("-0.69", "-690"),
        (ESTIMATE, '{parameters: ["j2.theta", "j2.a", "deck.normal_x"], within: 2, prior_std: 1}'),
    )
    campaign = folder.write(campaign=text, observations="j1,j2,range\n10,20,300\n").load()
    assert campaign.cell.base.xyz == (0.001, 0.002, 0.003)
    assert campaign.cell.base.rpy == (0.0, 0.0, math.pi / 2)
    assert campaign.cell.targets["deck"].offset == pytest.approx(Plane.of((0.0, 1.0, 4.6), -0.69).offset)
    assert campaign.cell.sensor.noise_std == pytest.approx(0.0002)
    assert campaign.readings.joints.ravel() == pytest.approx([math.radians(10), math.radians(20)])
    assert campaign.readings.values.ravel() == pytest.approx([0.3])
    within = {f.parameter: f.within for f in campaign.freedoms}
    assert within == pytest.approx({"j2.theta": math.radians(2), "j2.a": 0.002, "deck.normal_x": 2.0})


def test_a_misspelt_key_names_the_nearest_one(folder, campaign_with):
    folder.write(campaign=campaign_with(("normal:", "nomral:")))
    assert folder.problems() == (
        "campaign.yaml, line 4: targets.deck.normal: this key is missing; "
        "expected a list of 3 numbers, a direction at right angles to the plane",
        "campaign.yaml, line 4: targets.deck.nomral: unknown key (did you mean normal?); "
        "expected one of type, normal, offset, normal_std, offset_std, flatness",
    )


def test_all_faults_of_a_campaign_are_told_at_once(folder, campaign_with):
    text = campaign_with(("laser_ranger", "lazer_ranger"), ("0.0002", "-1"), ("repeats: 4", "repeats: 2.5"))
    folder.write(campaign=text + "mount: {xyz: unknwon, rpy: [1, 2]}\n")
    assert folder.problems() == (
        "campaign.yaml, line 2: sensor.type: got 'lazer_ranger' (did you mean laser_ranger?); "
        "expected one of laser_ranger, draw_wire, position, pose, plane_contact, point_contact, distances",
        "campaign.yaml, line 2: sensor.noise_std: got -1; expected a number above 0",
        "campaign.yaml, line 2: sensor.repeats: got 2.5; expected a whole number",
        "campaign.yaml, line 9: mount.xyz: got 'unknwon'; expected a list of 3 finite numbers, or unknown",
        "campaign.yaml, line 9: mount.rpy: got [1, 2]; expected a list of 3 finite numbers, or unknown",
    )


def test_faults_of_several_files_are_told_together(folder, campaign_with):
    folder.write(campaign=campaign_with(("j1.theta", "j1.thta")), observations="j1,j2,range\n1,x,2\n")
    first, second = folder.problems()
    assert first.startswith("campaign.yaml, line 8: fixed[0]: 'j1.thta' is no parameter (did you mean j1.theta?); ")
    assert second == "observations.csv, line 2: j2: got 'x'; expected a number, or an empty cell where there is none"


@pytest.mark.parametrize("text", ["", "5", "[1, 2]", "just words"])
def test_a_file_without_keys_is_told_which_there_are(folder, text):
    problem = folder.write(campaign=text).problem()
    assert "expected a block with some of the keys robot, units, sensors, sensor, markers, mount, base" in problem


def test_no_message_speaks_pydantic(folder, campaign_with):
    text = campaign_with(("[0, 1, 4.6]", "{}"), ('["*.theta"]', "5"), ("[j1.theta]", "{a: 1}"), ("0.025", "[]"))
    text = text.replace("robot: robot.yaml", "robot: [1]").replace("observations: ", "observations: 3 #")
    told = "\n".join(folder.write(campaign=text).problems())
    assert "Input should" not in told
    assert "pydantic" not in told
    assert told.count("campaign.yaml, line") == 6


def test_a_long_list_of_faults_is_cut(folder, campaign_with):
    problems = folder.write(campaign="\n".join(f"key{i}: 1" for i in range(50))).problems()
    assert len(problems) == 21
    assert problems[-1] == "and 32 more"


def test_a_normal_of_zeros_is_no_direction(folder, campaign_with):
    problem = folder.write(campaign=campaign_with(("[0, 1, 4.6]", "[0, 0, 0]"))).problem()
    assert problem.startswith("campaign.yaml, line 4: targets.deck.normal: got [0.0, 0.0, 0.0]; expected a direction")


@pytest.mark.parametrize("name", ["base", "mount", "sensor", "a.b", "'*'"])
def test_targets_cannot_be_called_what_means_something_else(folder, campaign_with, name):
    problem = folder.write(campaign=campaign_with(("deck:", f"{name}:"))).problem()
    assert problem.startswith("campaign.yaml, line 4: targets.")


def test_a_target_cannot_be_called_like_a_joint(folder, campaign_with):
    problem = folder.write(campaign=campaign_with(("deck:", "j1:"))).problem()
    assert problem == "campaign.yaml, line 4: targets.j1: a joint is called j1 too; expected another name"


def test_a_ranger_needs_a_target(folder, campaign_with):
    problem = folder.write(campaign=campaign_with((f"targets:\n  {PLANE}\n", ""))).problem()
    assert "a laser_ranger points at a target and there is none" in problem


def test_a_missing_file_names_the_nearest_one(folder, campaign_with):
    folder.write(campaign=campaign_with(("observations.csv", "observation.csv")))
    assert folder.problem() == (
        "campaign.yaml, line 5: observations: observation.csv: there is no such file "
        "(did you mean observations.csv?); expected a CSV or Parquet file"
    )


@pytest.mark.parametrize("name", [".", "/dev/zero", '"a\\0b"', '"\\ud800"', "x" * 5000, "no/such/folder.yaml"])
def test_what_is_no_file_is_told_so(folder, campaign_with, name):
    problem = folder.write(campaign=campaign_with(("robot.yaml", name))).problem()
    assert problem.startswith("campaign.yaml, line 1: robot: ")


def test_robots_come_from_the_catalogue(folder, campaign_with):
    text = campaign_with(
        ("robot.yaml", "{catalogue: ur10}"), ("[j1.theta]", "[]"), ("observations: observations.csv", "")
    )
    assert folder.write(campaign=text).load().cell.arm.joint_names[0] == "shoulder_pan_joint"


def test_an_arm_that_is_not_in_the_catalogue_names_the_nearest_one(folder, campaign_with):
    problem = folder.write(campaign=campaign_with(("robot.yaml", "{catalogue: ur11}"))).problem()
    assert "the catalogue has no arm 'ur11' (did you mean ur10?); expected one of " in problem


URDF = """<robot name="two"><link name="base"/><link name="one"/><link name="two"/><link name="tool"/>
<joint name="j1" type="revolute"><origin xyz="0 0 0.3"/><parent link="base"/><child link="one"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="2"/></joint>
<joint name="j2" type="continuous"><origin xyz="0.1 0 0"/><parent link="one"/><child link="two"/></joint>
<joint name="end" type="fixed"><origin xyz="0.4 0 0"/><parent link="two"/><child link="tool"/></joint></robot>"""


@pytest.mark.parametrize("robot", ["{urdf: arm.urdf, base: base, tip: tool}", "arm.urdf", "{urdf: arm.urdf}"])
def test_a_robot_can_be_a_urdf(folder, campaign_with, robot):
    folder.write(campaign=campaign_with(("robot.yaml", robot)), **{"arm.urdf": URDF})
    campaign = folder.load()
    assert campaign.cell.arm.joint_names == ("j1", "j2")
    assert campaign.robot_file.content == URDF.encode()
    assert campaign.inputs["arm.urdf"] == hashlib.sha256(URDF.encode()).hexdigest()
    assert campaign.fixed == {"j1.theta"}


def test_what_a_urdf_cannot_hold_behind_its_last_joint_is_held(folder, campaign_with):
    folder.write(campaign=campaign_with(("robot.yaml", "{urdf: arm.urdf, tip: two}")), **{"arm.urdf": URDF})
    campaign = folder.load()
    assert campaign.fixed == {"j1.theta", "j2.a", "j2.alpha", "j2.beta"}
    assert campaign.notes[-1].startswith("j2.a, .alpha and .beta are held: two is the link that j2 moves")


def test_a_urdf_that_is_missing_is_told_with_the_line_that_names_it(folder, campaign_with):
    problem = folder.write(campaign=campaign_with(("robot.yaml", "{urdf: arm.urdf}"))).problem()
    assert problem == "campaign.yaml, line 1: robot: arm.urdf: there is no such file; expected a URDF file"


@pytest.mark.parametrize("robot", ["{urdf: a.urdf, catalogue: ur10}", "{base: b}", "{}", "[a.urdf]"])
def test_a_robot_comes_from_one_place(folder, campaign_with, robot):
    problem = folder.write(campaign=campaign_with(("robot.yaml", robot))).problem()
    assert "expected the name of a robot.yaml or of a URDF, {catalogue: NAME}, or {urdf: arm.urdf, " in problem


def test_base_and_tip_are_for_urdfs(folder, campaign_with):
    problem = folder.write(campaign=campaign_with(("robot.yaml", "{catalogue: ur10, tip: tool0}"))).problem()
    assert "expected base and tip beside a urdf only" in problem


def test_paths_are_relative_to_the_campaign(folder, monkeypatch, tmp_path_factory):
    from boresight.files import load_campaign

    monkeypatch.chdir(tmp_path_factory.mktemp("elsewhere"))
    assert len(load_campaign(folder.path / "campaign.yaml").readings) == 2


def test_readings_can_be_needed(folder, campaign_with):
    folder.write(campaign=campaign_with(("observations: observations.csv\n", "")))
    assert folder.load().readings is None
    assert "there are no readings; expected observations: " in folder.problem(need_readings=True)


def test_validation_is_read_the_same_way(folder, campaign_with):
    folder.write(
        campaign=campaign_with(("estimate:", "validation: v.csv\nestimate:")), **{"v.csv": "j1,j2,range\n1,2,3\n"}
    )
    assert folder.load().validation.values.tolist() == [[3.0]]


def test_validating_with_the_calibration_data_is_warned_of(folder, campaign_with):
    folder.write(campaign=campaign_with(("estimate:", "validation: observations.csv\nestimate:")))
    assert "they prove nothing" in folder.load().warnings[0]


def test_unknown_frames_stand_at_the_identity(folder, campaign_with):
    campaign = folder.write(
        campaign=campaign_with(("targets:", "base: {xyz: unknown, rpy: [1, 0, 0]}\ntargets:"))
    ).load()
    assert campaign.unknown == {"base.x", "base.y", "base.z"}
    assert (campaign.cell.base.xyz, campaign.cell.base.rpy) == ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0))


def test_without_estimate_the_data_decide(folder, campaign_with):
    assert folder.write(campaign=campaign_with((f"estimate:\n  - {ESTIMATE}\n", ""))).load().freedoms is None


def test_wildcards_reach_joints_and_targets_and_no_frames(folder, campaign_with):
    assert free(folder.write(campaign=campaign_with(('"*.theta"', '"*"'), ("[j1.theta]", "[]"))).load()) == [
        *(f"{joint}.{number}" for joint in ("j1", "j2") for number in ("theta", "d", "a", "alpha", "beta")),
        "deck.normal_x",
        "deck.normal_z",
        "deck.offset",
    ]


def test_a_frame_that_is_named_is_reached(folder, campaign_with):
    campaign = folder.write(campaign=campaign_with(('"*.theta"', '"mount.*", "base.x"'))).load()
    assert free(campaign) == ["base.x", "mount.x", "mount.y", "mount.z", "mount.yaw", "mount.pitch", "mount.roll"]


@pytest.mark.parametrize("pattern", ["*.x", "b*.x", "[b]ase.x", "*.roll"])
def test_wildcards_for_a_frames_owner_reach_nothing(folder, campaign_with, pattern):
    problem = folder.write(campaign=campaign_with(("*.theta", pattern))).problem()
    assert f"'{pattern}' is no parameter" in problem


def test_a_pattern_that_means_nothing_names_the_nearest_one(folder, campaign_with):
    problem = folder.write(campaign=campaign_with(("*.theta", "*.tehta"))).problem()
    assert problem == (
        "campaign.yaml, line 7: estimate[0].parameters[0]: '*.tehta' is no parameter (did you mean *.theta?); "
        "expected names such as j1.theta, j1.d, j1.a or *.theta, of base, j1, j2, mount, deck, sensor; "
        "* does not reach base, mount, sensor, name these in full"
    )


def test_later_freedoms_override_earlier_ones(folder, campaign_with):
    text = campaign_with((ESTIMATE, f"{ESTIMATE}\n  - {{parameters: [j2.theta], within: 0.5}}"))
    assert [f.within for f in folder.write(campaign=text).load().freedoms] == [0.5]


@pytest.mark.parametrize("within", ["0", "-1", "true", ".inf"])
def test_within_is_above_zero(folder, campaign_with, within):
    assert "estimate[0].within: got " in folder.write(campaign=campaign_with(("0.025", within))).problem()


@pytest.mark.parametrize(
    ("normal", "asked", "reached"),
    [
        ("[0, 1, 4.6]", '"*.normal_x", "*.normal_z"', ["deck.normal_x", "deck.normal_z"]),
        ("[0, 0, 1]", '"*.normal_x", "*.normal_z"', ["deck.normal_x", "deck.normal_y"]),
        ("[1, 0, 0]", "deck.normal_x, deck.normal_z", ["deck.normal_y", "deck.normal_z"]),
    ],
)
def test_a_normals_dropped_component_is_replaced_by_y(folder, campaign_with, normal, asked, reached):
    campaign = folder.write(campaign=campaign_with(("[0, 1, 4.6]", normal), ('"*.theta"', asked))).load()
    assert free(campaign) == reached
    assert len(campaign.notes) == ("deck.normal_y" in reached)
    assert all("deck.normal_y stands in for it" in note for note in campaign.notes)


def test_a_pattern_that_reaches_y_itself_needs_no_stand_in(folder, campaign_with):
    campaign = folder.write(campaign=campaign_with(("[0, 1, 4.6]", "[0, 0, 1]"), ("*.theta", "*.normal_*"))).load()
    assert free(campaign) == ["deck.normal_x", "deck.normal_y"]
    assert campaign.notes == ()
