"""Rows out of bags: topics, clocks, pauses; and campaigns whose observations are a bag."""

import math

import numpy as np
import pytest

import ros_bags as bags
from boresight.errors import InputError
from boresight.files import load_campaign
from boresight.files.recorded import began, read_recorded, rows_csv
from boresight.files.topics import Choice
from boresight.recordings import Rules
from ros_bags import T0, Script, distance


@pytest.fixture
def recorded(tmp_path):
    """Writes a script as a bag and makes rows of it."""

    def recorded(script, joint_names=None, kind=None, **choice):
        path = script.write(tmp_path / "run")
        return read_recorded(path, "run", Choice(**choice), joint_names, kind)

    return recorded


def problem(call, *arguments, **options):
    with pytest.raises(InputError) as caught:
        call(*arguments, **options)
    (told,) = caught.value.problems
    return told


def z_scores(found, at):
    return (found.rows.values[:, 0] - distance(at)) / found.rows.std[:, 0]


def test_every_stop_becomes_a_row_at_its_joints_with_an_honest_standard_deviation(recorded):
    script, at = bags.run(40)
    found = recorded(script)
    assert found.joint_names == ("j1", "j2")
    np.testing.assert_allclose(found.rows.joints, at, atol=1e-5)
    assert np.sqrt(np.mean(z_scores(found, at) ** 2)) == pytest.approx(1.0, abs=0.25)
    assert 30 < np.median(found.rows.repeats) < 45
    assert found.remarks == ()


def test_joints_come_in_the_order_of_the_arm_and_others_are_ignored(recorded):
    script, at = bags.run(5)
    script.say(T0 + 1.0, "/joint_states", bags.joint_state(T0 + 1.0, ["gripper"], [0.02]))
    found = recorded(script, joint_names=("j2", "j1"))
    np.testing.assert_allclose(found.rows.joints, at[:, ::-1], atol=1e-5)
    assert found.remarks == ("Joints that the arm does not have are ignored: gripper.",)


def test_names_in_another_order_in_every_message_are_told_apart(recorded):
    script, at = bags.run(5)
    for k, (_, topic, message) in enumerate(script.messages):
        if topic == "/joint_states" and k % 2:
            message.name.reverse()
            message.position[:] = message.position[::-1].copy()
    np.testing.assert_allclose(recorded(script).rows.joints, at, atol=1e-5)


def test_joints_of_two_topics_are_one_arm(recorded):
    script, at = bags.run(5)
    split = Script()
    for received, topic, message in script.messages:
        if topic != "/joint_states":
            split.say(received, topic, message)
            continue
        stamp = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec
        for k, name in enumerate(message.name):
            split.say(received, f"/{name}/joint_states", bags.joint_state(stamp, [name], [message.position[k]]))
    found = recorded(split, joints=("/j2/joint_states", "/j1/joint_states"), joint_names=("j1", "j2"))
    np.testing.assert_allclose(found.rows.joints, at, atol=1e-5)


def test_infinite_readings_are_set_aside_and_counted_by_kind(recorded):
    script, at = bags.run(5, lost=range(12))
    script.say(T0 + 0.5, "/ranger", bags.range_message(T0 + 0.5001, -math.inf))
    script.say(T0 + 0.5, "/ranger", bags.range_message(T0 + 0.5002, math.nan))
    script.say(T0 + 0.5, "/ranger", bags.range_message(T0 + 0.5003, 7.0))
    found = recorded(script)
    assert found.empty == {
        "+Inf: nothing in range": 12,
        "-Inf: too near": 1,
        "beyond the ranger's own limits": 1,
        "not a number": 1,
    }
    assert np.abs(z_scores(found, at)).max() < 4.0


def test_a_stop_without_a_reading_is_told_with_its_time_and_reason(recorded):
    script, at = bags.run(5, lost=range(100, 165))
    found = recorded(script)
    assert len(found.rows) == 4
    np.testing.assert_allclose(found.rows.joints, at[[0, 2, 3, 4]], atol=1e-5)
    (skipped,) = found.rows.skipped
    assert skipped.reason.startswith("none of its ")
    assert 2.0 < skipped.start < skipped.end < 3.2


def test_gross_errors_within_a_phase_do_not_move_its_mean(recorded):
    script, at = bags.run(5)
    for k, (_, topic, message) in enumerate(script.messages):
        if topic == "/ranger" and k % 37 == 0:
            message.range += 0.3
    found = recorded(script)
    assert found.rows.outlying > 0
    assert np.abs(z_scores(found, at)).max() < 4.0


