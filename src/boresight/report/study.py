"""A study's summary: on a terminal, as JSON, and in a folder with every run as CSV and the figures."""

from __future__ import annotations

import csv
import io
import json
import math
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.measure import Measurement
from rich.table import Table

from boresight.files.names import csv_word
from boresight.files.writing import write_atomically
from boresight.studies import AXES, Outcome, Summary
from boresight.studies.axes import TITLES, shown
from boresight.studies.summary import PointSummary, Share, Spread

SCHEMA = "boresight-study/1"

_SPREADS = (
    "nominal_position_rms",
    "nominal_orientation_rms",
    "position_rms",
    "position_max",
    "orientation_rms",
    "position_95",
    "inside_95",
    "calibration_rms",
    "validation_rms",
    "cost",
    "optimum",
    "model_std",
    "evaluations",
    "seconds",
)


def print_study(console: Console, summary: Summary, folder: Path | None) -> None:
    """Prints what the runs say, a line a point."""
    study = summary.study
    console.print(
        f"[bold]{escape(study.name)}[/]  {summary.done:,} of {len(study):,} runs, "
        f"{len(study.points)} point{'s' if len(study.points) != 1 else ''} of {study.seeds:,} seeds"
    )
    table = _table(summary)
    if not console.is_terminal:  # what is piped has no width of its own: nothing is cut short
        console.width = max(
            console.width, Measurement.get(console, console.options.update(max_width=1000), table).maximum
        )
    console.print(table)
    console.print("  Position and angle of the tool at validation configurations, RMS: medians.")
    failures = [o.failure for each in summary.points for o in each.outcomes.values() if o.failure]
    if failures:
        console.print(f"[yellow]Warning:[/] {len(failures)} runs could not be made, the first: {escape(failures[0])}")
    if folder is not None:
        console.print(f"Files: [bold]{escape(str(folder))}/[/]", soft_wrap=True)


def _table(summary: Summary) -> Table:
    varied, gross = summary.study.varied, any(p.point.settings.gross_errors for p in summary.points)
    table = Table(box=None, padding=(0, 1), pad_edge=True)
    for axis in varied:
        table.add_column(TITLES[axis].replace(" ", "\n", 1), justify="right", style="bold", no_wrap=True)
    titles = ("runs", "before\nmm", "after\nmm", "90 %\nmm", "angle\nmrad", "inside\n95 %", "at the\noptimum")
    for title in (*titles, *(("gross\nfound",) if gross else ()), "search\nms"):
        table.add_column(title, justify="right", no_wrap=True)
    for each in summary.points:
        table.add_row(*(shown(axis, each.point.label(axis)) for axis in varied), *_cells(each, gross))
    return table


def _cells(each: PointSummary, gross: bool) -> list[str]:
    position = each.spread("position_rms")
    inside = [outcome.inside_95 for outcome in each.good]
    return [
        f"{len(each.outcomes):,}",
        _digits(1e3 * each.spread("nominal_position_rms").median),
        _digits(1e3 * position.median),
        _digits(1e3 * position.high),
        _digits(1e3 * each.spread("orientation_rms").median),
        _percent(sum(inside) / len(inside)) if inside else "–",
        _percent(each.reached.value),
        *([_percent(each.found.value)] if gross else []),
        _digits(1e3 * each.spread("seconds").median),
    ]


def study_json(summary: Summary, version: str) -> str:
    """Returns the summary as JSON: SI units, null where there is no number."""
    study = summary.study
    document = {
        "schema": SCHEMA,
        "version": version,
        "name": study.name,
        "seeds": study.seeds,
        "runs": {"done": summary.done, "asked": len(study)},
        "varied": list(study.varied),
        "points": [_point(each) for each in summary.points],
    }
    return json.dumps(_finite(document), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _point(each: PointSummary) -> dict[str, Any]:
    point = each.point
    return {
        "key": point.key,
        "settings": {axis: point.label(axis) for axis in AXES},
        "free": len(point.freedoms),
        "runs": len(each.outcomes),
        "failed": each.failed,
        "reached_optimum": _share(each.reached),
        "gross_errors_found": _share(each.found),
        **{name: _spread(each.spread(name)) for name in _SPREADS},
    }


def _share(share: Share) -> dict[str, Any]:
    return {"count": share.count, "of": share.of, "share": share.value, "interval_95": list(share.interval)}


def _spread(spread: Spread) -> dict[str, float]:
    return {"p10": spread.low, "median": spread.median, "p90": spread.high}


def runs_csv(summary: Summary) -> str:
    """Returns every run: what was varied, the seed and the outcome; lengths in metres, angles in radians."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    names = [field.name for field in fields(Outcome)]
    writer.writerow([*AXES, "seed", *names])
    for each in summary.points:
        labels = (each.point.label(axis) for axis in AXES)
        settings = [csv_word(label) if isinstance(label, str) else label for label in labels]
        for seed, outcome in each.outcomes.items():
            writer.writerow([*settings, seed, *(_cell(value) for value in asdict(outcome).values())])
    return text.getvalue()


def write_study(summary: Summary, folder: Path, version: str) -> Path:
    """Returns the folder with `summary.json`, `runs.csv` and the figures of a study, as far as it is done."""
    from boresight.plots import save
    from boresight.studies.charts import accuracy_figure, effort_figure, reliability_figure

    write_atomically(folder / "runs.csv", runs_csv(summary))
    if any(each.good for each in summary.points):
        for name, draw in (
            ("accuracy", accuracy_figure),
            ("reliability", reliability_figure),
            ("effort", effort_figure),
        ):
            save(draw(summary), folder / name)
    write_atomically(folder / "summary.json", study_json(summary, version))
    return folder


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(each) for key, each in value.items()}
    if isinstance(value, list):
        return [_finite(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _cell(value: Any) -> Any:
    if isinstance(value, float):
        return f"{value:.9g}" if math.isfinite(value) else ""
    return value


def _digits(value: float) -> str:
    """Returns three digits that matter."""
    if not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    return f"{value:.{max(0, 2 - math.floor(math.log10(abs(value))))}f}"


def _percent(share: float) -> str:
    return f"{100 * share:.0f} %" if math.isfinite(share) else "–"
