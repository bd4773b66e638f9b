"""Campaigns of draw-wires, poses, contacts, markers, several sensors and sessions, and what can be wrong with them."""

import numpy as np
import pytest

from boresight.geometry import Plane, Point, quaternion_matrix
from boresight.sensing import Aim, DrawWire, PlaneContact, PointContact, Pose

WIRE = """\
robot: robot.yaml
units: {length: mm, angle: deg}
sensor: {type: draw_wire, noise_std: 0.2}
targets:
  post: {type: point, position: [1000, 0, 500]}
  hook: {type: point, position: unknown}
observations: observations.csv
"""

POSE = """\
robot: robot.yaml
units: {length: mm, angle: deg}
sensor: {type: pose, noise_std: 0.2, noise_angle_std: 0.1, repeats: 4}
observations: observations.csv
"""

MIXED = """\
robot: robot.yaml
sensors:
  ranger: {type: laser_ranger, noise_std: 0.0002, markers: [beam]}
  tracker: {type: position, noise_std: 0.0001, markers: [left, right]}
markers: {beam: {}, left: {xyz: unknown}, right: {xyz: [0, 0.1, 0]}}
targets:
  deck: {type: plane, normal: [0, 0, 1], offset: -0.2}
  post: {type: point, position: [1, 0, 0]}
observations: observations.csv
"""

MIXED_ROWS = """\
j1,j2,range,x,y,z,sensor,marker
0.1,0.2,0.5,,,,ranger,
0.1,0.2,,1,2,3,tracker,right
0.3,0.2,,4,5,6,tracker,left
"""


def test_draw_wire_is_read_with_its_points(folder):
    campaign = folder.write(campaign=WIRE, observations="j1,j2,distance,target\n10,20,1500,hook\n").load()
    assert campaign.cell.sensor == DrawWire(0.2 * 1e-3)
    assert campaign.cell.targets["post"] == Point((1.0, 0.0, 0.5))
    assert campaign.unknown == {"hook.x", "hook.y", "hook.z"}
    assert campaign.readings.values.tolist() == [[1.5]]
    assert campaign.cell.aims[campaign.readings.target[0]] == Aim("sensor", "mount", "hook")


def test_draw_wire_without_a_point_is_refused(folder, campaign_with):
    text = campaign_with(("type: laser_ranger", "type: draw_wire"))
    assert folder.write(campaign=text).problem() == (
        "campaign.yaml, line 2: sensor: a draw_wire is drawn to a point and there is none; "
        "expected targets: {anchor: {type: point, position: [1, 0, 0]}}"
    )


def test_point_target_says_what_it_lacks(folder):
    text = WIRE.replace("position: unknown", "postion: [1, 2, 3]")
    missing, unknown = sorted(folder.write(campaign=text).problems())
    assert (
        missing
        == "campaign.yaml, line 6: targets.hook.position: this key is missing; expected a list of 3 numbers, or unknown"
    )
    assert unknown.startswith("campaign.yaml, line 6: targets.hook.postion: unknown key (did you mean position?)")


def test_target_may_be_called_after_its_kind(folder):
    text = WIRE.replace("post:", "point:").replace("position: [1000, 0, 500]", "position: [1000, 0]")
    assert folder.write(campaign=text).problem() == (
        "campaign.yaml, line 5: targets.point.position: got [1000, 0]; expected a list of 3 finite numbers, or unknown"
    )


def test_pose_is_read_with_its_orientation_whatever_the_sign(folder):
    half = np.sqrt(0.5)
    rows = f"1,2,10,20,30,{half},0,0,{half}\n1,3,10,20,30,{-half},0,0,{-half}\n"
    campaign = folder.write(campaign=POSE, observations="j1,j2,x,y,z,qw,qx,qy,qz\n" + rows).load()
    readings = campaign.readings
    assert campaign.cell.sensor == Pose(0.2 * 1e-3, 0.1 * (np.pi / 180.0), 4)
    np.testing.assert_allclose(readings.values, np.tile([0.01, 0.02, 0.03, 0, 0, 0], (2, 1)))
    np.testing.assert_allclose(
        readings.reference, np.tile(quaternion_matrix(np.array([1.0, 0, 0, 1])), (2, 1, 1)), atol=1e-15
    )
    np.testing.assert_allclose(readings.std, 1e-4)


def test_std_angle_is_the_orientations_own(folder):
    rows = "j1,j2,x,y,z,qw,qx,qy,qz,std,std_angle\n1,2,10,20,30,1,0,0,0,0.4,0.3\n"
    readings = folder.write(campaign=POSE, observations=rows).load().readings
    np.testing.assert_allclose(readings.std, [[4e-4] * 3 + [6e-4] * 3])


