"""A study in three figures: how accurate, how reliable, how dear; a panel for everything that is varied."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from boresight.plots import COLOURS, panels
from boresight.studies.axes import LONG_TITLES, TITLES, is_number, number, shown
from boresight.studies.summary import PointSummary, Summary

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_LINES = 5
"""A panel with more lines cannot be read: of more values the first, the last and some between are shown."""

MOST_PANELS = 4
"""The same of panels that differ in what their lines leave open."""

_PANEL = (5.4, 3.1)
_MARKERS = "osD^vP"

Line = tuple[str, Sequence[PointSummary]]


def accuracy_figure(summary: Summary) -> Figure:
    """Returns the tool's position error against what is varied: medians, and where 80 % of the campaigns lie."""
    figure = _figure(summary, _medians_of("position_rms"), "position error of the tool, mm (RMS)")
    drawn = [axes for axes in figure.axes if axes.has_data()]
    for axes in drawn:
        _logarithmic(axes)
    _alike(drawn)
    return figure


def reliability_figure(summary: Summary) -> Figure:
    """Returns the share of campaigns whose search ended at the optimum, with 95 % intervals."""

    def draw(axes: Axes, x: np.ndarray, line: Sequence[PointSummary], look: dict[str, Any]) -> None:
        values = np.array([each.reached.value for each in line])
        low, high = np.array([each.reached.interval for each in line]).T
        bars = 100 * np.maximum([values - low, high - values], 0.0)
        axes.errorbar(x, 100 * values, yerr=bars, capsize=2.5, elinewidth=0.9, **look)
        axes.set_ylim(-4, 104)

    return _figure(summary, draw, "searches that ended at the optimum, %")


def effort_figure(summary: Summary) -> Figure:
    """Returns the time of a search against what is varied: medians, and where 80 % lie."""
    figure = _figure(summary, _medians_of("seconds"), "time of one search, ms")
    drawn = [axes for axes in figure.axes if axes.has_data()]
    _alike(drawn)
    for axes in drawn:
        axes.set_ylim(bottom=0.0)
    return figure


def _medians_of(outcome: str) -> Callable[..., None]:
    """Returns what draws a line of medians of an outcome, in thousandths, with bars that hold 80 %."""

    def draw(axes: Axes, x: np.ndarray, line: Sequence[PointSummary], look: dict[str, Any]) -> None:
        spread = [each.spread(outcome) for each in line]
        low, median, high = (1e3 * np.array([getattr(s, part) for s in spread]) for part in ("low", "median", "high"))
        bars = np.maximum([median - low, high - median], 0.0)
        axes.errorbar(x, median, yerr=bars, capsize=2.5, elinewidth=0.9, **look)

    return draw


def _alike(drawn: Sequence[Axes]) -> None:
    """Gives all panels the same heights, so that they can be compared."""
    limits = np.array([axes.get_ylim() for axes in drawn])
    for axes in drawn:
        axes.set_ylim(limits[:, 0].min(), limits[:, 1].max())


