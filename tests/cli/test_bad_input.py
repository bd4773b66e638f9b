"""Whatever is wrong with the input: one clear message, exit code 1, and earlier results as they were."""

import math
import os
import shutil

import pytest
from example_files import EXAMPLES, content

from boresight.calibration import Solver, calibrate
from boresight.files import load_campaign
from boresight.report import write_result

YAML_FAULTS = {
    "unknown tag": ("units: {length: m, angle: rad}", "units: !!python/object:os.system {length: m}", "the tag"),
    "recursive alias": ("fixed: [j1.theta, j2.d]", "fixed: &me [*me]", "would never end"),
    "duplicate key": ("fixed: [j1.theta, j2.d]", "fixed: [j1.theta]\nfixed: [j2.d]", "is there already, on line 12"),
    "unknown key": ("validation:", "validaton:", "did you mean validation?"),
    "parameter of no joint": ("j2.beta", "j9.beta", "'j9.beta' is no parameter"),
    "zero normal": ("[0, 0.212429644331, 0.977176363923]", "[0, 0, 0]", "expected a direction, which is not zero"),
    "missing robot": ("robot: robot.yaml", "robot: robto.yaml", "did you mean robot.yaml?"),
    "missing readings": ("observations: observations.csv", "observations: none.csv", "there is no such file"),
    "no readings": ("observations: observations.csv\n", "", "there are no readings"),
    "everything fixed": ("fixed: [j1.theta, j2.d]", "fixed: ['*']", "there is nothing to calibrate"),
    "noise of nothing": ("noise_std: 0.0002", "noise_std: 0", "expected a number above 0"),
    "numbers beyond all measure": ("offset: -0.146576454588", "offset: 1.0e+300", "expected a number of at most 1e+09"),
    "text for a number": ("offset: -0.146576454588", "offset: low", "got 'low'; expected a number"),
    "no YAML": ("fixed: [j1.theta, j2.d]", "fixed: [j1.theta", "not valid YAML"),
}


@pytest.fixture(scope="session")
def accepted_result(tmp_path_factory):
    campaign = load_campaign(EXAMPLES / "space-arm-one-plane" / "campaign.yaml")
    return write_result(calibrate(campaign, Solver("least-squares")), tmp_path_factory.mktemp("earlier"), "0")


@pytest.fixture
def refused(boresight, one_plane, tmp_path, accepted_result):
    """Calibrates into a folder that holds an accepted result, and returns the message."""
    shutil.copytree(accepted_result, tmp_path / "earlier")
    before = content(accepted_result)

    def refusal(*options):
        said = boresight("calibrate", one_plane.campaign, "-o", "earlier", *options)
        assert said.code == 1
        assert said.out == ""
        assert said.err.startswith(("Error: ", "╭─ Error "))
        assert content(tmp_path / "earlier") == before
        assert not (tmp_path / "earlier-rejected").exists()
        return said.err

    return refusal


def test_a_missing_campaign_is_told(boresight):
    said = boresight("calibrate", "none.yaml")
    assert (said.code, said.err) == (1, "Error: none.yaml: there is no such file; expected a YAML file\n")


@pytest.mark.parametrize("fault", YAML_FAULTS)
def test_a_faulty_campaign_is_one_message(refused, one_plane, fault):
    old, new, told = YAML_FAULTS[fault]
    one_plane.swap("campaign.yaml", (old, new))
    said = refused()
    assert told in said
    assert said.count("\n") == 1


def test_a_column_of_no_joint_names_what_is_missing(refused, one_plane):
    one_plane.rows(lambda rows: [["j1", "j2", "q3", *rows[0][3:]], *rows[1:]])
    said = refused()
    assert "unknown column 'q3'" in said
    assert "and no column for joint j3; expected columns" in said


@pytest.mark.parametrize("bad", ["", "nan", "inf", "-0.1", "1e308"])
def test_rows_that_cannot_be_used_are_set_aside_and_told(boresight, one_plane, bad):
    one_plane.rows(lambda rows: [rows[0], [*rows[1][:6], bad, rows[1][7]], *rows[2:]])
    said = boresight("calibrate", one_plane.campaign, "--solver", "least-squares")
    assert (said.code, said.err) == (0, "")
    assert "Set aside: observations.csv line 2 (range is " in said.out


def test_rows_that_cannot_be_used_at_all_are_an_error(refused, one_plane):
    one_plane.rows(lambda rows: [rows[0], *([*row[:6], "", row[7]] for row in rows[1:])])
    assert "none of its 100 rows can be used; the first, on line 2: range is empty" in refused()


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"\x00\x01\x02", "the file is binary or UTF-16"),
        (b"\x89PNG\r\n\x1a\n\x00", "this is a PNG picture"),
        ("j1,j2\n".encode("utf-16"), "this is text in UTF-16"),
    ],
)
def test_binary_readings_are_refused(refused, one_plane, content, told):
    (one_plane.folder / "observations.csv").write_bytes(content)
    assert told in refused()


def test_readings_of_two_gigabytes_are_refused_unread(refused, one_plane):
    with open(one_plane.folder / "observations.csv", "wb") as file:
        file.truncate(2 * 2**30)
    assert "the file has 2,048 MiB; expected a CSV or Parquet file of at most 512 MiB" in refused()


def test_exact_copies_are_warned_of(boresight, one_plane):
    one_plane.rows(lambda rows: [*rows, rows[1], rows[2]])
    said = boresight("calibrate", one_plane.campaign, "--solver", "least-squares")
    assert said.code == 0
    assert "Warning: observations.csv: 2 rows are exact copies of others" in said.out


