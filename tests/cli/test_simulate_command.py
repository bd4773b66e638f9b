"""`boresight simulate`: a campaign to rehearse with, and its truth."""

import json

import numpy as np
import pytest
from example_files import content

from boresight.files import load_campaign, load_robot

QUICK = ("--solver", "least-squares")


def test_a_rehearsal_calibrates_to_an_accepted_result(boresight, one_plane, tmp_path):
    said = boresight("simulate", one_plane.campaign, "--seed", "5")
    assert (said.code, said.err) == (0, "")
    assert said.out.splitlines()[-1] == "Next: boresight calibrate mine-simulated/campaign.yaml"
    names = {"campaign.yaml", "observations.csv", "robot.yaml", "truth.json", "validation.csv"}
    assert set(content(tmp_path / "mine-simulated")) == names
    assert boresight("calibrate", "mine-simulated/campaign.yaml", *QUICK).code == 0


def test_the_calibrated_rehearsal_is_near_its_truth(boresight, example, tmp_path):
    boresight("simulate", example("space-arm-three-planes").campaign, "-o", "rehearsal")
    boresight("calibrate", "rehearsal/campaign.yaml", "-o", "found", *QUICK)
    truth = np.array(json.loads((tmp_path / "rehearsal" / "truth.json").read_text())["validation_position"])
    joints = load_campaign(tmp_path / "rehearsal" / "campaign.yaml").validation.joints

    def rms_mm(robot):
        positions = load_robot(tmp_path / robot).forward_kinematics(joints)[:, :3, 3]
        return 1e3 * np.sqrt(np.mean(np.sum((positions - truth) ** 2, axis=1)))

    assert rms_mm("rehearsal/robot.yaml") > 5.0
    assert rms_mm("found/robot-calibrated.yaml") < 0.2


def test_the_same_seed_gives_the_same_bytes(boresight, one_plane, tmp_path):
    for folder, seed in (("one", 3), ("two", 3), ("three", 4)):
        assert boresight("simulate", one_plane.campaign, "-o", folder, "--seed", seed).code == 0
    assert content(tmp_path / "one") == content(tmp_path / "two")
    assert content(tmp_path / "one") != content(tmp_path / "three")


def test_rows_can_be_chosen(boresight, one_plane, tmp_path):
    boresight("simulate", one_plane.campaign, "-o", "few", "--rows", "12", "--validation-rows", "7")
    assert len((tmp_path / "few" / "observations.csv").read_text().splitlines()) == 13
    assert len((tmp_path / "few" / "validation.csv").read_text().splitlines()) == 8


def test_a_campaign_without_readings_can_be_rehearsed(boresight, one_plane, tmp_path):
    one_plane.swap("campaign.yaml", ("observations: observations.csv\nvalidation: validation.csv\n", ""))
    assert boresight("simulate", one_plane.campaign, "-o", "new").code == 0
    assert len((tmp_path / "new" / "observations.csv").read_text().splitlines()) == 101
    assert boresight("calibrate", "new/campaign.yaml", *QUICK).code == 0


def test_a_folder_that_holds_something_is_refused(boresight, one_plane, tmp_path):
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "notes.txt").write_text("mine")
    said = boresight("simulate", one_plane.campaign, "-o", "full")
    assert said.code == 1
    assert said.err == "Error: full: is not empty; nothing is overwritten: name a new folder with -o\n"
    assert content(tmp_path / "full") == {"notes.txt": b"mine"}


def test_units_of_the_campaign_hold_in_its_rehearsal(boresight, one_plane, tmp_path):
    one_plane.swap(
        "campaign.yaml",
        ("units: {length: m, angle: rad}", "units: {length: mm, angle: deg}"),
        ("noise_std: 0.0002", "noise_std: 0.2"),
        ("offset: -0.146576454588", "offset: -146.576454588"),
        ("within: 0.025", "within: 1.4"),
        ("within: 0.010", "within: 10"),
        ("observations: observations.csv\nvalidation: validation.csv\n", ""),
    )
    assert boresight("simulate", one_plane.campaign, "-o", "mm").code == 0
    header, first, *_ = (tmp_path / "mm" / "observations.csv").read_text().splitlines()
    row = dict(zip(header.split(","), first.split(","), strict=True))
    assert float(row["range"]) > 50.0
    said = boresight("calibrate", "mm/campaign.yaml", *QUICK)
    assert said.code == 0
    assert "Warning" not in said.out


@pytest.mark.long
def test_unknown_frames_before_a_tracker_are_rehearsed_and_found(boresight, example):
    campaign = example("ur10-laser-tracker").campaign
    assert boresight("simulate", campaign, "-o", "rehearsal", "--rows", "60").code == 0
    said = boresight("calibrate", "rehearsal/campaign.yaml", *QUICK)
    assert said.code == 0


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--rows", "0"], "Error: --rows: expected 1 to 1000000, got 0\n"),
        (["--validation-rows", "-3"], "Error: --validation-rows: expected 1 to 1000000, got -3\n"),
        (["--size", "nan"], "Error: --size: expected a factor from 0 to 100, got nan\n"),
        (["--seed", "-1"], "Error: --seed: expected a whole number from 0 to 9223372036854775807, got -1\n"),
    ],
)
def test_an_option_that_makes_no_sense_is_refused(boresight, one_plane, options, told):
    said = boresight("simulate", one_plane.campaign, *options)
    assert (said.code, said.err) == (1, told)


def test_a_plane_that_no_beam_meets_is_told(boresight, one_plane, tmp_path):
    one_plane.swap("campaign.yaml", ("[0, 0.212429644331, 0.977176363923]", "[0, 0, 1]"), ("-0.146576454588", "900"))
    one_plane.swap("campaign.yaml", ("observations: observations.csv\nvalidation: validation.csv\n", ""))
    one_plane.swap("robot.yaml", ("limits: [-170, 170]", "limits: [-0.001, 0.001]"))
    said = boresight("simulate", one_plane.campaign, "-o", "none")
    assert said.code == 1
    assert said.err.startswith("Error: hardly any configuration within the joints' limits sees target 'deck'")
    assert not (tmp_path / "none").exists()
