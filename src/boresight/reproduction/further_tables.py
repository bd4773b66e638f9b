"""Tables that the paper does not have: how answers depend on what it leaves open, and what others reach."""

from __future__ import annotations

import numpy as np

from boresight.reproduction.measurements import Measurements
from boresight.reproduction.paper_tables import numbers_of
from boresight.reproduction.pose_statements import orientation, position
from boresight.reproduction.setting import CANDIDATES, CASES
from boresight.reproduction.spread import Spread
from boresight.reproduction.statements import Judged
from boresight.reproduction.tables import Cell, Column, Table
from boresight.reproduction.trials import Run
from boresight.reproduction.variants import (
    AZIMUTH_FREE,
    CHOSEN,
    LEAST_SQUARES,
    MODERN,
    NOMINAL,
    OPEN,
    THREE_PLANES,
)
from boresight.reproduction.verdicts import NEAR

SISTER = {NOMINAL: (4.38, 5.08), 1: (1.77, 1.86), 2: (0.59, 0.87)}
"""Validation RMS [mm, mrad] of the sister paper (J. Robotics 2012, 587407): the same class of arm, a Jacobian-based
identification, other numbers throughout."""

WORDS = {
    "trade-off": "trade-off, K = 1/2",
    "rand-to-best/1": "rand-to-best/1, K = F",
    "current-to-best/1": "current-to-best/1, K = F",
}


def from_optimum(run: Run) -> float:
    """Returns the RMS range error over the optimum's."""
    return run.from_optimum


def strategy_table(found: Measurements) -> Table:
    """Returns the candidates for eq. (16) side by side, between the two classical strategies."""
    rows: list[tuple[Cell, ...]] = []
    for method in ("rand/1", *CANDIDATES, "best/1"):
        for case, count in CASES.items():
            ends = found.values(from_optimum, method, count)
            rows.append(
                (
                    WORDS.get(method, method),
                    case,
                    Spread.of(ends),
                    float(ends.max()),
                    float(np.mean(ends < NEAR)),
                    found.spread(position, method, count),
                )
            )
    return Table(
        "eq-16",
        "Strategies side by side",
        (
            Column("strategy", "strategy"),
            Column("case", "case"),
            Column("RMS range error over the optimum's", "from_optimum"),
            Column("worst seed", "from_optimum_worst"),
            Column("within 1 % of it", "share_within_1_percent", share=True),
            Column("validation position RMS, mm", "validation_position_rms_mm"),
        ),
        tuple(rows),
        "150 members, 500 generations, F = 0.6, CR = 0.9. The optimum is that of least squares on the same data.",
    )


def ambiguity_table(found: Measurements) -> Table:
    """Returns pose errors with theta_1 fixed and free, absolute and with the turn about z0 removed."""
    rows: list[tuple[Cell, ...]] = []
    for words, under in (("D = 25, θ1 fixed", CHOSEN), ("D = 26, θ1 free", AZIMUTH_FREE)):
        for case, count in CASES.items():
            numbers = (
                lambda run: run.range_rms_mm,
                position,
                lambda run: run.validation_turned.position_rms_mm,
                orientation,
                lambda run: run.validation_turned.orientation_rms_mrad,
            )
            rows.append((words, case, *(found.spread(number, "trade-off", count, under) for number in numbers)))
    return Table(
        "ambiguity",
        "θ1 fixed and free",
        (
            Column("free", "free"),
            Column("case", "case"),
            Column("range RMS, mm", "range_rms_mm", 2),
            Column("position, absolute, mm", "position_rms_mm", 2),
            Column("position, turn removed, mm", "turned_position_rms_mm", 2),
            Column("orientation, absolute, mrad", "orientation_rms_mrad", 2),
            Column("orientation, turn removed, mrad", "turned_orientation_rms_mrad", 2),
        ),
        tuple(rows),
        "RMS in the validation configurations, trade-off. Ranges fit equally well; only the pose in the base's frame "
        "differs. The turn removed is the one that fits positions best, so orientations may gain nothing by it.",
    )


def assumptions_table(found: Measurements) -> Table:
    """Returns how the main numbers depend on what the paper leaves open."""
    rows: list[tuple[Cell, ...]] = []
    for under in (CHOSEN, *OPEN):
        for case, count in CASES.items():
            ends = found.values(from_optimum, "trade-off", count, under)
            rows.append(
                (
                    under,
                    case,
                    found.spread(lambda run: run.range_max_mm, NOMINAL, count, under),
                    found.spread(lambda run: run.range_max_mm, "trade-off", count, under),
                    float(np.mean(ends < NEAR)),
                    found.spread(position, NOMINAL, count, under),
                    found.spread(position, "trade-off", count, under),
                )
            )
    return Table(
        "assumptions",
        "What if it was otherwise?",
        (
            Column("assumed", "assumed"),
            Column("case", "case"),
            Column("largest range error before, mm", "range_max_before_mm", 2),
            Column("largest range error after, mm", "range_max_after_mm", 2),
            Column("within 1 % of the optimum", "share_within_1_percent", share=True),
            Column("validation position RMS before, mm", "position_rms_before_mm"),
            Column("validation position RMS after, mm", "position_rms_after_mm", 2),
        ),
        tuple(rows),
        "Trade-off, K = 1/2.",
    )


