"""All runs as tables, a line a scenario, and the figures that count."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

import numpy as np

from benchmarks.report import Figure, Table, percent
from benchmarks.trust.faults.fault import NONE
from benchmarks.trust.judging import OUTCOMES
from benchmarks.trust.running import Record
from benchmarks.trust.scenarios import FAMILIES, SCENARIOS

HEADER = (
    "scenario",
    "seeds",
    *OUTCOMES,
    "relative",
    "before, mm",
    "true error, mm",
    "claimed, mm",
    "error / claimed, 95 %",
    "turn / claimed, 95 %",
    "named",
)
NAMES = 3
"""Most frequent names shown."""


def tables_of(records: Iterable[Record]) -> tuple[Table, ...]:
    """Returns one table for each family of scenarios that has runs."""
    runs: dict[str, list[Record]] = {}
    for record in records:
        runs.setdefault(record.scenario, []).append(record)
    return tuple(
        Table(title, HEADER, tuple(line_of(name, runs[name]) for name in names))
        for title, family in FAMILIES.items()
        if (names := [each.name for each in family if each.name in runs])
    )


def line_of(name: str, runs: list[Record]) -> tuple[str, ...]:
    """Returns a scenario's line; errors and claims are medians over the runs that are accepted."""
    counts = Counter(run.outcome for run in runs)
    accepted = [run for run in runs if run.outcome not in ("rejected", "crash")]
    names = Counter(name for run in runs for name in run.named)
    return (
        name,
        str(len(runs)),
        *(str(counts[outcome] or "") for outcome in OUTCOMES),
        str(sum(run.accuracy == "relative" for run in accepted) or ""),
        *(_median_mm(accepted, each) for each in ("before", "error", "claimed")),
        *(_percentile_95(accepted, each) for each in ("ratio", "angle_ratio")),
        ", ".join(f"{each} {count}" for each, count in names.most_common(NAMES)),
    )


def figures_of(records: Iterable[Record]) -> tuple[Figure, ...]:
    """Returns silently wrong runs, crashes, and how often a claim holds where nothing is wrong."""
    runs = list(records)
    silent, crashed = (sum(run.outcome == each for run in runs) for each in ("SILENT", "crash"))
    clean = [run for run in runs if SCENARIOS[run.scenario].fault is NONE]
    accepted = [run for run in clean if run.outcome not in ("rejected", "crash")]
    figures = [
        Figure("silently wrong", f"{silent} of {len(runs)}", "0", silent == 0),
        Figure("crashed", f"{crashed} of {len(runs)}", "0", crashed == 0),
    ]
    used = [run for run in runs if run.outcome not in ("rejected", "crash")]
    worse = sum(run.error > run.before for run in used)
    figures.append(Figure("accepted, tool worse than nominal", f"{worse} of {len(used)}", "0", worse == 0))
    if accepted:
        held = float(np.mean([run.ratio <= 1.0 for run in accepted]))
        share = len(accepted) / len(clean)
        figures += [
            Figure("claimed radius holds, nothing wrong", percent(held), ">= 95 %", held >= 0.95),
            Figure("accepted, nothing wrong", percent(share), ">= 90 %", share >= 0.90),
        ]
    return tuple(figures)


def _median_mm(runs: list[Record], field: str) -> str:
    return f"{1e3 * np.median([getattr(run, field) for run in runs]):.3g}" if runs else ""


def _percentile_95(runs: list[Record], field: str) -> str:
    return f"{np.percentile([getattr(run, field) for run in runs], 95):.2g}" if runs else ""
