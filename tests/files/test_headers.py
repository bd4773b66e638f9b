"""Tables as spreadsheets write them: separators, decimal commas, empty ends, and column names of another form."""

import numpy as np
import pytest

from boresight.files.headers import Column, read_header
from boresight.units import Units

KNOWN = {"j1": "angle", "slide": "length", "range": "length", "target": None, "time": None}
JOINTS = ("j1", "slide")


@pytest.mark.parametrize(
    ("text", "note"),
    [
        ("j1;j2;range\n0.1;0.2;0.3\n0.4;0.5;0.6\n", "columns are separated by semicolons."),
        ("j1\tj2\trange\n0.1\t0.2\t0.3\n0.4\t0.5\t0.6\n", "columns are separated by tabs."),
        (
            "j1;j2;range\n0,1;0,2;3e-1\n,4;0,5;6,0e-1\n",
            "columns are separated by semicolons; numbers have decimal commas.",
        ),
        ("j1,j2,range,,\n0.1,0.2,0.3,,\n0.4,0.5,0.6, ,\n", "empty columns at the end are left out."),
        ("j1,j2,range\n0.1,0.2,0.3,\n0.4,0.5,0.6\n", "empty columns at the end are left out."),
        (
            "J1,J2,Range\n0.1,0.2,0.3\n0.4,0.5,0.6\n",
            "columns are read as the names that are known: J1 as j1, J2 as j2, Range as range.",
        ),
        (
            "j1 [rad],j2 (deg),range_mm\n0.1,11.459155902616464,300\n0.4,28.64788975654116,600\n",
            "columns are read as the names that are known: j1 [rad] as j1 in rad, j2 (deg) as j2 in deg, range_mm as "
            "range in mm.",
        ),
        (
            "q1,q2,range\n0.1,0.2,0.3\n0.4,0.5,0.6\n",
            "columns are read as the names that are known: q1 as j1, q2 as j2.",
        ),
        (
            "axis_0 [deg],axis_1 [rad],range\n5.729577951308232,0.2,0.3\n22.918311805232928,0.5,0.6\n",
            "columns are read as the names that are known: axis_0 [deg] as j1 in deg, axis_1 [rad] as j2 in rad.",
        ),
    ],
)
def test_what_is_unambiguous_is_read_and_said(read, text, note):
    campaign = read(text)
    np.testing.assert_allclose(campaign.readings.joints, [[0.1, 0.2], [0.4, 0.5]], rtol=1e-12)
    np.testing.assert_allclose(campaign.readings.values, [[0.3], [0.6]], rtol=1e-12)
    assert f"observations.csv: {note}" in campaign.notes


def test_a_file_as_it_should_be_is_said_nothing_of(read):
    assert read("j1,j2,range\n0.1,0.2,0.3\n0.4,0.5,0.6\n").notes == ()


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("j1;j2;range\n0,1;0.2;0,3\n", "numbers such as '0,1' and such as '0.2'; expected decimal points throughout"),
        ("j1,j2,range,\n0.1,0.2,0.3,4\n", "line 2: 4 cells; expected 3, as in the header"),
        ("q1,q3,range\n0.1,0.2,0.3\n", "unknown columns 'q1', 'q3'"),
        ("q1,q2,j1,w2,range\n0.1,0.2,0.3,0.4,0.5\n", "unknown columns 'q1', 'q2', 'w2'"),
        ("j1,J1,j2,range\n0.1,0.2,0.3,0.4\n", "unknown column 'J1'"),
        ("j1 [mm],j2,range\n0.1,0.2,0.3\n", "unknown column 'j1 [mm]'"),
        ("j1,j2,range\n1_0,0.2,0.3\n", "got '1_0'; expected a number"),
        ("j1,j2,range\n\u0661,0.2,0.3\n", "j1: got '\u0661'; expected a number"),
    ],
)
def test_what_could_mean_two_things_is_refused_in_a_sentence(problem, text, told):
    assert told in problem(text)


def test_rows_keep_their_lines_whatever_separates_them(problem):
    assert "observations.csv, line 4: 2 cells; expected 3" in problem("# from a logger\nj1;j2;range\n1;2;3\n1;2\n")


def test_a_time_is_known_by_its_usual_names():
    for name in ("t", "T", "timestamp", "Time [s]", "time"):
        assert read_header([name], KNOWN, JOINTS, Units())[0].name == "time"


def test_units_of_the_name_are_brought_to_those_of_the_file():
    header = ["J1 [deg]", "slide [mm]", "range"]
    columns = read_header(header, KNOWN, JOINTS, Units("mm", "deg"))
    assert [column.factor for column in columns] == [1.0, 1.0, 1.0]
    columns = read_header(header, KNOWN, JOINTS, Units("m", "rad"))
    assert [column.factor for column in columns] == pytest.approx([np.pi / 180, 1e-3, 1.0])


def test_numbers_stand_for_joints_only_where_no_joint_is_named():
    columns = read_header(["j1", "q1", "q2"], KNOWN, JOINTS, Units())
    assert columns[1:] == [Column("q1"), Column("q2")]