def test_a_normal_need_not_be_a_unit_vector(boresight, one_plane):
    old = "normal: [0, 0.212429644331, 0.977176363923], offset: -0.146576454588"
    one_plane.swap("campaign.yaml", (old, "normal: [0, 1, 4.6], offset: -0.69"))
    said = boresight("calibrate", one_plane.campaign, "--solver", "least-squares")
    assert said.code == 0
    assert "Held-out error fell from 25.5 mm to 0.0821 mm" in said.out


def test_beams_that_miss_are_warned_of(boresight, one_plane):
    one_plane.rows(lambda rows: [rows[0], *([str(-float(row[0])), *row[1:]] for row in rows[1:])])
    one_plane.rows(lambda rows: [rows[0], *([*row[:4], str(-float(row[4])), *row[5:]] for row in rows[1:])])
    said = boresight("calibrate", one_plane.campaign, "--solver", "least-squares")
    assert (said.code, said.err) == (2, "")
    assert "beams look away from their planes in the nominal model" in " ".join(said.out.split())


def test_fewer_rows_than_parameters_run_on_priors_and_say_so(boresight, one_plane):
    one_plane.rows(lambda rows: rows[:16])
    said = boresight("calibrate", one_plane.campaign, "--solver", "least-squares")
    assert said.code in (0, 2)
    assert "Warning: 15 readings for 25 free parameters" in said.out
    assert len(said.out.splitlines()) < 40


@pytest.mark.parametrize("rows", [1, 2, 5])
def test_a_handful_of_rows_is_not_enough_to_be_accepted(boresight, one_plane, rows):
    one_plane.rows(lambda table: table[: rows + 1]).swap("campaign.yaml", ("validation: validation.csv\n", ""))
    said = boresight("calibrate", one_plane.campaign, "--solver", "least-squares")
    assert (said.code, said.err) == (2, "")
    count = "1 held-out configuration" if rows == 1 else f"{rows} held-out configurations"
    assert f"{count} cannot prove an improvement" in " ".join(said.out.split())


def test_degrees_in_a_file_of_radians_are_refused_before_the_search(boresight, one_plane):
    one_plane.rows(lambda rows: [rows[0], *([*(str(math.degrees(float(c))) for c in r[:6]), *r[6:]] for r in rows[1:])])
    said = boresight("calibrate", one_plane.campaign, "--solver", "least-squares")
    assert (said.code, said.out) == (1, "")
    assert "within its limits as degrees: say units: {angle: deg} in the campaign" in said.err


def test_an_output_below_a_file_is_refused_before_the_search(boresight, one_plane, tmp_path):
    (tmp_path / "file").write_text("mine")
    said = boresight("calibrate", one_plane.campaign, "-o", "file/result")
    assert said.code == 1
    assert said.err == "Error: file/result: cannot be written; name another folder for the result with -o\n"


def test_an_output_that_is_a_file_is_refused(boresight, one_plane, tmp_path):
    (tmp_path / "file").write_text("mine")
    said = boresight("calibrate", one_plane.campaign, "-o", "file")
    assert said.code == 1
    assert said.err == "Error: file: is a file; name a folder for the result with -o\n"
    assert (tmp_path / "file").read_text() == "mine"


def test_an_output_without_permission_is_refused_before_the_search(refused, monkeypatch):
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    assert refused() == "Error: earlier: cannot be written; name another folder for the result with -o\n"


@pytest.mark.parametrize("text", ["{}", "[1]", "not JSON", '{"schema": "somebody-elses/3"}'])
def test_a_result_of_other_software_is_never_overwritten(boresight, one_plane, tmp_path, text):
    (tmp_path / "theirs").mkdir()
    (tmp_path / "theirs" / "result.json").write_text(text)
    said = boresight("calibrate", one_plane.campaign, "-o", "theirs")
    assert said.code == 1
    assert said.err.startswith("Error: theirs: holds result.json but no Boresight result; nothing is overwritten")
    assert content(tmp_path / "theirs") == {"result.json": text.encode()}


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--population", "2"], "--population: expected 5 to 1000000 members, got 2"),
        (["--population", "999999999999"], "--population: expected 5 to 1000000 members"),
        (["--generations", "0"], "--generations: expected 1 to 1000000000, got 0"),
        (["--seed", "-1"], "--seed: expected a whole number from 0 to 9223372036854775807, got -1"),
        (["--seed", "99999999999999999999999"], "--seed: expected a whole number from 0 to"),
        (["--seed", "x"], "expected a whole number, got x"),
        (["--strategy", "best/7"], 'Invalid value "best/7" for --strategy'),
        (["--solver", "guessing"], 'Invalid value "guessing" for --solver'),
        (["--populatoin", "5"], "--populatoin"),
    ],
)
def test_an_option_that_makes_no_sense_is_refused(refused, options, told):
    assert told in refused(*options)


def test_several_bad_options_are_told_at_once(refused):
    said = refused("--seed", "-1", "--population", "1")
    assert said.startswith("Error: 2 problems\n")


@pytest.mark.parametrize("arguments", [["calibrate"], ["calibrated", "x.yaml"], ["calibrate", "a.yaml", "b.yaml"]])
def test_a_command_that_makes_no_sense_is_a_usage_error(boresight, arguments):
    said = boresight(*arguments)
    assert (said.code, said.out) == (1, "")
    assert said.err.startswith("╭─ Error ")
