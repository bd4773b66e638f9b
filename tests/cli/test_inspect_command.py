"""`boresight inspect` as people and programs call it."""

import csv
import json
from pathlib import Path

import pytest

import boresight
from boresight.cli.app import app
from boresight.errors import InputError

EXAMPLES = Path(__file__).parents[2] / "examples"


def run(*arguments):
    return app(["inspect", *arguments], result_action="return_value", exit_on_error=False)


def test_flat_plane_names_what_it_cannot_see_and_exits_with_0(capsys):
    assert run(str(EXAMPLES / "flat-plane" / "campaign.yaml")) == 0
    words = " ".join(capsys.readouterr().out.split())
    assert words.startswith("SEES 21 of 24 flat-plane")
    assert "j1.theta, j1.a and j3.d do not change any reading" in words
    assert "mend: measure against one more plane" in words
    assert "(4R + 2P + 6)" in words


def test_json_has_everything(capsys):
    assert run(str(EXAMPLES / "flat-plane" / "campaign.yaml"), "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["schema"] == "boresight-inspection/1"
    assert found["identifiability"]["rank"] == 21
    assert found["identifiability"]["everett_count"] == 30
    assert found["identifiability"]["unseen"][0]["parameters"] == ["j1.theta", "j1.a", "j3.d"]
    assert set(found["identifiability"]["observability"]) == {"o1", "o2", "o3", "o4", "o5"}
    assert len(found["parameters"]) == 24


def test_campaign_without_readings_is_inspected_at_drawn_configurations(tmp_path, capsys):
    source = EXAMPLES / "space-arm-three-planes"
    (tmp_path / "robot.yaml").write_text((source / "robot.yaml").read_text())
    lines = (source / "campaign.yaml").read_text().splitlines()
    planned = "\n".join(line for line in lines if not line.startswith(("observations", "validation")))
    (tmp_path / "campaign.yaml").write_text(planned + "\n")
    assert run(str(tmp_path / "campaign.yaml"), "--rows", "35", "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["configurations"] == {
        "count": 35,
        "drawn": True,
        "values": 35,
        "missed": 0,
        "targets": ["deck", "wall_x", "wall_y"],
    }
    assert found["identifiability"]["rank"] == 23


def configurations_alone(folder):
    source = EXAMPLES / "space-arm-three-planes"
    for name in ("robot.yaml", "campaign.yaml", "validation.csv"):
        (folder / name).write_text((source / name).read_text())
    with open(source / "observations.csv", newline="") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    kept = [column for column, name in enumerate(rows[0]) if name.startswith("j") or name == "target"]
    text = "\n".join(",".join(row[column] for column in kept) for row in rows)
    (folder / "observations.csv").write_text(text + "\n")
    return folder / "campaign.yaml"


def test_configurations_alone_are_as_good_as_readings(tmp_path, capsys):
    run(str(configurations_alone(tmp_path)), "--json")
    planned = json.loads(capsys.readouterr().out)
    run(str(EXAMPLES / "space-arm-three-planes" / "campaign.yaml"), "--json")
    measured = json.loads(capsys.readouterr().out)
    assert not planned["configurations"]["drawn"]
    for key in ("configurations", "identifiability", "parameters"):
        assert planned[key] == measured[key]


def test_configurations_alone_are_not_calibrated(tmp_path):
    path = configurations_alone(tmp_path)
    with pytest.raises(InputError, match=r"observations\.csv, line 1: there are configurations but no readings"):
        app(["calibrate", str(path)], result_action="return_value", exit_on_error=False)
    with pytest.raises(InputError, match="there are configurations but no readings; measure them"):
        boresight.calibrate(boresight.load_campaign(path))


def test_configurations_alone_can_be_rehearsed(tmp_path):
    rehearsal = boresight.simulate(boresight.load_campaign(configurations_alone(tmp_path)))
    assert rehearsal.readings.measured


@pytest.mark.parametrize("option", [["--rows", "0"], ["--seed", "-1"]])
def test_impossible_numbers_are_refused(option):
    with pytest.raises(InputError, match=option[0]):
        run(str(EXAMPLES / "flat-plane" / "campaign.yaml"), *option)
