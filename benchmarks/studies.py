"""Monte Carlo: 10,000 case-1 calibrations by evolution on two cores, and what two cores are worth.

Everything that a study does is in the time: workers started, truth, configurations and readings drawn, 150 members
through all of 500 generations (no early stop), 35 readings, 25 parameters, errors judged in validation configurations,
the known optimum found for comparison, every run committed to sqlite. Compiled code is on disk beforehand. The ratio
compares one worker and two on the same study, one after the other, in rounds; the best round counts for each.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from benchmarks.report import Figure, Report, Table
from benchmarks.space_arm import one_plane
from boresight.studies import Bench, Chosen, Settings, Study, grid, study
from boresight.studies import run as run_once

RUNS, MINUTES, RATIO = 10_000, 4.0, 1.8
FEW_RUNS, ROUNDS = 600, 3


def case1(seeds: int) -> Study:
    """Returns the study: the example `space-arm-one-plane` with 35 rows, by evolution alone."""
    kind = one_plane(35)
    settings = Settings(
        planes=Chosen("1", ("deck",)), noise_std=2e-4, repeats=10, rows=35, solver="evolution", patience=10**9
    )
    return Study("case-1", grid({"space-arm": Bench(kind.cell, kind.freedoms)}, {}, settings), (), seeds)


def timed(seeds: int, workers: int) -> tuple[float, float]:
    """Returns the seconds that a study takes, all included, and those from its first kept outcome to the last.

    The second is scaled to all runs: it leaves out the start of the workers, which does not grow with the study.
    """
    seen: list[tuple[float, int]] = []
    with tempfile.TemporaryDirectory() as folder:
        began = time.perf_counter()
        found = study(
            case1(seeds),
            Path(folder) / "runs.sqlite",
            workers=workers,
            on_progress=lambda done, _: seen.append((time.perf_counter(), done)),
        )
        whole = time.perf_counter() - began
    assert found.done == seeds
    first, last = next(each for each in seen if each[1]), seen[-1]
    return whole, (last[0] - first[0]) * seeds / (last[1] - first[1])


def run(quick: bool) -> Report:
    """Returns times and the ratio of cores."""
    run_once(case1(1).points[0], 0)
    few = FEW_RUNS // 6 if quick else FEW_RUNS
    rounds = [(timed(few, 1)[1], timed(few, 2)[1]) for _ in range(1 if quick else ROUNDS)]
    one, two = (min(each) for each in zip(*rounds, strict=True))
    seeds = RUNS // 50 if quick else RUNS
    whole, steady = timed(seeds, 2)
    minutes = (steady * RUNS / seeds if quick else whole) / 60.0
    figures = (
        Figure(
            f"{RUNS:,} case-1 calibrations by evolution, two workers" + (", extrapolated" if quick else ""),
            f"{minutes:.2f} min",
            f"<= {MINUTES:g} min",
            minutes <= MINUTES,
        ),
        Figure("two workers over one", f"{one / two:.2f}", f">= {RATIO}", one / two >= RATIO),
    )
    rows = (
        ("1", f"{few:,}", f"{1e3 * one / few:.1f}", f"{1e3 * one / few:.1f}"),
        ("2", f"{few:,}", f"{1e3 * two / few:.1f}", f"{2e3 * two / few:.1f}"),
        ("2", f"{seeds:,}", f"{1e3 * steady / seeds:.1f}", f"{2e3 * steady / seeds:.1f}"),
    )
    return Report(
        "studies",
        "See the module's docstring.",
        figures,
        (Table("Time of a run, workers' start left out", ("workers", "runs", "ms a run", "ms a run and core"), rows),),
    )
