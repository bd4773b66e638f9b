"""What outcomes say together."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats
from small_studies import point, small_study

from boresight.studies import Outcome, Store, run, summarise
from boresight.studies.summary import PointSummary, Share


@pytest.mark.parametrize(("count", "of"), [(0, 10), (3, 10), (10, 10), (987, 1000), (1, 1)])
def test_shares_have_wilsons_interval(count, of):
    expected = stats.binomtest(count, of).proportion_ci(0.95, method="wilson")
    assert Share(count, of).interval == pytest.approx((expected.low, expected.high), abs=1e-12)
    assert Share(count, of).value == count / of


def test_a_share_of_nothing_is_no_number():
    assert np.isnan([Share(0, 0).value, *Share(0, 0).interval]).all()


@pytest.fixture(scope="module")
def outcome():
    return run(point(gross_errors=0.1), 0)


def test_quantiles_are_numpys_and_leave_out_what_is_no_number(outcome):
    values = [0.3, 0.1, float("nan"), 0.2, 0.7]
    outcomes = {seed: replace(outcome, position_rms=value) for seed, value in enumerate(values)}
    spread = PointSummary(point(), outcomes).spread("position_rms")
    expected = np.quantile([0.3, 0.1, 0.2, 0.7], (0.1, 0.5, 0.9))
    assert (spread.low, spread.median, spread.high) == pytest.approx(tuple(expected))


def test_failed_runs_are_counted_and_enter_no_number(outcome):
    both = PointSummary(point(), {0: outcome, 1: Outcome.failed("blind", 24)})
    assert (both.failed, both.reached, both.found) == (1, Share(1, 1), Share(4, 4))
    assert both.spread("position_rms").median == outcome.position_rms


def test_a_search_reached_the_optimum_within_one_per_cent_of_its_rms(outcome):
    assert replace(outcome, optimum=100.0, cost=102.0).reached
    assert not replace(outcome, optimum=100.0, cost=102.1).reached
    assert not Outcome.failed("blind", 3).reached


def test_a_summary_looks_at_the_studys_own_points_and_seeds(tmp_path, outcome):
    study = small_study(2)
    with Store.open(tmp_path / "runs.sqlite") as store:
        for seed in range(5):
            store.add(study.points[0], seed, outcome)
            store.add(point(rows=77), seed, outcome)
        summary = summarise(study, store)
    assert summary.done == 2
    assert [len(each.outcomes) for each in summary.points] == [2, 0]
