"""A large file takes time and memory in proportion to its rows, and not much of either."""

import pytest
from benchmarks.speed.end_to_end import write_campaign
from benchmarks.speed.processes import boresight

FEW, MANY = 20_000, 200_000
KIB_A_ROW = 1.0
"""A million rows then take less than 1.3 GB; measured 0.35."""


def calibrated(folder, rows):
    folder.mkdir()
    write_campaign(folder, rows)
    ended = boresight(("calibrate", "campaign.yaml", "--solver", "least-squares"), folder)
    assert ended.code == 0, ended.said
    return ended, next(folder.glob("*-result"))


@pytest.mark.long
def test_memory_grows_by_less_than_a_kib_a_row(tmp_path):
    few, _ = calibrated(tmp_path / "few", FEW)
    many, result = calibrated(tmp_path / "many", MANY)
    assert many.peak - few.peak < KIB_A_ROW * 1024 * (MANY - FEW)
    with open(result / "residuals.csv") as file:
        assert sum(1 for _ in file) == MANY + 1
