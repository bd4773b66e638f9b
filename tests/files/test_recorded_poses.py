"""Poses out of bags: every standard message that holds one, either sign of a quaternion, frames of tf."""

import io

import numpy as np
import pytest

import ros_bags as bags
from boresight.errors import InputError
from boresight.files import load_campaign
from boresight.files.recorded import read_recorded, rows_csv
from boresight.files.topics import Choice
from ros_bags import T0, Script

ROBOT = "name: two\njoints:\n  - {name: j1, d: 0.3, alpha: 1.5707963267948966}\n  - {name: j2, a: 0.4}\n"
CAMPAIGN = """robot: robot.yaml
sensor: SENSOR
base: {xyz: unknown, rpy: unknown}
mount: {xyz: unknown}
observations: DATA
"""
POSE = "{type: pose, noise_std: 0.0001, noise_angle_std: 0.0005}"
POSITION = "{type: position, noise_std: 0.0001}"
STD, STD_ANGLE = 1e-4, 5e-4


def where(joints):
    """The position of the tool and its quaternion, w first; both depend on every joint."""
    a, b = joints
    at = np.array([np.cos(a), np.sin(a), np.cos(b)])
    half = np.array([0.3, a / 2.0, b / 2.0])
    size = np.linalg.norm(half)
    return at, np.array([np.cos(size), *(np.sin(size) * half / size)])


def product(p, q):
    w, v, s, u = p[0], p[1:], q[0], q[1:]
    return np.array([w * s - v @ u, *(w * u + s * v + np.cross(v, u))])


def run(message, topic="/tracker/pose", count=8):
    rng = np.random.default_rng(3)
    at = bags.stops(count)
    time, joints = bags.motion(at)
    script = Script()
    for k, (t, q) in enumerate(zip(time, joints, strict=True)):
        script.say(T0 + t, "/joint_states", bags.joint_state(T0 + t, bags.NAMES, q + rng.normal(0.0, 1e-5, 2)))
        if k % 3 == 0:
            xyz, turned = where(q)
            noisy = product(turned, np.array([1.0, *(rng.normal(0.0, STD_ANGLE, 3) / 2.0)]))
            sign = 1.0 if k % 2 else -1.0
            made = message(T0 + t, xyz + rng.normal(0.0, STD, 3), sign * noisy)
            script.say(T0 + t, topic, made)
    return script, at


@pytest.fixture
def recorded(tmp_path):
    def recorded(script, joint_names=None, kind=None, **choice):
        return read_recorded(script.write(tmp_path / "run"), "run", Choice(**choice), joint_names, kind)

    return recorded


def table(found):
    return np.genfromtxt(io.StringIO(rows_csv(found)), delimiter=",", names=True, skip_header=1)


@pytest.mark.parametrize("message", [bags.pose, bags.pose_with_covariance, bags.transform])
def test_every_message_that_holds_a_pose_is_read(recorded, message):
    script, at = run(message)
    found = table(recorded(script))
    for row, joints in zip(found, at, strict=True):
        xyz, turned = where(joints)
        np.testing.assert_allclose([row["x"], row["y"], row["z"]], xyz, atol=1e-4)
        quaternion = np.array([row["qw"], row["qx"], row["qy"], row["qz"]])
        assert abs(quaternion @ turned) == pytest.approx(1.0, abs=1e-7)
    repeats = np.sqrt(found["repeats"])
    assert np.median(found["std_x"] * repeats) == pytest.approx(STD, rel=0.25)
    assert np.median(found["std_angle"] * repeats) == pytest.approx(STD_ANGLE, rel=0.25)


def test_positions_alone_are_read_of_poses(recorded):
    script, at = run(bags.pose)
    found = recorded(script, position="/tracker/pose")
    assert found.channels == ("x", "y", "z")
    np.testing.assert_allclose(found.rows.values, [where(joints)[0] for joints in at], atol=1e-4)


def test_a_frame_of_tf_is_read_where_it_is_named(recorded):
    def both(stamp, xyz, turned):
        other = bags.transform(stamp, (1.0, 2.0, 3.0), (1.0, 0.0, 0.0, 0.0), "elbow")
        return bags.transforms(other, bags.transform(stamp, xyz, turned, "target"))

    script, at = run(both, "/tf")
    found = recorded(script, pose="/tf:target")
    np.testing.assert_allclose(found.rows.values[:, :3], [where(joints)[0] for joints in at], atol=1e-4)