def _figure(summary: Summary, draw: Callable[..., None], what: str) -> Figure:
    """Returns a figure with a panel for each varied thing and each setting that its lines leave open."""
    shown_panels = _panels(summary)
    columns = min(len(shown_panels), 2)
    rows = -(-len(shown_panels) // columns)
    figure, axes = panels(rows, columns, _PANEL)
    for place, (axis, title, lines) in enumerate(shown_panels):
        _panel(axes.flat[place], axis, title, lines, draw, what if place % columns == 0 else "")
    for empty in axes.flat[len(shown_panels) :]:
        empty.set_axis_off()
    return figure


def _panels(summary: Summary) -> list[tuple[str, str, list[Line]]]:
    """Returns (varied thing, title, lines) of every panel.

    Lines differ in all other things where these are few, else in the one of most values; panels then in what is left.
    """
    done = [each for each in summary.points if each.good]
    varied = summary.study.varied or ("rows",)
    found = []
    for axis in varied:
        others = [other for other in varied if other != axis]
        by = others
        if len(_groups(done, others)) > MOST_LINES and len(others) > 1:
            by = [max(others, key=lambda other: len(_groups(done, [other])))]
        left = [other for other in others if other not in by]
        for title, part in _thinned(list(_groups(done, left).items()), MOST_PANELS):
            found.append((axis, title, _thinned(_lines(part, by), MOST_LINES)))
    return found


def _thinned(items: list[Any], most: int) -> list[Any]:
    """Returns all items, or where they are too many the first, the last and some evenly between."""
    if len(items) <= most:
        return items
    return [items[place] for place in np.unique(np.linspace(0, len(items) - 1, most).round().astype(int))]


def _lines(points: Sequence[PointSummary], by: Sequence[str]) -> list[Line]:
    return list(_groups(points, by).items())


def _groups(points: Sequence[PointSummary], by: Sequence[str]) -> dict[str, list[PointSummary]]:
    """Returns points by their settings of some things, in words."""
    groups: dict[str, list[PointSummary]] = {}
    for each in points:
        words = ", ".join(_worded(axis, each.point.label(axis)) for axis in by)
        groups.setdefault(words, []).append(each)
    return groups


def _worded(axis: str, value: Any) -> str:
    if axis == "planes":
        return f"{value} plane{'s' if value != '1' else ''}" if value.isdigit() else value
    if axis in ("rows", "repeats"):
        word = TITLES[axis].removesuffix("s") if value == 1 else TITLES[axis]
        return f"{shown(axis, value)} {word}"
    if axis in ("solver", "strategy", "robot"):
        return shown(axis, value)
    if axis == "noise_std":
        return f"{shown(axis, value)} mm noise"
    if axis == "fixed":
        return f"{shown(axis, value)} held"
    if axis == "gross_errors":
        return "no gross errors" if value == 0 else f"{shown(axis, value)} gross errors"
    return f"{TITLES[axis]} {shown(axis, value)}"


def _panel(axes: Axes, axis: str, title: str, lines: Sequence[Line], draw: Callable[..., None], what: str) -> None:
    values = list(dict.fromkeys(each.point.label(axis) for _, line in lines for each in line))
    numeric = is_number(axis) and None not in values
    for place, (name, line) in enumerate(lines):
        look: dict[str, Any] = {
            "color": COLOURS[place % len(COLOURS)],
            "marker": _MARKERS[place % len(_MARKERS)],
            "label": name or None,
        }
        beside = 0.09 * (place - 0.5 * (len(lines) - 1))
        if numeric:
            line = sorted(line, key=lambda each: number(axis, each.point.label(axis)))
            x = np.array([number(axis, each.point.label(axis)) for each in line])
            x = _beside(x, beside)
        else:
            x = np.array([values.index(each.point.label(axis)) for each in line]) + beside
            look["linestyle"] = "none"
        draw(axes, x, line, look)
    axes.set_title(title, loc="left", fontsize=9.5)
    axes.set_xlabel(LONG_TITLES[axis])
    axes.set_ylabel(what)
    if numeric:
        _number_ticks(axes, sorted(number(axis, value) for value in values))
    else:
        axes.set_xticks(range(len(values)), [_wrapped(shown(axis, value)) for value in values])
        axes.set_xlim(-0.5, len(values) - 0.5)
    if any(name for name, _ in lines):
        axes.legend(frameon=False, fontsize=8.5, loc="center left", bbox_to_anchor=(1.0, 0.5))


def _wide(values: Sequence[float] | np.ndarray) -> bool:
    return bool(values[0] > 0.0 and values[-1] / values[0] >= 4.0)


def _beside(x: np.ndarray, share: float) -> np.ndarray:
    """Returns sorted places moved by a share of a twelfth of their span, so that bars do not hide each other."""
    if _wide(x):
        return x * (x[-1] / x[0]) ** (share / 12.0)
    return x + share / 12.0 * (x[-1] - x[0])


def _number_ticks(axes: Axes, values: list[float]) -> None:
    """Marks the values that were tried, as far as they can be told apart."""
    wide = _wide(values)
    if wide:
        axes.set_xscale("log")
    place = np.log if wide else np.asarray
    low, high = place(values[0]), place(values[-1])
    kept: list[float] = []
    for value in values:
        if not kept or place(value) - place(kept[-1]) >= 0.07 * (high - low):
            kept.append(value)
    axes.set_xticks(kept, [f"{value:g}" for value in kept])
    axes.minorticks_off()


def _logarithmic(axes: Axes) -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axes.set_yscale("log")
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())


def _wrapped(text: str) -> str:
    return text.replace("+", "\n+ ").replace(", ", ",\n")
