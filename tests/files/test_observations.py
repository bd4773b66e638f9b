"""observations.csv: every row becomes a reading, is set aside with its reason, or stops the show."""

import math
import os

import numpy as np
import pytest

from boresight.errors import InputError
from boresight.files import observations

HEADER = "j1,j2,range\n"


@pytest.fixture
def two_targets(campaign_with):
    deck = "deck: {type: plane, normal: [0, 1, 4.6], offset: -0.69}"
    return campaign_with((deck, f"{deck}\n  wall: {{type: plane, normal: [1, 0, 0], offset: -2}}"))


def test_columns_may_come_in_any_order_with_comments_and_blank_lines(read):
    readings = read("# made by hand\n\ndistance , j2,session, j1\n1.5,2,a,3 # a good one\n\n1.25,2,b,4\n").readings
    assert readings.joints.tolist() == [[3.0, 2.0], [4.0, 2.0]]
    assert readings.values.tolist() == [[1.5], [1.25]]
    assert readings.line.tolist() == [4, 6]


def test_windows_line_ends_and_a_byte_order_mark_are_fine(read):
    assert read(b"\xef\xbb\xbfj1,j2,range\r\n1,2,3\r\n").readings.line.tolist() == [2]


def test_a_rows_own_std_is_taken_as_it_stands(read):
    assert read("j1,j2,range,std,repeats\n1,2,3,0.5,9\n").readings.std.tolist() == [[0.5]]


def test_noise_is_divided_by_the_root_of_the_repeats(read):
    assert read("j1,j2,range,repeats\n1,2,3,16\n").readings.std.tolist() == [[0.0002 / 4]]


def test_positions_have_three_values_and_their_own_stds(folder, campaign_with):
    text = campaign_with(("laser_ranger", "position"))
    columns = "j1,j2,x,y,z,qw,qx,qy,qz,std_x,std_y,std_z,temperature\n"
    folder.write(campaign=text, observations=columns + "1,2,-3,4,5,,,,,1e-3,2e-3,3e-3,warm\n")
    readings = folder.load().readings
    assert readings.values.tolist() == [[-3.0, 4.0, 5.0]]
    assert readings.std.tolist() == [[1e-3, 2e-3, 3e-3]]


@pytest.mark.parametrize(
    ("row", "reason"),
    [
        ("0.1,,0.3", "j2 is empty"),
        ("0.1,0.2,", "range is empty"),
        ("0.1,0.2,nan", "range is nan"),
        ("inf,0.2,0.3", "j1 is inf"),
        (",nan,", "j1 is empty; j2 is nan; range is empty"),
        ("0.1,0.2,0", "range is 0, and a range is above 0"),
        ("0.1,0.2,-3", "range is -3, and a range is above 0"),
    ],
)
def test_rows_that_cannot_be_used_are_set_aside_with_line_and_reason(read, row, reason):
    campaign = read(f"{HEADER}0.1,0.2,0.3\n{row}\n0.2,0.3,0.4\n")
    assert [(s.file, s.line, s.reason) for s in campaign.set_aside] == [("observations.csv", 3, reason)]
    assert campaign.readings.line.tolist() == [2, 4]


def test_an_empty_std_repeats_or_target_sets_its_row_aside(read):
    campaign = read("j1,j2,range,std,repeats,target\n1,2,3,1,1,deck\n1,2,3,,1,deck\n1,2,3,1,,deck\n1,2,3,1,1,\n")
    assert [s.reason for s in campaign.set_aside] == ["std is empty", "repeats is empty", "target is empty"]


def test_a_file_without_a_usable_row_is_an_error(problem):
    assert problem(f"{HEADER}nan,1,2\n1,,2\n") == (
        "observations.csv: none of its 2 rows can be used; the first, on line 2: j1 is nan"
    )


def test_cells_that_are_not_numbers_are_errors_all_at_once(problems):
    assert problems(f"{HEADER}abc,1,2\n1,1_0,3\n1,2\n1,2,3,4\n") == (
        "observations.csv, line 2: j1: got 'abc'; expected a number, or an empty cell where there is none",
        "observations.csv, line 3: j2: got '1_0'; expected a number, or an empty cell where there is none",
        "observations.csv, line 4: 2 cells; expected 3, as in the header",
        "observations.csv, line 5: 4 cells; expected 3, as in the header",
    )


