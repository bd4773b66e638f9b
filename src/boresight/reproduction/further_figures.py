"""Figures that the paper does not have: the lost equation, the ambiguity, more configurations, other methods."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from boresight.plots import COLOURS, panels
from boresight.reproduction.further_tables import SISTER, WORDS, methods
from boresight.reproduction.measurements import Measurements
from boresight.reproduction.pictures import Picture
from boresight.reproduction.pose_statements import orientation, position
from boresight.reproduction.setting import CANDIDATES, CASES
from boresight.reproduction.spread import Spread
from boresight.reproduction.tables import csv_text
from boresight.reproduction.trials import Run
from boresight.reproduction.variants import AZIMUTH_FREE, CHOSEN, NOMINAL

_ROWS = (35, 50, 100, 200)


def further_figures(found: Measurements) -> list[Picture]:
    """Returns the four figures."""
    return [strategies(found), ambiguity(found), configurations(found), beside(found)]


def strategies(found: Measurements) -> Picture:
    """Returns how often each strategy ends how near the optimum."""
    figure, axes = panels(1, 2, (4.2, 3.1))
    shown = (*CANDIDATES, "best/1", "rand/1")
    rows: list[list[str]] = []
    for axis, (case, count) in zip(axes.flat, CASES.items(), strict=True):
        for place, method in enumerate(shown):
            ends = np.sort(found.values(lambda run: run.from_optimum, method, count))
            share = 100.0 * np.arange(1, len(ends) + 1) / len(ends)
            axis.step(
                np.concatenate([[0.99], ends, [1e3]]),
                np.concatenate([[0.0], share, [100.0]]),
                where="post",
                color=COLOURS[place],
                linestyle="-" if method in CANDIDATES else (0, (4, 2)),
                label=WORDS.get(method, method),
            )
            rows += [[method, str(case), f"{value:.9g}"] for value in ends]
        axis.set_xscale("log")
        axis.set_xlim(0.97, 300)
        axis.set_ylim(0, 103)
        axis.set_xticks([1, 2, 5, 10, 20, 50, 100, 200], ["1", "2", "5", "10", "20", "50", "100", "200"])
        axis.minorticks_off()
        axis.set_title(f"Case {case}")
        axis.set_xlabel("RMS range error over the optimum's")
    axes[0, 0].set_ylabel("seeds that end below, %")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return Picture(
        "eq-16",
        "How near the optimum each strategy ends",
        "Share of seeds whose final range error is below a multiple of the optimum's: further to the left and higher "
        "is better. Solid: candidates for eq. (16); dashed: the two classical strategies.",
        figure,
        csv_text(["strategy", "case", "from_optimum"], rows),
    )


def ambiguity(found: Measurements) -> Picture:
    """Returns pose errors with theta_1 fixed and free, absolute and with the turn removed."""
    figure, axes = panels(1, 2, (4.2, 3.1))
    numbers: tuple[tuple[str, Callable[[Run], float]], ...] = (
        ("absolute", position),
        ("turn\nremoved", lambda run: run.validation_turned.position_rms_mm),
    )
    rows: list[list[str]] = []
    for axis, (case, count) in zip(axes.flat, CASES.items(), strict=True):
        place, labels = 0, []
        for words, under, colour in (("θ1 fixed", CHOSEN, COLOURS[0]), ("θ1 free", AZIMUTH_FREE, COLOURS[1])):
            for what, number in numbers:
                values = found.values(number, "trade-off", count, under)
                _swarm(axis, place, values, colour)
                labels.append(f"{words},\n{what}")
                name = what.replace("\n", " ")
                rows += [
                    [words, name, str(case), str(t.seed), f"{v:.9g}"] for t, v in zip(found.trials, values, strict=True)
                ]
                place += 1
        axis.set_yscale("log")
        axis.set_xticks(range(place), labels, fontsize=8)
        axis.set_xlim(-0.6, place - 0.4)
        axis.set_title(f"Case {case}")
        axis.grid(axis="x", visible=False)
    low = min(axis.get_ylim()[0] for axis in axes.flat)
    high = max(axis.get_ylim()[1] for axis in axes.flat)
    for axis in axes.flat:
        axis.set_ylim(low, high)
        _plain_ticks(axis.yaxis, low, high)
    axes[0, 0].set_ylabel("validation position RMS, mm")
    return Picture(
        "ambiguity",
        "θ1 and n_x are one direction",
        "A dot a seed; the bar is the median. With θ1 free, ranges fit as well, but the pose in the base's frame is "
        "off by however far the search happened to turn the base.",
        figure,
        csv_text(["free", "error", "case", "seed", "validation_position_rms_mm"], rows),
    )


def configurations(found: Measurements) -> Picture:
    """Returns pose errors against the number of configurations."""
    figure, axes = panels(1, 2, (4.2, 3.0))
    rows: list[list[str]] = [[str(count)] for count in _ROWS]
    for axis, number, title in (
        (axes[0, 0], position, "Position, RMS, mm"),
        (axes[0, 1], orientation, "Orientation, RMS, mrad"),
    ):
        spreads = [found.spread(number, "trade-off", count) for count in _ROWS]
        median = np.array([spread.median for spread in spreads])
        low, high = np.array([spread.low for spread in spreads]), np.array([spread.high for spread in spreads])
        axis.fill_between(_ROWS, low, high, color=COLOURS[0], alpha=0.18, linewidth=0, label="nine seeds in ten")
        axis.loglog(_ROWS, median, "o-", color=COLOURS[0], label="median")
        root = median[2] * np.sqrt(_ROWS[2] / np.array(_ROWS))
        axis.loglog(_ROWS, root, color=COLOURS[5], linestyle=(0, (4, 3)), linewidth=1.0, label="1/√m through m = 100")
        axis.set_xticks(_ROWS, [str(count) for count in _ROWS])
        axis.minorticks_off()
        _plain_ticks(axis.yaxis, 0.8 * float(low.min()), 1.2 * float(high.max()))
        axis.set_title(title)
        axis.set_xlabel("configurations m, 10 readings each")
        for row, spread in zip(rows, spreads, strict=True):
            row += [f"{value:.9g}" for value in (spread.median, spread.low, spread.high)]
    axes[0, 0].legend()
    keys = [
        f"{what}_{which}" for what in ("position_rms_mm", "orientation_rms_mrad") for which in ("median", "p05", "p95")
    ]
    return Picture(
        "configurations",
        "Errors in validation against the number of configurations",
        "Trade-off. Dashed: what averaging the noise alone would give, drawn through the median "
        "of 100 configurations. While readings hardly outnumber the 25 parameters, each further one brings more.",
        figure,
        csv_text(["configurations", *keys], rows),
    )


def beside(found: Measurements) -> Picture:
    """Returns validation errors of all methods, and the sister paper's."""
    figure, axes = panels(1, 2, (4.6, 3.3))
    compared = methods(found)
    rows: list[list[str]] = []
    for axis, (case, count) in zip(axes.flat, CASES.items(), strict=True):
        for place, (words, method, under) in enumerate(reversed(compared)):
            spread = found.spread(position, method, count, under)
            axis.plot(
                [spread.low, spread.high],
                [place, place],
                color=COLOURS[0],
                alpha=0.35,
                linewidth=5,
                solid_capstyle="butt",
            )
            axis.plot(spread.median, place, "o", color=COLOURS[0], markersize=5)
            rows.append([words, str(case), *(f"{v:.9g}" for v in (spread.median, spread.low, spread.high))])
        _sister(axis, case, len(compared))
        axis.set_xscale("log")
        axis.set_yticks(range(len(compared) + 1), [*(w for w, *_ in reversed(compared)), "sister paper"])
        if axis is not axes[0, 0]:
            axis.tick_params(labelleft=False)
        axis.set_ylim(-0.6, len(compared) + 0.6)
        axis.grid(axis="y", visible=False)
        axis.set_title(f"Case {case}")
        axis.set_xlabel("validation position RMS, mm")
    low, high = min(a.get_xlim()[0] for a in axes.flat), max(a.get_xlim()[1] for a in axes.flat)
    for axis in axes.flat:
        axis.set_xlim(low, high)
        _plain_ticks(axis.xaxis, low, high)
    return Picture(
        "beside",
        "Errors in validation, all methods",
        "Dot: median of all seeds; bar: nine seeds in ten. Diamonds: the sister paper's single numbers before "
        "(hollow) and after, on another arm of the same kind.",
        figure,
        csv_text(["method", "case", "validation_position_rms_mm_median", "p05", "p95"], rows),
    )


