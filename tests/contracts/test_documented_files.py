"""docs/files.md describes every key that the files have."""

import re
from pathlib import Path

import numpy as np
import pytest

from boresight.calibration import Solver, calibrate, inspect, simulate
from boresight.files import load_campaign
from boresight.files.columns import IGNORED
from boresight.files.rehearsals import write_rehearsal
from boresight.files.schemas import (
    CampaignEntry,
    DataEntry,
    FreedomEntry,
    JointEntry,
    PointEntry,
    RobotEntry,
    SensorEntry,
)
from boresight.report.document import result_document

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "files.md").read_text(encoding="utf-8")


SCHEMAS = [RobotEntry, JointEntry, CampaignEntry, DataEntry, FreedomEntry, SensorEntry, PointEntry]


@pytest.mark.parametrize("schema", SCHEMAS)
def test_every_key_of_the_input_is_described(schema):
    assert [key for key in schema.model_fields if f"`{key}`" not in TEXT and f".{key}`" not in TEXT] == []


CAMPAIGNS = [block for block in re.findall(r"```yaml\n(.*?)```", TEXT, re.DOTALL) if block.startswith("robot:")]


@pytest.mark.parametrize("text", CAMPAIGNS)
def test_every_documented_campaign_can_be_rehearsed(tmp_path, text):
    (tmp_path / "campaign.yaml").write_text(text)
    campaign = load_campaign(tmp_path / "campaign.yaml")
    assert inspect(campaign, rows=60).rank > 20
    rehearsal = simulate(campaign, rows=60)
    written = write_rehearsal(campaign, rehearsal, tmp_path / "campaign.yaml", tmp_path / "rehearsal")
    again = load_campaign(written, need_readings=True).readings
    np.testing.assert_allclose(again.values, rehearsal.readings.values, atol=1e-9)
    if again.reference is not None:
        np.testing.assert_allclose(again.reference, rehearsal.readings.reference, atol=1e-9)


def test_documented_rows_of_several_sensors_are_read(tmp_path):
    (text,) = (each for each in CAMPAIGNS if "sensors:" in each)
    rows = re.search(r"((?:    j1,.*sensor\n)(?:    .*\n)+)", TEXT)[1].replace("    ", "")
    (tmp_path / "campaign.yaml").write_text(text + "observations: rows.csv\n")
    (tmp_path / "rows.csv").write_text(rows)
    readings = load_campaign(tmp_path / "campaign.yaml", need_readings=True).readings
    assert readings.channels.tolist() == [1, 3]


def test_every_column_that_is_not_used_is_described():
    assert [name for name in IGNORED if f"`{name}`" not in TEXT] == []


def test_every_key_of_result_json_is_described():
    campaign = load_campaign(ROOT / "examples" / "space-arm-one-plane" / "campaign.yaml")
    document = result_document(calibrate(campaign, Solver("least-squares")), "0")
    described = TEXT[TEXT.index("### result.json") :]
    assert [key for key in document if f"`{key}" not in described] == []
    inner = [key for key in document["parameters"][0] if f"`{key}`" not in described]
    assert inner + [key for key in document["search"]["stages"][0] if f"`{key}`" not in described] == []
