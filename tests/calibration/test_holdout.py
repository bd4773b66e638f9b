"""Validation rows: what is grossly wrong among them is told and not judged by, unless it is much."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import measured, rehearsed_campaign

from boresight.calibration import Solver, calibrate


@pytest.fixture(scope="module")
def rehearsed():
    campaign, truth = rehearsed_campaign()
    return replace(campaign, validation=measured(campaign.cell, truth, 40, seed=9))


def with_errors(campaign, rows):
    values = campaign.validation.values.copy()
    values[rows] += 0.2
    return calibrate(replace(campaign, validation=replace(campaign.validation, values=values)), Solver("least-squares"))


def test_a_few_gross_validation_rows_are_told_and_not_judged_by(rehearsed):
    result = with_errors(rehearsed, [3, 17, 30])
    lines = rehearsed.validation.line[[3, 17, 30]]
    assert result.verdict.accepted
    assert result.validation.count == 37
    assert result.validation.missed == 0
    (warning,) = [each for each in result.warnings if "validation rows do not fit" in each]
    assert f"(lines {lines[0]}, {lines[1]} and {lines[2]})" in warning


def test_where_many_do_not_fit_the_result_is_judged_by_all(rehearsed):
    result = with_errors(rehearsed, np.arange(14))
    assert not result.verdict.accepted
    assert result.validation.count == 40


def test_clean_validation_rows_are_all_judged_by(rehearsed):
    result = calibrate(rehearsed, Solver("least-squares"))
    assert result.validation.count == 40
    assert not any("validation row" in warning for warning in result.warnings)