def _sister(axis: Any, case: int, place: int) -> None:
    before, after = SISTER[NOMINAL][0], SISTER[case][0]
    axis.plot([after, before], [place, place], color=COLOURS[3], linewidth=1.0, linestyle=":")
    axis.plot(before, place, "D", color=COLOURS[3], markerfacecolor="white", markersize=5)
    axis.plot(after, place, "D", color=COLOURS[3], markersize=5)


def _swarm(axis: Any, place: int, values: np.ndarray, colour: str) -> None:
    """Draws a dot a value, spread sideways by rank so that none hides another, and the median."""
    order = np.argsort(np.argsort(values, kind="stable"), kind="stable")
    aside = 0.5 * ((order * 0.6180339887) % 1.0 - 0.5)
    axis.plot(place + aside, values, "o", color=colour, markersize=2.4, alpha=0.45, markeredgewidth=0)
    median = Spread.of(values).median
    axis.plot([place - 0.34, place + 0.34], [median, median], color=colour, linewidth=2.2)


def _plain_ticks(axis: Any, low: float, high: float) -> None:
    """Ticks a logarithmic axis at 1, 2 and 5 times powers of ten, in plain numbers; at powers alone if it is long."""
    factors = (1,) if high / low > 2000 else (1, 2, 5)
    ticks = [f * 10.0**p for p in range(-5, 5) for f in factors if low <= f * 10.0**p <= high]
    axis.set_ticks(ticks, [f"{tick:g}" for tick in ticks])
    axis.set_ticks([], minor=True)