def test_quaternion_that_is_none_is_refused(folder):
    rows = "j1,j2,x,y,z,qw,qx,qy,qz\n1,2,10,20,30,1,0,0,0\n1,2,10,20,30,30,40,50,1\n"
    told = folder.write(campaign=POSE, observations=rows).problem()
    assert told.startswith(
        "observations.csv, line 3: the quaternion qw, qx, qy, qz has length 70.7177; expected 1: w first"
    )


@pytest.mark.parametrize(
    ("sensor", "told"),
    [
        ("type: pose, noise_std: 1", "expected noise_angle_std beside noise_std"),
        (
            "type: position, noise_std: 1, noise_angle_std: 1",
            "expected no noise_angle_std, as a position reads no orientation",
        ),
        ("type: position, noise_std: 1, offset_per: session", "expected no offset_per, as a position has no offset"),
        ("type: laser_ranger, noise_std: 1, markers: [tip]", "there is no marker 'tip'; there are no markers"),
    ],
)
def test_keys_that_do_not_fit_the_sensor_are_refused(folder, campaign_with, sensor, told):
    text = campaign_with(("type: laser_ranger, noise_std: 0.0002, repeats: 4", sensor))
    assert told in folder.write(campaign=text).problem()


def test_contact_needs_no_column_but_the_joints(folder, campaign_with):
    text = campaign_with(("laser_ranger", "plane_contact"))
    campaign = folder.write(campaign=text, observations="j1,j2\n0.1,0.2\n0.3,0.4\n").load(need_readings=True)
    assert campaign.cell.sensor == PlaneContact(2e-4, 4)
    assert campaign.readings.measured
    assert campaign.readings.values.tolist() == [[0.0], [0.0]]


def test_several_sensors_are_told_apart_row_by_row(folder):
    campaign = folder.write(campaign=MIXED, observations=MIXED_ROWS).load()
    readings, aims = campaign.readings, campaign.cell.aims
    assert [aims[place] for place in readings.target] == [
        Aim("ranger", "beam", "deck"),
        Aim("tracker", "right", None),
        Aim("tracker", "left", None),
    ]
    assert readings.values.tolist() == [[0.5, 0, 0], [1, 2, 3], [4, 5, 6]]
    assert readings.channels.tolist() == [1, 3, 3]
    assert campaign.unknown == {"left.x", "left.y", "left.z"}
    assert isinstance(campaign.cell.targets["deck"], Plane)


@pytest.mark.parametrize(
    ("row", "told"),
    [
        ("0.1,0.2,0.5,1,,,ranger,", "line 2: x: sensor ranger does not read it; expected an empty cell"),
        (
            "0.1,0.2,0.5,,,,rangr,",
            "line 2: there is no sensor 'rangr' (did you mean ranger?); the sensors are ranger, tracker",
        ),
        (
            "0.1,0.2,,1,2,3,tracker,beam",
            "line 2: there is no marker 'beam' for sensor tracker; the markers are left, right",
        ),
        ("0.1,0.2,,1,2,3,tracker,", "none of its 1 rows can be used; the first, on line 2: marker is empty"),
        ("0.1,0.2,,1,,3,tracker,left", "none of its 1 rows can be used; the first, on line 2: y is empty"),
        (
            "0.1,0.2,-1,,,,ranger,",
            "none of its 1 rows can be used; the first, on line 2: range is -1, and a range is above 0",
        ),
    ],
)
def test_rows_that_fit_no_sensor_are_explained(folder, row, told):
    header = MIXED_ROWS.splitlines()[0]
    assert told in folder.write(campaign=MIXED, observations=f"{header}\n{row}\n").problem()


@pytest.mark.parametrize("column", ["sensor", "marker"])
def test_column_that_tells_sensors_or_markers_apart_is_needed(folder, column):
    text = MIXED_ROWS.replace(f",{column}", "", 1)
    assert (
        f"line 1: there is no column {column}; expected one, to tell which of"
        in folder.write(campaign=MIXED, observations=text).problems()[0]
    )


def test_names_that_two_things_have_are_refused(folder):
    text = MIXED.replace("left", "deck").replace("ranger:", "j1:")
    taken = "campaign.yaml, line 5: markers.deck: a target is called deck too; expected another name"
    joint = "campaign.yaml, line 3: sensors.j1: a joint is called j1 too; expected another name"
    assert {taken, joint} <= set(folder.write(campaign=text).problems())