def test_only_twenty_faults_are_listed(problems):
    told = problems(HEADER + "x,y,z\n" * 30)
    assert len(told) == 21
    assert told[-1] == "and 70 more"


def test_an_unknown_column_names_the_nearest_and_a_missing_joint_is_named(problems):
    (told,) = problems("j1,j3,range\n1,2,3\n")
    assert told.startswith(
        "observations.csv, line 1: unknown column 'j3' (did you mean j2?) and no column for joint j2; expected columns "
    )
    (told,) = problems("j1,range\n1,3\n")
    assert told == "observations.csv, line 1: there is no column for joint j2; the columns are 'j1', 'range'"


@pytest.mark.parametrize(
    ("header", "told"),
    [
        ("j1,j2,,range", "column 3 has no name; is there a comma too many?"),
        ("j1,j2,range,j1", "there are several columns 'j1'; expected one"),
        ("j1,j2,range,distance", "there are columns range and distance, which mean the same"),
        ("j1,j2,range,std,std_range", "there are columns std and std_range"),
        ("j1,j2,rang", "unknown column 'rang' (did you mean range?)"),
        ("j1,j2,range,targte", "unknown column 'targte' (did you mean target?)"),
    ],
)
def test_odd_headers_are_explained(problem, header, told):
    assert problem(header + "\n1,2,3,4\n").startswith(f"observations.csv, line 1: {told}")


def test_part_of_the_stds_is_not_enough(folder, campaign_with):
    folder.write(campaign=campaign_with(("laser_ranger", "position")), observations="j1,j2,x,y,z,std_x\n1,2,3,4,5,6\n")
    assert "there is no column std_y, std_z beside std_x; expected all" in folder.problem()


def test_a_joint_called_like_a_column_is_refused(folder, robot_with, campaign_with):
    folder.write(robot=robot_with(("j2", "std")), observations="j1,std,range\n1,2,3\n")
    assert "robot: joint std is called as a column of the readings is; call it something else" in folder.problem()


def test_several_targets_need_a_target_column(folder, two_targets):
    problem = folder.write(campaign=two_targets).problem()
    assert "there is no column target; expected one, to tell which of deck, wall a row is of" in problem


def test_a_row_names_its_target(folder, two_targets):
    folder.write(campaign=two_targets, observations="j1,j2,range,target\n1,2,3, wall\n1,2,4,deck\n")
    assert folder.load().readings.target.tolist() == [1, 0]


def test_a_target_that_does_not_exist_names_the_nearest_one(folder, two_targets):
    folder.write(campaign=two_targets, observations="j1,j2,range,target\n1,2,3,wal\n")
    assert folder.problem() == (
        "observations.csv, line 2: there is no target 'wal' (did you mean wall?); the targets are deck, wall"
    )


@pytest.mark.parametrize("std", ["0", "-1"])
def test_a_std_is_above_zero(problem, std):
    assert f"observations.csv, line 2: std: got {std}; expected a standard deviation" in problem(
        f"j1,j2,range,std\n1,2,3,{std}\n"
    )


@pytest.mark.parametrize("repeats", ["0", "-1", "2.5"])
def test_repeats_are_counted(problem, repeats):
    assert f"repeats: got {repeats}; expected a whole number from 1" in problem(
        f"j1,j2,range,repeats\n1,2,3,{repeats}\n"
    )


@pytest.mark.parametrize("text", ["", "\n\n", "# nothing\n"])
def test_an_empty_file_is_told_so(problem, text):
    assert problem(text).startswith("observations.csv: the file is empty")


def test_a_header_alone_is_told_so(problem):
    assert problem(HEADER) == "observations.csv: there is a header but no row of readings under it"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (b"j1\x00,j2", "binary or UTF-16"),
        (b"PK\x03\x04\x00\x00", "a ZIP archive"),
        ("j1,j2,range\n1,2,3\n".encode("utf-16"), "text in UTF-16"),
    ],
)
def test_binary_files_are_refused(problem, text, told):
    assert told in problem(text)


