"""Lengths and angles in another unit, where some cell could have them: told with what would explain the readings."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import measured, position_cell, ranger_cell
from test_explanations import fitted, truth_of

from boresight.calibration import Campaign
from boresight.calibration.alternatives import find_alternatives
from boresight.calibration.unit_slips import unit_slips
from boresight.calibration.written import Written
from boresight.geometry import Plane

CELL = ranger_cell(planes=3)
SAID = Written("robot.yaml", "campaign.yaml", "observations.csv")


def told(cell, readings):
    campaign = Campaign("units", cell, readings, written=SAID)
    return find_alternatives(fitted(cell, readings), cell, campaign, 0)


def with_number(cell, joint, number, factor):
    joints = [
        replace(each, **{number: factor * getattr(each, number)}) if each.name == joint else each
        for each in cell.arm.joints
    ]
    return replace(cell, arm=replace(cell.arm, joints=tuple(joints)))


@pytest.mark.parametrize(
    ("joint", "number", "factor", "words"),
    [
        ("j2", "a", 1000.0, "`j2.a` = 450 reads as millimetres: 0.45 explains the readings"),
        ("j6", "a", 1000.0, "robot.yaml: `j6.a` = 60 reads as millimetres: 0.06 explains the readings"),
        ("j4", "d", 1e-3, "`j4.d`"),
        ("j6", "a", 1e-3, "`j6.a` = 6e-05 reads as a number 1000 times too small: 0.06"),
        ("j6", "alpha", 180.0 / np.pi, "`j6.alpha` = 30 reads as degrees: 0.523599 explains the readings"),
    ],
)
def test_a_number_of_the_table_in_another_unit_is_told(joint, number, factor, words):
    readings = measured(CELL, truth_of(CELL), 100, 1)
    found = told(with_number(CELL, joint, number, factor), readings)
    assert words in found[0].sentence


def test_a_planes_offset_in_millimetres_is_told():
    readings = measured(CELL, truth_of(CELL), 100, 1)
    wall = CELL.targets["wall_x"]
    wrong = replace(CELL, targets={**CELL.targets, "wall_x": Plane.of(wall.normal, 1000.0 * wall.offset)})
    assert told(wrong, readings)[0].effect == "unit of wall_x.offset"


def test_a_column_in_another_unit_is_told():
    readings = measured(CELL, truth_of(CELL), 100, 1)
    turns = np.where(np.arange(6) == 2, np.pi / 180.0, 1.0)
    found = told(CELL, replace(readings, joints=readings.joints * turns))
    assert "column `j3` reads as" in found[0].sentence


def test_nothing_is_told_of_units_that_are_right():
    for seed in range(3):
        for cell in (CELL, position_cell("ur10")):
            readings = measured(cell, truth_of(cell), 80, seed)
            assert told(cell, readings) == ()


def test_each_slip_changes_something():
    readings = measured(CELL, rows=10)
    campaign = Campaign("units", CELL, readings, written=SAID)
    given = CELL.errors(readings)
    seen = list(unit_slips(CELL, readings, campaign))
    assert len({effect for effect, *_ in seen}) > 20
    for _, _, cell, changed in seen:
        assert not np.array_equal(cell.errors(changed), given)