def test_messages_without_a_header_are_put_on_the_stamps_clock(recorded):
    script, at = bags.run(6, late=0.25)
    plain = Script()
    for received, topic, message in script.messages:
        plain.say(received, topic, bags.number(message.range) if topic == "/ranger" else message)
    found = recorded(plain)
    assert np.abs(z_scores(found, at)).max() < 4.0
    (remark,) = found.remarks
    assert remark == (
        "Messages of /ranger have no time of their own: the recorder's is used, less the 250 ms by which the joint "
        "states reached it late."
    )


def test_a_sensor_on_a_clock_of_its_own_is_paired_by_the_recorders(recorded):
    script, at = bags.run(6)
    for _, topic, message in script.messages:
        if topic == "/ranger":
            message.header.stamp.sec -= 1_600_000_000
    found = recorded(script)
    assert np.abs(z_scores(found, at)).max() < 4.0
    (remark,) = found.remarks
    assert "tell of times that do not meet" in remark


def test_a_known_offset_of_the_sensors_clock_is_taken_off(recorded, tmp_path):
    script, at = bags.run(6)
    for _, topic, message in script.messages:
        if topic == "/ranger":
            message.header.stamp.sec -= 3
    found = recorded(script, time_offset=3.0)
    assert len(found.rows) == 6
    assert np.abs(z_scores(found, at)).max() < 4.0
    off = read_recorded(tmp_path / "run", "run", Choice())
    assert np.abs(off.rows.values[: len(off.rows), 0] - distance(at[: len(off.rows)])).max() > 0.01


def test_targets_are_those_that_were_named_before_a_phase(recorded):
    script, _ = bags.run(6)
    for time, name in ((0.0, "deck"), (3.7, "wall"), (7.7, "deck")):
        script.say(T0 + time, "/ranger/target", bags.word(name))
    found = recorded(script)
    assert found.rows.target == ("deck", "deck", "wall", "wall", "deck", "deck")
    assert found.used["targets"] == "/ranger/target"


def test_a_phase_in_which_the_target_changes_is_two(recorded):
    script, _ = bags.run(3)
    for time, name in ((0.0, "deck"), (0.75, "wall")):
        script.say(T0 + time, "/target", bags.word(name))
    found = recorded(script, rules=Rules(still_time=0.2))
    assert found.rows.target == ("deck", "wall", "wall", "wall")
    np.testing.assert_allclose(found.rows.joints[0], found.rows.joints[1], atol=1e-5)


def test_a_phase_before_any_target_was_named_is_told(recorded):
    script, _ = bags.run(3)
    script.say(T0 + 1.9, "/target", bags.word("wall"))
    found = recorded(script)
    assert found.rows.target == ("wall", "wall")
    assert found.rows.skipped[0].reason == "no target has been named before it"


def test_one_target_for_all_of_a_bag(recorded):
    assert recorded(bags.run(3)[0], target="deck").rows.target == ("deck",) * 3


def test_a_description_of_the_robot_is_no_target(recorded):
    script, _ = bags.run(3)
    script.say(T0, "/robot_description", bags.word("<robot/>"))
    assert recorded(script).rows.target is None


def test_positions_of_a_tracker_become_rows_with_a_standard_deviation_each(recorded):
    script, at = bags.run(12)
    rng, tracked = np.random.default_rng(9), Script()
    for received, topic, message in script.messages:
        if topic == "/joint_states":
            tracked.say(received, topic, message)
            continue
        stamp = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec
        xyz = np.array([1.0, 2.0, message.range]) + rng.normal(0.0, [1e-5, 5e-5, 1e-9])
        tracked.say(received, "/tracker", bags.point(stamp, xyz))
    found = recorded(tracked)
    assert found.channels == ("x", "y", "z")
    np.testing.assert_allclose(found.rows.values, np.column_stack([0 * at + [1, 2], distance(at)]), atol=2e-4)
    header, columns, *_ = rows_csv(found).splitlines()
    assert header == "# run, from 2023-11-14 22:13:20.000 UTC on"
    assert columns == "j1,j2,x,y,z,std_x,std_y,std_z,repeats,time"


def test_readings_without_any_scatter_get_no_standard_deviation(recorded):
    found = recorded(bags.run(4, noise=0.0)[0])
    assert rows_csv(found).splitlines()[1] == "j1,j2,range,repeats,time"


