"""The charts of a report as places in an SVG drawing; the template only puts marks there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from boresight.calibration.result import Estimate, Result
from boresight.report.axes import Axis, linear_axis, log_axis

_MOST_ROWS = 1000
"""Rows drawn, two marks each: 100,000 rows would make a page of 8 MB that shows no more."""

_LARGEST = 50
"""Rows with the largest errors that are drawn whatever else is left out."""

_SHOWN_QUANTILE = 0.02
"""Errors below this quantile lie on the lower edge: a few that happen to be 0 would squeeze the rest together."""

_MOST_OUTLIERS = 200

_ROW_HEIGHT = 19
_LONGEST_NAME = 24
_LETTER = 6.7

_PANELS = (("rad", "Angles", "mrad", 1e3), ("m", "Lengths", "mm", 1e3), ("1", "Plane normals", "10⁻³", 1e3))


@dataclass(frozen=True, slots=True)
class ErrorsChart:
    """Sizes of the calibration rows' errors [mm], before and after.

    Attributes:
        x, y: line of the observations file; size.
        before, after: SVG paths of the marks.
        outliers: SVG path of the squares around the rows that stand out.
        noise: height of the stated noise; None where it is off the axis.
        shown, rows: rows drawn, and rows there are.
        missed: rows of either series that have no error, their beam looking away.
    """

    x: Axis
    y: Axis
    before: str
    after: str
    outliers: str
    noise: float | None
    shown: int
    rows: int
    missed: int


@dataclass(frozen=True, slots=True)
class ConvergenceChart:
    """Cost by generation [mm²]: x, y, and the SVG paths of the best and the mean."""

    x: Axis
    y: Axis
    best: str
    mean: str


@dataclass(frozen=True, slots=True)
class Bar:
    """One correction: its label, the places of its value and interval, which ends lie off the axis, its source."""

    name: str
    label: str
    words: str
    at: float
    low: float
    high: float
    off_low: bool
    off_high: bool
    source: str
    y: float


@dataclass(frozen=True, slots=True)
class CorrectionsChart:
    """Corrections of one kind of parameter with their 95 % intervals."""

    title: str
    unit: str
    x: Axis
    zero: float
    bars: tuple[Bar, ...]
    height: int


def errors_chart(result: Result) -> ErrorsChart | None:
    """Returns the chart of each calibration row's error before and after; None if no row has one."""
    before, after = (np.linalg.norm(result.errors[when], axis=1) * 1e3 for when in ("before", "after"))
    both = np.concatenate([before, after])
    positive = both[np.isfinite(both) & (both > 0.0)]
    if not positive.size:
        return None
    noise = result.readings.usual_row_std * 1e3
    high = float(positive.max())
    low = max(float(np.quantile(positive, _SHOWN_QUANTILE)), high * 1e-9)
    line = result.readings.line
    x = linear_axis(float(line.min()), float(line.max()), 62, 884, most=10)
    y = log_axis(min(low, noise) if noise > high * 1e-9 else low, max(high, noise), 262, 26)
    worst = np.isin(line, [outlier.line for outlier in result.outliers[:_MOST_OUTLIERS]])
    drawn = _thinned(len(before), np.nan_to_num(after)) | worst
    return ErrorsChart(
        x,
        y,
        _marks(x.at(line), y.at(before), drawn, "m-2.6 0a2.6 2.6 0 1 0 5.2 0a2.6 2.6 0 1 0-5.2 0"),
        _marks(x.at(line), y.at(after), drawn, "h0"),
        _marks(x.at(line), y.at(after), worst, "m-5.5-5.5h11v11h-11z"),
        float(y.at(np.array(noise))) if noise > high * 1e-9 else None,
        int(drawn.sum()),
        len(before),
        int(np.count_nonzero(~np.isfinite(before) | ~np.isfinite(after))),
    )