def test_one_sensor_and_several_cannot_be_named_together(folder, campaign_with):
    text = campaign_with(("targets:", "sensors: {other: {type: position, noise_std: 1}}\ntargets:"))
    assert "expected either sensor, or sensors by name" in folder.write(campaign=text).problem()


SESSIONS = "j1,j2,distance,target,session\n10,20,1500,hook,mon\n10,30,1400,post,tue\n"


def test_each_session_has_an_offset_where_asked(folder):
    text = WIRE.replace("noise_std: 0.2", "noise_std: 0.2, offset_per: session")
    campaign = folder.write(campaign=text, observations=SESSIONS).load()
    assert campaign.cell.offsets == {"sensor.bias[mon]": 0.0, "sensor.bias[tue]": 0.0}
    assert {"sensor.bias[mon]", "sensor.bias[tue]"} <= campaign.unknown
    aims = [campaign.cell.aims[place] for place in campaign.readings.target]
    assert aims == [Aim("sensor", "mount", "hook", "mon"), Aim("sensor", "mount", "post", "tue")]


def test_session_that_nothing_is_known_of_cannot_validate(folder):
    text = WIRE.replace("noise_std: 0.2", "noise_std: 0.2, offset_per: session") + "validation: v.csv\n"
    folder.write(campaign=text, observations=SESSIONS, **{"v.csv": SESSIONS.replace("tue", "wed")})
    assert folder.problem() == ("v.csv, line 3: session: no row of 'wed' is calibrated with; expected one of mon, tue")


def test_sessions_need_their_column(folder):
    text = WIRE.replace("noise_std: 0.2", "noise_std: 0.2, offset_per: session")
    rows = SESSIONS.replace(",session", "").replace(",mon", "").replace(",tue", "")
    told = folder.write(campaign=text, observations=rows).problem()
    assert told.startswith("observations.csv: there is no column session; expected one, as `offset_per: session`")


def test_sessions_are_kept_where_nobody_asked(folder):
    campaign = folder.write(campaign=WIRE, observations=SESSIONS).load()
    assert campaign.cell.offsets == {}
    assert campaign.readings.session.tolist() == ["mon", "tue"]


def test_positions_are_joined_in_pairs_where_distances_count(folder, campaign_with):
    text = campaign_with(("laser_ranger", "distances"))
    rows = "j1,j2,x,y,z\n0.1,0,0,0,0\n0.2,0,1,0,0\n0.3,0,3,4,0\n0.4,0,1,0,2\n0.5,0,9,9,9\n"
    campaign = folder.write(campaign=text, observations=rows).load()
    readings = campaign.readings
    assert readings.values.tolist() == [[5.0], [2.0]]
    assert readings.line.tolist() == [2, 3]
    assert readings.joints[:, 0].tolist() == [0.1, 0.2]
    assert readings.since[:, 0].tolist() == [0.3, 0.4]
    np.testing.assert_allclose(readings.std, 0.0002 / np.sqrt(4) * np.sqrt(2))
    (aside,) = campaign.set_aside
    assert (aside.line, aside.reason) == (6, "no position of its block is left to which its distance could be told")


CONTACT = """\
robot: robot.yaml
units: {length: mm, angle: deg}
sensor: {type: point_contact, noise_std: 0.1}
targets:
  cone: {type: point, position: [300, 0, 100]}
  cup: {type: point, position: unknown}
observations: observations.csv
"""


def test_contacts_with_points_have_no_columns_of_their_own(folder):
    campaign = folder.write(campaign=CONTACT, observations="j1,j2,target\n10,20,cup\n30,20,cone\n").load()
    assert campaign.cell.sensor == PointContact(0.1 * 1e-3)
    assert campaign.unknown == {"cup.x", "cup.y", "cup.z"}
    assert campaign.readings.values.tolist() == [[0.0, 0.0, 0.0]] * 2
    assert campaign.readings.std == pytest.approx(np.full((2, 3), 1e-4))
    assert [campaign.cell.aims[place].target for place in campaign.readings.target] == ["cup", "cone"]


def test_a_contact_with_a_point_needs_one(folder, campaign_with):
    assert folder.write(campaign=campaign_with(("laser_ranger", "point_contact"))).problem() == (
        "campaign.yaml, line 2: sensor: a point_contact touches a point and there is none; "
        "expected targets: {anchor: {type: point, position: [1, 0, 0]}}"
    )


def test_a_contact_has_no_zero_and_no_unit_of_length(folder):
    text = CONTACT.replace("noise_std: 0.1", "noise_std: 0.1, bias_std: 0.1")
    assert "expected no bias_std, as a point_contact has no bias" in folder.write(campaign=text).problem()