def test_a_ranger_that_rounds_to_millimetres_gets_the_standard_deviation_of_rounding(recorded):
    script, _ = bags.run(6, noise=0.0)
    for _, topic, message in script.messages:
        if topic == "/ranger":
            message.range = round(message.range, 3)
    np.testing.assert_allclose(recorded(script).rows.std[:, 0], 1e-3 / 12**0.5, rtol=0.01)


def test_several_topics_of_a_type_are_told_by_name(recorded):
    script, _ = bags.run(3)
    script.say(T0, "/other", bags.range_message(T0, 1.0))
    assert problem(recorded, script) == (
        "run: there are 2 topics of sensor_msgs/msg/Range; name one of them: range: /other; the bag holds "
        "/joint_states (sensor_msgs/msg/JointState, 520), /other (sensor_msgs/msg/Range, 1), "
        "/ranger (sensor_msgs/msg/Range, 260)"
    )


def test_a_topic_that_is_not_there_is_told_with_the_nearest(recorded):
    assert problem(recorded, bags.run(3)[0], range="/rangr").startswith(
        "run: there is no topic '/rangr' (did you mean /ranger?); the bag holds /joint_states ("
    )


def test_a_topic_of_another_type_is_told(recorded):
    assert problem(recorded, bags.run(3)[0], range="/joint_states").startswith(
        "run: range: /joint_states is of type sensor_msgs/msg/JointState; expected sensor_msgs/msg/Range or "
    )


def test_a_bag_without_joint_states_says_what_it_holds(recorded):
    script = Script()
    script.say(T0, "/ranger", bags.range_message(T0, 1.0))
    assert problem(recorded, script) == (
        "run: there is no topic with messages of sensor_msgs/msg/JointState; expected one for joints; "
        "the bag holds /ranger (sensor_msgs/msg/Range, 1)"
    )


def test_a_joint_that_nobody_published_is_told(recorded):
    assert problem(recorded, bags.run(3)[0], joint_names=("j1", "j2", "j3")) == (
        "run: there is no joint j3 (did you mean j2?); the joint states tell of 'j1', 'j2'"
    )


def test_an_arm_that_never_rests_is_told(recorded):
    script = Script()
    for k in range(500):
        t = 0.01 * k
        script.say(T0 + t, "/joint_states", bags.joint_state(T0 + t, ["j1"], [0.5 * math.sin(t)]))
        script.say(T0 + t, "/ranger", bags.range_message(T0 + t, 1.0))
    assert problem(recorded, script).startswith("run: the arm never stood still for 0.5 s with every joint known")


def test_a_sensor_that_saw_nothing_is_told(recorded):
    assert problem(recorded, bags.run(3, lost=range(1000))[0]).startswith(
        "run: none of 3 still phases gives a row; the first, from "
    )


def test_a_recording_begins_when_it_says():
    assert began(0.0) == "0.000 s of its clock"
    assert began(T0) == "2023-11-14 22:13:20.000 UTC"


CAMPAIGN = """\
robot: robot.yaml
sensor: {type: laser_ranger, noise_std: 0.0002}
targets:
  deck: {type: plane, normal: [0, 1, 4.6], offset: -0.69}
"""


@pytest.mark.parametrize(
    "observations",
    [
        "run",
        "{bag: run}",
        "run/run.mcap",
        "{bag: run, joints: /joint_states, range: /ranger}",
        "{bag: run, joints: [/joint_states]}",
    ],
)
def test_a_campaign_takes_a_bag_for_its_observations(folder, observations):
    script, at = bags.run(6)
    script.write(folder.path / "run")
    campaign = folder.write(campaign=f"{CAMPAIGN}observations: {observations}\n").load()
    np.testing.assert_allclose(campaign.readings.joints, at, atol=1e-5)
    np.testing.assert_allclose(campaign.readings.values[:, 0], distance(at), atol=2e-4)
    assert 2e-5 < np.median(campaign.readings.std) < 5e-5
    assert campaign.readings.line.tolist() == [3, 4, 5, 6, 7, 8]
    assert any("6 of 6 still phases gave a row each" in note for note in campaign.notes)
    assert len(campaign.inputs) == 3