def convergence_chart(history: Float[np.ndarray, "generations 2"]) -> ConvergenceChart | None:
    """Returns the chart of evolution's best and mean cost [m²]; None if none ran."""
    cost = history * 1e6
    positive = cost[np.isfinite(cost) & (cost > 0.0)]
    if len(history) < 2 or not positive.size:
        return None
    x = linear_axis(0, len(history) - 1, 62, 424, most=5)
    y = log_axis(max(float(positive.min()), float(positive.max()) * 1e-12), float(positive.max()), 262, 26)
    kept = np.unique(np.linspace(0, len(history) - 1, min(len(history), _MOST_ROWS)).astype(int))
    return ConvergenceChart(x, y, *(_line(x, y, kept, cost[kept, column]) for column in (0, 1)))


def correction_charts(estimates: Sequence[Estimate]) -> tuple[CorrectionsChart, ...]:
    """Returns a chart for the corrections of angles, lengths and plane normals, where there are any."""
    charts = (_corrections(estimates, *panel) for panel in _PANELS)
    return tuple(chart for chart in charts if chart is not None)


def _corrections(
    estimates: Sequence[Estimate], unit: str, title: str, shown_unit: str, factor: float
) -> CorrectionsChart | None:
    """Returns one panel; the axis spans what the data decide, and a wider prior's interval runs off it."""
    free = [
        (one, one.correction * factor, 2.0 * one.std * factor)
        for one in estimates
        if one.unit == unit and one.source != "fixed" and one.correction is not None and np.isfinite(one.correction)
    ]
    if not free:
        return None
    spans = [(value, half if one.source == "data" and np.isfinite(half) else 0.0) for one, value, half in free]
    low = min(0.0, *(value - half for value, half in spans))
    high = max(0.0, *(value + half for value, half in spans))
    if high == low:
        low, high = -max(half for *_, half in free) or -1.0, max(half for *_, half in free) or 1.0
    labels = [_shortened(one.name) for one, *_ in free]
    left = 14 + _LETTER * max(map(len, labels))
    margin = 0.05 * (high - low)
    x = linear_axis(low - margin, high + margin, left, 428, most=5)
    bars = []
    for row, ((one, value, half), label) in enumerate(zip(free, labels, strict=True)):
        half = half if np.isfinite(half) else 0.0
        at, start, end = (float(place) for place in x.at(np.array([value, value - half, value + half])))
        words = f"{one.name}: {value:.4g} ± {half:.2g} {shown_unit}, from {one.source}"
        off = (value - half < x.low, value + half > x.high)
        bars.append(Bar(one.name, label, words, at, start, end, *off, one.source, 20 + (row + 0.5) * _ROW_HEIGHT))
    return CorrectionsChart(title, shown_unit, x, float(x.at(np.array(0.0))), tuple(bars), 20 + len(bars) * _ROW_HEIGHT)


def _thinned(count: int, sizes: Float[np.ndarray, "rows"]) -> Bool[np.ndarray, "rows"]:
    """Returns which rows to draw: evenly spaced ones, and the largest."""
    if count <= _MOST_ROWS:
        return np.ones(count, dtype=bool)
    drawn = np.zeros(count, dtype=bool)
    drawn[np.argsort(sizes)[-_LARGEST:]] = True
    drawn[np.linspace(0, count - 1, _MOST_ROWS - _LARGEST).astype(int)] = True
    return drawn


def _marks(across: Float[np.ndarray, "rows"], up: Float[np.ndarray, "rows"], drawn: np.ndarray, mark: str) -> str:
    kept = drawn & np.isfinite(up)
    return "".join(f"M{x:.1f} {y:.1f}{mark}" for x, y in zip(across[kept], up[kept], strict=True))


def _line(x: Axis, y: Axis, generations: np.ndarray, cost: np.ndarray) -> str:
    known = np.isfinite(cost)
    points = zip(x.at(generations[known].astype(float)), y.at(cost[known]), strict=True)
    return "M" + "L".join(f"{a:.1f} {b:.1f}" for a, b in points) if known.any() else ""


def _shortened(name: str) -> str:
    return name if len(name) <= _LONGEST_NAME else "…" + name[1 - _LONGEST_NAME :]