def test_text_that_is_not_utf_8_is_refused(problem):
    assert "not UTF-8 text" in problem(b"j1,j2,range\n1,2,\xff\n")


@pytest.mark.parametrize("text", ['j1,j2,range\n"1,2,3\n', 'j1,j2,range\n"1"x,2,3\n', "j1,j2,range\n" + "1" * 200_000])
def test_broken_csv_is_no_traceback(problem, text):
    assert "observations.csv, line 2: not valid CSV: " in problem(text)


def test_a_sparse_file_of_two_gigabytes_is_refused_by_its_size(folder):
    os.truncate("observations.csv", 2 * 2**30)
    assert folder.problem() == (
        "campaign.yaml, line 5: observations: observations.csv: the file has 2,048 MiB; "
        "expected a CSV or Parquet file of at most 512 MiB: thin it or split it"
    )


def test_exact_copies_are_kept_and_warned_of(read):
    campaign = read(f"{HEADER}1,2,3\n1,2,3\n2,2,3\n1,2,3\n")
    assert len(campaign.readings) == 4
    assert campaign.warnings == (
        "observations.csv: 2 rows are exact copies of others (lines 2, 3, 5); "
        "all are kept and count as separate readings",
    )


def test_readings_beyond_a_joints_limits_name_the_worst(read):
    assert read(f"{HEADER}-3.1,2,3\n3.2,2,3\n2,2,3\n").warnings == (
        "observations.csv: joint j1 reads 3.2 rad on line 3, beyond its limits -2.96706 to 2.96706 rad (2 rows in all)",
    )


@pytest.mark.parametrize("row", ["160,2,3", "1,7,3\n-40,1,3"])
def test_angles_that_look_like_degrees_are_refused_once(read, row):
    with pytest.raises(InputError) as refused:
        read(f"{HEADER}{row}\n")
    (problem,) = refused.value.problems
    assert problem.endswith("within its limits as degrees: say units: {angle: deg} in the campaign")


def test_radians_in_a_file_of_degrees_are_warned_of(folder, campaign_with):
    rows = "".join(f"{math.sin(i)},{math.cos(i)},1\n" for i in range(20))
    folder.write(campaign=campaign_with(("sensor:", "units: {angle: deg}\nsensor:")), observations=HEADER + rows)
    (warning,) = folder.load().warnings
    assert "say units: {angle: rad} in the campaign" in warning


def test_a_hundred_thousand_rows_are_read_to_the_bit(folder):
    numbers = np.random.default_rng(0).uniform(0.1, 2.0, (100_000, 3))
    text = HEADER + "\n".join(",".join(map(repr, row)) for row in numbers.tolist()) + "\n"
    readings = folder.write(observations=text).load().readings
    assert np.array_equal(readings.joints, numbers[:, :2])
    assert np.array_equal(readings.values, numbers[:, 2:])


def test_a_file_full_of_faults_is_refused_without_delay(folder, two_targets):
    rows = "".join(f"1,2,3,wall{i}\n" for i in range(20_000))
    problems = folder.write(campaign=two_targets, observations="j1,j2,range,target\n" + rows).problems()
    assert problems[-1] == "and 19980 more"
    header = ",".join(f"j{i}" for i in range(20_000))
    assert len(folder.write(observations=header + "\n").problems()) == 1


def test_a_file_that_is_written_to_while_it_is_read_is_refused(folder, monkeypatch):
    """A recording that still goes on: what was read of it is not what its digest says."""
    read = observations.csv_sheet

    def writing(file, name):
        sheet = read(file, name)
        with open(file.name, "a") as again:
            again.write("0.2,0.3,0.4\n")
        return sheet

    monkeypatch.setattr(observations, "csv_sheet", writing)
    assert folder.write(observations=f"{HEADER}0.1,0.2,0.3\n").problem() == (
        "campaign.yaml, line 5: observations: observations.csv: it was written to while it was read; try again when it "
        "is complete"
    )
