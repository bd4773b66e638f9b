"""One seed's runs: judged against the truth, the same on any number of workers."""

import numpy as np
import pytest

from boresight.reproduction import compose, reproduce
from boresight.reproduction.rivals import EVALUATIONS
from boresight.reproduction.variants import (
    AZIMUTH_FREE,
    LEAST_SQUARES,
    MODERN,
    NOMINAL,
    THREE_PLANES,
    Variant,
    variants,
)


def numbers(measured):
    page = compose(measured, "boresight reproduce")
    return {each.name: each.as_csv() for each in page.tables} | {each.name: each.csv for each in page.pictures}


@pytest.mark.long
def test_one_worker_and_two_give_the_same_numbers(found):
    assert numbers(reproduce(2, seed=40, workers=2)) == numbers(found)


def test_nothing_beats_least_squares_and_nominal_is_where_it_starts(found):
    for trial in found.trials:
        for variant, run in trial.runs.items():
            assert run.from_optimum > 1.0 - 1e-6, variant
            if variant.method == NOMINAL:
                assert np.all(run.x == 0.0)
                assert run.range_max_mm > 10.0
            if variant.method == LEAST_SQUARES:
                assert run.from_optimum == pytest.approx(1.0, abs=1e-9)


def test_costs_are_the_squares_of_the_range_errors(found):
    for run in found.trials[0].runs.values():
        assert run.cost_mm2 == pytest.approx(np.sum(run.range_mm**2), rel=1e-8)


def test_evolution_uses_the_generations_and_evaluations_of_equation_24(found):
    for trial in found.trials:
        for variant, run in trial.runs.items():
            if len(run.history_mm2):
                assert (len(run.history_mm2), run.evaluations) == (501, EVALUATIONS)
                assert np.all(np.diff(run.history_mm2) <= 0.0)
                assert run.history_mm2[-1] == pytest.approx(run.cost_mm2, rel=1e-9)
            else:
                assert variant.method in (NOMINAL, LEAST_SQUARES, *MODERN)


def test_modern_evolution_spends_the_same_evaluations(found):
    if not found.modern:
        pytest.skip("minionpy is not installed")
    for trial in found.trials:
        for name in MODERN:
            assert 0.98 * EVALUATIONS < trial.runs[Variant(name, 35)].evaluations < 1.02 * EVALUATIONS


def test_a_free_azimuth_spoils_the_pose_in_the_bases_frame_and_not_otherwise(found):
    for trial in found.trials:
        fixed, free = trial.runs[Variant("trade-off", 100)], trial.runs[Variant("trade-off", 100, AZIMUTH_FREE)]
        assert free.range_rms_mm == pytest.approx(fixed.range_rms_mm, rel=0.01)
        assert free.validation.position_rms_mm > 2.0 * fixed.validation.position_rms_mm
        assert free.validation_turned.position_rms_mm < 1.2 * fixed.validation.position_rms_mm


def test_three_planes_know_the_azimuth(found):
    for trial in found.trials:
        run = trial.runs[Variant(LEAST_SQUARES, 100, THREE_PLANES)]
        assert len(run.names) == 26
        assert run.validation.position_rms_mm < 0.15


def test_every_variant_is_run_once_and_modern_ones_only_where_they_can():
    with_modern, without = variants(True), variants(False)
    assert len(set(with_modern)) == len(with_modern)
    assert {each.method for each in set(with_modern) - set(without)} == set(MODERN)
