"""docs/files.md describes every key that the files have."""

from pathlib import Path

import pytest

from boresight.calibration import Solver, calibrate
from boresight.files import load_campaign
from boresight.files.columns import IGNORED
from boresight.files.schemas import CampaignEntry, DataEntry, FreedomEntry, JointEntry, RobotEntry
from boresight.report.document import result_document

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "files.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("schema", [RobotEntry, JointEntry, CampaignEntry, DataEntry, FreedomEntry])
def test_every_key_of_the_input_is_described(schema):
    assert [key for key in schema.model_fields if f"`{key}`" not in TEXT and f".{key}`" not in TEXT] == []


def test_every_column_that_is_not_used_is_described():
    assert [name for name in IGNORED if f"`{name}`" not in TEXT] == []


def test_every_key_of_result_json_is_described():
    campaign = load_campaign(ROOT / "examples" / "space-arm-one-plane" / "campaign.yaml")
    document = result_document(calibrate(campaign, Solver("least-squares")), "0")
    described = TEXT[TEXT.index("### result.json") :]
    assert [key for key in document if f"`{key}" not in described] == []
    inner = [key for key in document["parameters"][0] if f"`{key}`" not in described]
    assert inner + [key for key in document["search"]["stages"][0] if f"`{key}`" not in described] == []