def configurations_table(found: Measurements) -> Table:
    """Returns what more configurations bring."""
    rows: list[tuple[Cell, ...]] = [
        (
            count,
            found.spread(lambda run: run.range_rms_mm, "trade-off", count),
            found.spread(position, "trade-off", count),
            found.spread(orientation, "trade-off", count),
        )
        for count in (35, 50, 100, 200)
    ]
    return Table(
        "configurations",
        "In numbers",
        (
            Column("configurations", "configurations"),
            Column("range RMS, mm", "range_rms_mm"),
            Column("validation position RMS, mm", "validation_position_rms_mm"),
            Column("validation orientation RMS, mrad", "validation_orientation_rms_mrad"),
        ),
        tuple(rows),
        "Range errors grow towards the noise of a row, 0.063 mm, because fewer parameters a reading are left to hide "
        "it; pose errors fall.",
    )


def methods(found: Measurements) -> list[tuple[str, str, str]]:
    """Returns (words, method, assumptions) of everything compared, from the worst known beforehand."""
    return [
        ("nominal", NOMINAL, CHOSEN),
        ("DE/rand/1", "rand/1", CHOSEN),
        ("DE/best/1", "best/1", CHOSEN),
        ("trade-off, K = 1/2", "trade-off", CHOSEN),
        *((name, name, CHOSEN) for name in (MODERN if found.modern else ())),
        ("least squares from nominal", LEAST_SQUARES, CHOSEN),
        ("least squares, three planes", LEAST_SQUARES, THREE_PLANES),
    ]


def beside_table(found: Measurements) -> Table:
    """Returns what other methods reach, and the sister paper's numbers."""
    rows: list[tuple[Cell, ...]] = []
    for case, count in CASES.items():
        before, after = SISTER[NOMINAL], SISTER[case]
        rows.append(
            (
                f"sister paper, nominal → its case {case}",
                case,
                "–",
                *(f"{a} → {b}" for a, b in zip(before, after, strict=True)),
                "–",
                "–",
            )
        )
        for words, method, under in methods(found):
            ends = found.values(from_optimum, method, count, under)
            runs = found.runs(method, count, under)
            rows.append(
                (
                    words,
                    case,
                    Spread.of(ends),
                    found.spread(position, method, count, under),
                    found.spread(orientation, method, count, under),
                    "–" if method == NOMINAL else int(np.median([run.evaluations for run in runs])),
                    "–" if method == NOMINAL else 1e3 * float(np.median([run.seconds for run in runs])),
                )
            )
    return Table(
        "beside",
        "All methods in numbers",
        (
            Column("method", "method"),
            Column("case", "case"),
            Column("RMS range error over the optimum's", "from_optimum"),
            Column("validation position RMS, mm", "validation_position_rms_mm"),
            Column("validation orientation RMS, mrad", "validation_orientation_rms_mrad"),
            Column("evaluations", "evaluations"),
            Column("time, ms", "milliseconds", 2, in_csv=False),
        ),
        tuple(rows),
        "Evaluations and time: median of a run on one core of this machine, others at work on it as may be. Three "
        "planes: as many readings, taken in turn against plane (23) and two surveyed walls, θ1 free.",
    )


def statements_table(judged: tuple[Judged, ...]) -> Table:
    """Returns the statements as a plain table, for the CSV."""
    return Table(
        "statements",
        "The paper's statements",
        tuple(Column(key, key) for key in ("place", "says", "verdict", "seeds_that_agree", "found")),
        tuple(
            (
                each.statement.place,
                each.statement.says,
                each.finding.verdict.value,
                "; ".join(answer.text() for answer in each.finding.answers),
                each.finding.found,
            )
            for each in judged
        ),
    )


def runs_table(found: Measurements) -> Table:
    """Returns every run of every seed, for the CSV."""
    names = list(numbers_of(next(iter(found.trials[0].runs.values()))))
    return Table(
        "runs",
        "Every run",
        tuple(Column(name, name) for name in ("seed", "method", "configurations", "assumed", *names)),
        tuple(
            (trial.seed, variant.method, variant.rows, variant.under, *numbers_of(run).values())
            for trial in found.trials
            for variant, run in trial.runs.items()
        ),
    )