def test_a_bag_is_in_metres_and_radians_whatever_the_campaigns_units(folder):
    script, at = bags.run(6)
    script.write(folder.path / "run")
    units = "units: {length: mm, angle: deg}\n"
    text = CAMPAIGN.replace("noise_std: 0.0002", "noise_std: 0.2").replace("offset: -0.69", "offset: -690")
    campaign = folder.write(campaign=f"{units}{text}observations: run\n").load()
    np.testing.assert_allclose(campaign.readings.joints, at, atol=1e-5)
    np.testing.assert_allclose(campaign.readings.values[:, 0], distance(at), atol=2e-4)
    assert not [warning for warning in campaign.warnings if "degrees" in warning]


def test_readings_that_scatter_otherwise_than_stated_are_worth_a_warning(folder):
    bags.run(6, noise=2e-3)[0].write(folder.path / "run")
    (warning,) = folder.write(campaign=f"{CAMPAIGN}observations: run\n").load().warnings
    assert warning.startswith("run: one reading scatters by ")
    assert "where noise_std says 0.200 mm" in warning


def test_losses_of_a_bag_are_warnings_of_the_campaign(folder):
    path = bags.run(6)[0].write(folder.path / "run")
    (path / "metadata.yaml").unlink()
    (warning,) = folder.write(campaign=f"{CAMPAIGN}observations: run\n").load().warnings
    assert warning.startswith("run: there is no metadata.yaml")


@pytest.mark.parametrize(
    ("observations", "told"),
    [
        ("{bag: run, rnge: /ranger}", "observations.rnge: unknown key (did you mean range?)"),
        ("{range: /ranger}", "expected the name of a file, or a block with a bag: {bag: run1, range: /ranger}"),
        ("{bag: run, range: /rangr}", "observations: run: there is no topic '/rangr' (did you mean /ranger?)"),
        ("{bag: run, joints: 3}", "observations.joints: got 3; expected the name of a topic, or a list of such names"),
        ("{bag: run, still_time: 0}", "observations.still_time: got 0; expected a number above 0"),
        ("{bag: other}", "observations: other: there is no such file or folder; expected a rosbag2 folder"),
        ("3", "expected the name of a CSV file or of a ROS bag"),
    ],
)
def test_what_is_wrong_with_a_bags_block_is_told_with_its_line(folder, observations, told):
    bags.run(3)[0].write(folder.path / "run")
    problems = folder.write(campaign=f"{CAMPAIGN}observations: {observations}\n").problems()
    assert any(problem.startswith("campaign.yaml, line 5: ") and told in problem for problem in problems), problems


def test_a_target_that_the_campaign_lacks_is_told(folder):
    script, _ = bags.run(3)
    script.say(T0, "/target", bags.word("roof"))
    script.write(folder.path / "run")
    problem = folder.write(campaign=f"{CAMPAIGN}observations: run\n").problems()[0]
    assert "there is no target 'roof'" in problem


def test_a_range_frame_of_ros_as_a_mount():
    """The beam is x of a ROS frame turned by (r, p, y) in the last link's: rpy [0, p + pi/2, y] puts our z there."""
    from scipy.spatial.transform import Rotation

    from boresight.geometry import Frame

    rng = np.random.default_rng(0)
    for roll, pitch, yaw in rng.uniform(-np.pi, np.pi, (50, 3)):
        beam = Rotation.from_euler("xyz", [roll, pitch, yaw]).as_matrix()[:, 0]
        mount = Frame((0.0, 0.0, 0.0), (0.0, pitch + np.pi / 2, yaw))
        np.testing.assert_allclose(mount.matrix[:3, 2], beam, atol=1e-12)


def test_validation_may_be_a_bag_too(folder):
    bags.run(6)[0].write(folder.path / "run")
    folder.write(campaign=f"{CAMPAIGN}observations: run\nvalidation: run\n")
    campaign = load_campaign("campaign.yaml")
    assert len(campaign.validation) == 6
    assert any("they prove nothing" in warning for warning in campaign.warnings)


@pytest.mark.parametrize("low", [-math.pi, 0.0])
def test_pauses_at_the_seam_of_a_joint_that_wraps_give_rows(recorded, low):
    script, at = bags.run(6)
    shift = low - at[2, 0]
    for _, topic, message in script.messages:
        if topic == "/joint_states":
            message.position[0] = low + (message.position[0] + shift - low) % (2 * math.pi)
    found = recorded(script)
    off = found.rows.joints - (at + np.array([shift, 0.0]))
    assert np.abs((off + math.pi) % (2 * math.pi) - math.pi).max() < 1e-4
    assert "Readings that start again after a full turn were made continuous: j1." in found.remarks
