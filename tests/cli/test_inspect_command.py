"""`boresight inspect` as people and programs call it."""

import json
from pathlib import Path

import pytest

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


@pytest.mark.parametrize("option", [["--rows", "0"], ["--seed", "-1"]])
def test_impossible_numbers_are_refused(option):
    with pytest.raises(InputError, match=option[0]):
        run(str(EXAMPLES / "flat-plane" / "campaign.yaml"), *option)
