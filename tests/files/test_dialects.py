"""FIGAROH's CSV and Leica's export, read as they are."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from boresight.arm import Arm, Joint
from boresight.errors import InputError
from boresight.files import read_observations
from boresight.files.dialects import in_house_words
from boresight.files.joint_logs import paired
from boresight.files.sheets import csv_text, sheet_of
from boresight.files.sources import Source
from boresight.geometry import Frame
from boresight.sensing import Cell, Position
from boresight.units import Units

CELL = Cell(
    Arm("two", (Joint("shoulder_pan_joint", "revolute", d=0.3), Joint("elbow_joint", "revolute", a=0.4))),
    Position(1e-4),
    Frame(),
    Frame(),
    {},
)
FIGAROH = """\
x1,y1,z1,phix1,phiy1,phiz1,shoulder_pan_joint,elbow_joint,session_id
0.1,0.2,0.3,0.4,-0.5,0.6,1.1,1.2,monday

0.4,0.5,0.6,0.1,0.2,0.3,1.3,1.4,tuesday
"""
LEICA = """\
Point,X [mm],Y [mm],Z [mm],U(95) [mm],U(95)X [mm],Q0,Q1,Q2,Q3,Temperature [C],Humidity [%],Time Stamp
P1,100.5,200,300,0.02,0.01,1,0,0,0,21.5,40,2024-05-01 12:00:00.500
P2,400,500,600,0.03,0.01,1,0,0,0,21.5,40,2024-05-01 12:00:02
"""


def sheet(text, name="measured.csv"):
    return sheet_of(Source(None, name, text.encode()))


@pytest.fixture
def read(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def read(text, units=None):
        (tmp_path / "measured.csv").write_text(text)
        return read_observations("measured.csv", cell=CELL, units=units or Units())

    return read


def table(ours):
    header, *rows = [cells for _, cells in ours.rows]
    return {name: [row[k] for row in rows] for k, name in enumerate(header)}


def test_figarohs_file_is_read_where_observations_are(read):
    found = read(FIGAROH)
    np.testing.assert_array_equal(found.readings.values, [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]])
    np.testing.assert_array_equal(found.readings.joints, [[1.1, 1.2], [1.3, 1.4]])
    assert found.readings.line.tolist() == [2, 4]
    assert found.notes == ("measured.csv: The file is FIGAROH's.",)


def test_figarohs_angles_are_roll_pitch_and_yaw_about_fixed_axes():
    ours, _ = in_house_words(sheet(FIGAROH), CELL.arm.joints, Units())
    columns = table(ours)
    ours_xyzw = np.array([[float(columns[q][k]) for q in ("qx", "qy", "qz", "qw")] for k in range(2)])
    theirs = Rotation.from_euler("xyz", [[0.4, -0.5, 0.6], [0.1, 0.2, 0.3]])  # lower case: fixed axes
    np.testing.assert_allclose((Rotation.from_quat(ours_xyzw).inv() * theirs).magnitude(), 0.0, atol=1e-14)
    assert columns["session"] == ["monday", "tuesday"]


def test_figarohs_file_is_in_metres_and_radians_whatever_the_campaigns_units(read):
    found = read(FIGAROH, Units("mm", "deg"))
    np.testing.assert_allclose(found.readings.values, [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]], rtol=1e-14)
    np.testing.assert_allclose(found.readings.joints, [[1.1, 1.2], [1.3, 1.4]], rtol=1e-14)


def test_one_of_several_markers_is_chosen():
    text = "x1,y1,z1,x2,y2,z2,shoulder_pan_joint,elbow_joint\n1,2,3,4,5,6,0,0\n"
    with pytest.raises(InputError) as caught:
        in_house_words(sheet(text), CELL.arm.joints, Units())
    assert str(caught.value) == (
        "measured.csv: the file holds the markers 1, 2; choose one: boresight import FILE --marker 1"
    )
    ours, translation = in_house_words(sheet(text), CELL.arm.joints, Units(), marker=2)
    assert table(ours)["x"] == ["4"]
    assert translation.left_out == ["x1", "y1", "z1"]
    with pytest.raises(InputError, match="there is no marker 3; the file holds 1, 2"):
        in_house_words(sheet(text), CELL.arm.joints, Units(), marker=3)


def test_what_is_wrong_with_a_row_is_told_of_the_users_line(read):
    with pytest.raises(InputError) as caught:
        read(FIGAROH.replace("0.4,0.5,0.6", "0.4,O.5,0.6"))
    assert str(caught.value).startswith("measured.csv, line 4: y: got 'O.5'; expected a number")
    with pytest.raises(InputError) as caught:
        read(FIGAROH.replace(",tuesday", ""))
    assert str(caught.value) == "measured.csv, line 4: 8 cells; expected 9, as in the header"


def test_a_coordinate_that_was_not_measured_is_told(read):
    with pytest.raises(InputError, match="there is no column for y"):
        read("x1,z1,shoulder_pan_joint,elbow_joint\n1,2,0,0\n")


def test_joints_that_look_like_markers_are_joints(tmp_path):
    arm = Arm("axes", (Joint("x1", "prismatic", limits=(0.0, 1.0)), Joint("y1", "prismatic", limits=(0.0, 1.0))))
    text = "x1,y1,x,y,z\n0.1,0.2,0.3,0.4,0.5\n"
    ours, translation = in_house_words(sheet(text), arm.joints, Units())
    assert translation is None
    assert csv_text(ours.rows) == text


def test_leicas_export_with_joints_beside_is_read_where_observations_are(read):
    lines = LEICA.splitlines()
    text = "\n".join([f"{lines[0]},shoulder_pan_joint,elbow_joint", f"{lines[1]},0.1,0.2", f"{lines[2]},0.3,0.4"])
    found = read(text)
    np.testing.assert_allclose(found.readings.values, [[0.1005, 0.2, 0.3], [0.4, 0.5, 0.6]], rtol=1e-14)
    np.testing.assert_allclose(found.readings.std, [[1e-5] * 3, [1.5e-5] * 3], rtol=1e-12)
    np.testing.assert_allclose(found.readings.joints, [[0.1, 0.2], [0.3, 0.4]])
    assert found.notes == (
        "measured.csv: The file is Leica's; columns without a meaning here: Point, U(95)X [mm], Humidity [%].",
    )


def test_leicas_numbers_have_their_own_unit_whatever_the_campaigns(read):
    lines = LEICA.splitlines()
    text = "\n".join([f"{lines[0]},shoulder_pan_joint,elbow_joint", f"{lines[1]},1,2", f"{lines[2]},3,4"])
    found = read(text, Units("mm", "rad"))
    np.testing.assert_allclose(found.readings.values, [[0.1005, 0.2, 0.3], [0.4, 0.5, 0.6]], rtol=1e-14)


def test_a_leica_export_alone_has_no_joints(read):
    with pytest.raises(InputError, match="there is no column for joint shoulder_pan_joint"):
        read(LEICA)


def leica():
    return in_house_words(sheet(LEICA), (), Units())[0]


def test_joints_of_another_file_are_paired_row_by_row():
    found = paired(leica(), sheet("a,b\n0.1,0.2\n0.3,0.4\n", "joints.csv"))
    columns = table(found.sheet)
    assert (columns["a"], columns["b"]) == (["0.1", "0.3"], ["0.2", "0.4"])
    assert [float(x) for x in columns["x"]] == pytest.approx([0.1005, 0.4])
    assert (found.left_out, found.by_time) == ((), False)


def test_joints_of_another_file_are_paired_by_time():
    """The log is in seconds since 1970, the tracker writes dates: 12:00:00.5 on 2024-05-01 is 1714564800.5."""
    log = "time,a\n" + "".join(f"{1714564800.0 + 0.1 * k!r},{0.5 * k}\n" for k in range(15))
    found = paired(leica(), sheet(log, "joints.csv"))
    assert table(found.sheet)["a"] == ["2.5"]
    assert (found.left_out, found.by_time) == ((3,), True)


def test_rows_that_do_not_match_are_told():
    with pytest.raises(InputError) as caught:
        paired(leica(), sheet("a\n0.1\n", "joints.csv"))
    assert str(caught.value) == (
        "joints.csv: 1 rows for 2 measurements of measured.csv; expected a row each, or a column time in both files"
    )


def test_times_that_are_none_are_told():
    with pytest.raises(InputError, match=r"joints\.csv, line 3: got the time 'noon'; expected seconds or 2024-05-01"):
        paired(leica(), sheet("time,a\n1,2\nnoon,2\n", "joints.csv"))


def test_joints_that_are_not_known_at_any_time_are_told():
    with pytest.raises(InputError, match="the joints are not known at any of the times"):
        paired(leica(), sheet("time,a\n1,2\n2,2\n", "joints.csv"))


def test_a_joint_that_the_file_lacks_is_told():
    with pytest.raises(InputError, match="there is no column for joint c; the columns are 'a', 'b'"):
        paired(leica(), sheet("a,b\n0.1,0.2\n0.3,0.4\n", "joints.csv"), ["a", "c"])
