"""Verdicts follow from measurements: each statement can hold and can fail."""

from dataclasses import replace

import numpy as np
import pytest

from boresight.reproduction.measurements import Measurements
from boresight.reproduction.pose_errors import PoseErrors
from boresight.reproduction.statements import STATEMENTS, judge
from boresight.reproduction.variants import AZIMUTH_FREE, NOMINAL
from boresight.reproduction.verdicts import FAILS, HOLDS, Answer, Finding, Verdict


@pytest.mark.parametrize(
    ("shares", "verdict"),
    [
        ((1.0, HOLDS), Verdict.HOLDS),
        ((1.0, HOLDS - 0.01), Verdict.PARTLY),
        ((1.0, 0.0), Verdict.PARTLY),
        ((FAILS, 0.0), Verdict.PARTLY),
        ((FAILS - 0.01, 0.0), Verdict.FAILS),
    ],
)
def test_a_verdict_is_decided_by_shares_of_seeds(shares, verdict):
    assert Finding(tuple(Answer("yes?", share) for share in shares), "").verdict is verdict


def altered(found, change, ranks=None):
    """Measurements with every run, and ranks, replaced."""
    return Measurements(
        tuple(
            replace(
                trial,
                runs={variant: change(variant, run) for variant, run in trial.runs.items()},
                ranks=replace(trial.ranks, **(ranks or {})),
            )
            for trial in found.trials
        ),
        found.modern,
    )


def poses(errors, factor):
    return replace(errors, position_mm=errors.position_mm * factor, orientation_mrad=errors.orientation_mrad * factor)


def even(size):
    return PoseErrors(np.full(20, size), np.full(20, size))


def with_poses(change):
    """Scales pose errors by a factor of the variant."""

    def changed(variant, run):
        factor = change(variant)
        return replace(
            run,
            validation=poses(run.calibration, factor),
            validation_turned=poses(run.calibration, factor),
            calibration=run.calibration,
        )

    return changed


def with_ranges(of):
    """Makes the largest range error what a function of the variant says [mm]."""
    return lambda variant, run: replace(run, range_mm=run.range_mm / np.abs(run.range_mm).max() * of(variant))


def with_costs(of):
    """Makes the final cost a multiple of the optimum's."""
    return lambda variant, run: replace(run, cost_mm2=run.optimum_mm2 * of(variant))


def with_history(of):
    """Makes the costs of every generation what a function of the generation and the variant says."""
    return lambda variant, run: replace(run, history_mm2=of(np.arange(501.0), variant))


def classical(variant):
    return variant.method in ("rand/1", "best/1")


def falling(steepness):
    return lambda g, _: 1e6 * np.exp(-((g / 500.0) ** steepness) * 20.0)


def alone(variant):
    return 1.0


def by_rows(power):
    return lambda variant: float(variant.rows) ** power


FLIPS = {
    "more than 30 mm": (with_ranges(lambda v: 31.0), with_ranges(lambda v: 29.0)),
    "less than 0.2 mm": (with_ranges(lambda v: 0.19), with_ranges(lambda v: 0.21)),
    "first two classical": (with_costs(lambda v: 20.0 if classical(v) else 1.0), with_costs(alone)),
    "DE/rand/1": (with_costs(lambda v: 121.0), with_costs(lambda v: 1.2)),
    "decline steeply": (with_history(falling(0.5)), with_history(lambda g, _: falling(3.0)(g, _)[:400])),
    "stability": (with_costs(lambda v: 1.001), with_costs(lambda v: 1.1)),
    "significant improvement": (
        with_poses(lambda v: 3.0 if v.method == NOMINAL else 1e-3),
        with_poses(lambda v: 1e-3 if v.method == NOMINAL else 1.0),
    ),
    "case 2 improves": (with_poses(by_rows(-3.0)), with_poses(by_rows(3.0))),
    "More calibration": (with_poses(by_rows(-3.0)), with_poses(by_rows(3.0))),
    "configurations is superior": (with_poses(lambda v: 1.5), with_poses(lambda v: 0.9)),
    "minor effect": (
        lambda v, run: replace(run, validation=even(1.0), validation_turned=even(1.0)),
        lambda v, run: replace(
            run, validation=even(2.0 if v.under == AZIMUTH_FREE else 1.0), validation_turned=even(2.0)
        ),
    ),
}


@pytest.mark.parametrize("words", FLIPS)
def test_a_statement_holds_or_fails_by_what_was_measured(found, words):
    (statement,) = (each for each in STATEMENTS if words in each.says)
    good, bad = FLIPS[words]
    assert statement.measure(altered(found, good)).verdict is Verdict.HOLDS
    assert statement.measure(altered(found, bad)).verdict is Verdict.FAILS


def test_best_1_must_be_fast_and_caught_to_be_as_the_paper_says(found):
    (statement,) = (each for each in STATEMENTS if "DE/best/1" in each.says)

    def measured(best, other, end):
        def change(variant, run):
            rate = best if variant.method == "best/1" else other
            return replace(run, history_mm2=1e6 * np.exp(-rate * np.arange(501.0)), cost_mm2=run.optimum_mm2 * end)

        return statement.measure(altered(found, change)).verdict

    assert measured(0.2, 0.1, 4.0) is Verdict.HOLDS
    assert measured(0.2, 0.1, 1.0) is Verdict.PARTLY
    assert measured(0.1, 0.2, 1.0) is Verdict.FAILS


@pytest.mark.parametrize(
    ("words", "good", "bad"),
    [
        ("25 identifiable", {"of_paper": 25}, {"of_paper": 26}),
        ("They are 25 because", {"of_one_plane": 25}, {"of_one_plane": 26}),
        ("2R + 2P", {"of_pose": 18}, {"of_pose": 19}),
        ("z + f = 0", {}, {"of_floor": 24, "blind_to": ()}),
    ],
)
def test_a_count_holds_or_fails_by_the_ranks(found, words, good, bad):
    (statement,) = (each for each in STATEMENTS if words in each.says)
    same = altered(found, lambda variant, run: run, good)
    other = altered(found, lambda variant, run: run, bad)
    expected = Verdict.PARTLY if "2R" in words else Verdict.HOLDS  # 30 and 2R + 2P + 6 cannot both be
    assert statement.measure(same).verdict is expected
    assert statement.measure(other).verdict is Verdict.FAILS


def test_every_statement_has_a_place_and_is_judged_with_numbers(found):
    judged = judge(found)
    assert len(judged) == len(STATEMENTS) == len({each.statement.says for each in judged})
    for each in judged:
        assert each.statement.place
        assert any(character.isdigit() for character in each.finding.found)
        assert all(0.0 <= answer.share <= 1.0 for answer in each.finding.answers)


def test_what_the_ranges_can_see_is_as_the_design_says(found):
    for trial in found.trials:
        ranks = trial.ranks
        assert (ranks.of_paper, ranks.of_pose, ranks.of_one_plane, ranks.of_floor) == (25, 30, 26, 21)
        assert set(ranks.blind_to) == {"j1.theta", "j1.a", "j3.d"}