@pytest.mark.parametrize(
    ("choice", "told"),
    [
        ({"pose": "/tf"}, "pose: /tf holds the frames /tf:elbow, /tf:target; name one of them: pose: /tf:elbow"),
        ({"pose": "/tf:tooll"}, "there is no topic '/tf:tooll'"),
        ({}, "there is no topic with messages of sensor_msgs/msg/Range"),
    ],
)
def test_a_topic_of_tf_is_never_read_unnamed(recorded, choice, told):
    def both(stamp, xyz, turned):
        return bags.transforms(*(bags.transform(stamp, xyz, turned, frame) for frame in ("elbow", "target")))

    with pytest.raises(InputError) as caught:
        recorded(run(both, "/tf")[0], **choice)
    assert told in str(caught.value)


def test_readings_without_an_orientation_are_set_aside(recorded):
    script, _ = run(bags.pose)
    poses = [message for _, topic, message in script.messages if topic == "/tracker/pose"]
    for message in poses[:5]:
        for axis in "wxyz":
            setattr(message.pose.orientation, axis, 0.0)
    poses[6].pose.position.x = np.nan
    assert recorded(script).empty == {"no value": 1, "no unit quaternion": 5}


@pytest.fixture
def campaign(tmp_path):
    def campaign(script, sensor, data="run"):
        script.write(tmp_path / "run")
        (tmp_path / "robot.yaml").write_text(ROBOT)
        (tmp_path / "campaign.yaml").write_text(CAMPAIGN.replace("SENSOR", sensor).replace("DATA", data))
        return load_campaign(tmp_path / "campaign.yaml")

    return campaign


@pytest.mark.parametrize("sensor", [POSE, POSITION])
@pytest.mark.parametrize("data", ["run", "{bag: run, KIND: /tracker/pose}"])
def test_a_campaign_reads_poses_for_either_sensor(campaign, sensor, data):
    kind = "pose" if sensor is POSE else "position"
    found = campaign(run(bags.pose)[0], sensor, data.replace("KIND", kind))
    assert len(found.readings) == 8
    assert found.warnings == ()
    assert (found.readings.reference is not None) == (sensor is POSE)


def test_a_tracker_that_reports_no_orientation_is_told(campaign):
    script, _ = run(lambda stamp, xyz, turned: bags.pose(stamp, xyz, (1.0, 0.0, 0.0, 0.0)))
    (warning,) = campaign(script, POSE).warnings
    assert warning.startswith("run: every pose has the same orientation though the joints move")


def test_import_for_positions_keeps_the_columns_of_a_pose(campaign, recorded, tmp_path):
    script, _ = run(bags.pose)
    (tmp_path / "run.csv").write_text(rows_csv(recorded(script)))
    (tmp_path / "run").rename(tmp_path / "old")
    assert len(campaign(script, POSITION, "run.csv").readings) == 8


def test_ranges_are_read_for_a_draw_wire(tmp_path):
    bags.run(6)[0].write(tmp_path / "run")
    (tmp_path / "robot.yaml").write_text(ROBOT)
    (tmp_path / "campaign.yaml").write_text(
        "robot: robot.yaml\nsensor: {type: draw_wire, noise_std: 0.0002}\n"
        "targets: {hook: {type: point, position: [1, 0, 0]}}\nobservations: run\n"
    )
    assert len(load_campaign(tmp_path / "campaign.yaml").readings) == 6


def test_several_markers_are_told_how_to_go_on(tmp_path):
    bags.run(6)[0].write(tmp_path / "run")
    (tmp_path / "robot.yaml").write_text(ROBOT)
    (tmp_path / "campaign.yaml").write_text(
        f"robot: robot.yaml\nsensor: {POSITION}\nmarkers: {{a: {{}}, b: {{xyz: [0, 0, 0.1]}}}}\nobservations: run\n"
    )
    with pytest.raises(InputError, match=r"has 2 markers \(a, b\); make a CSV file of each .* in a column marker"):
        load_campaign(tmp_path / "campaign.yaml")
