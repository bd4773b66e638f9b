"""Figures 3 to 7 in the paper's own arrangement of panels."""

from __future__ import annotations

from typing import Any

import numpy as np

from boresight.plots import COLOURS, panels
from boresight.reproduction.measurements import Measurements
from boresight.reproduction.pictures import Picture
from boresight.reproduction.pose_errors import rms
from boresight.reproduction.setting import CASES
from boresight.reproduction.spread import plain
from boresight.reproduction.tables import csv_text
from boresight.reproduction.variants import NOMINAL, Variant

BEFORE, AFTER = COLOURS[1], COLOURS[0]

_STRATEGIES = (
    ("rand/1", 1, "(a) DE/rand/1, case 1"),
    ("best/1", 1, "(b) DE/best/1, case 1"),
    ("trade-off", 1, "(c) trade-off, case 1"),
    ("trade-off", 2, "(d) trade-off, case 2"),
)

_PANEL = (4.2, 2.6)


def paper_figures(found: Measurements) -> list[Picture]:
    """Returns figures 3 to 7."""
    return [costs(found), ranges(found), poses(found, 1), poses(found, 2), validation(found)]


def costs(found: Measurements) -> Picture:
    """Returns figure 3: cost against generation."""
    figure, axes = panels(2, 2)
    columns: list[tuple[str, np.ndarray]] = []
    for axis, (method, case, title) in zip(axes.flat, _STRATEGIES, strict=True):
        rows = CASES[case]
        seed, run = found.middle(lambda run: run.cost_mm2, method, rows)
        histories = np.array([each.history_mm2 for each in found.runs(method, rows)])
        low, high = np.quantile(histories, (0.05, 0.95), axis=0)
        optimum = float(np.median([each.optimum_mm2 for each in found.runs(method, rows)]))
        generations = np.arange(len(low))
        axis.fill_between(generations, low, high, color=COLOURS[0], alpha=0.18, linewidth=0)
        axis.semilogy(generations, run.history_mm2, color=COLOURS[0])
        axis.axhline(optimum, color=COLOURS[5], linewidth=1.0, linestyle=(0, (4, 3)))
        axis.set_title(title)
        axis.set_xlim(0, len(low) - 1)
        name = f"{method}_case_{case}"
        columns += [(f"{name}_seed_{seed}", run.history_mm2), (f"{name}_p05", low), (f"{name}_p95", high)]
    drawn = np.concatenate([values for _, values in columns])
    for axis in axes.flat:
        axis.set_ylim(0.5 * float(drawn.min()), 2.0 * float(drawn.max()))
    _outer_labels(axes, "generation", "cost H, mm²")
    first = axes[0, 0]
    first.annotate(
        "optimum", (12, optimum_of(found)), textcoords="offset points", xytext=(0, 4), color=COLOURS[5], fontsize=8
    )
    return Picture(
        "figure-3",
        "Figure 3. Cost against generation",
        "Line: the run whose final cost is the median of all seeds. Band: nine seeds in ten. Dashed: the optimum of "
        "least squares, median.",
        figure,
        _columns("generation", np.arange(len(columns[0][1])), columns),
    )


def optimum_of(found: Measurements) -> float:
    """Returns the median optimum [mm²] of case 1."""
    return float(np.median([run.optimum_mm2 for run in found.runs("rand/1", CASES[1])]))


def ranges(found: Measurements) -> Picture:
    """Returns figure 4: range errors before and after, both cases."""
    figure, axes = panels(2, 2, _PANEL)
    trial = found.typical
    columns: list[tuple[str, np.ndarray]] = []
    for line, (method, when, colour) in enumerate(((NOMINAL, "before", BEFORE), ("trade-off", "after", AFTER))):
        for case, rows in CASES.items():
            errors = trial.runs[Variant(method, rows)].range_mm
            letter = "abcd"[2 * line + case - 1]
            axis = axes[line, case - 1]
            _stems(axis, errors, colour)
            axis.set_title(f"({letter}) case {case}, {when}: at most {plain(float(np.abs(errors).max()), 2)} mm")
            columns.append((f"case_{case}_{when}_mm", errors))
    _outer_labels(axes, "configuration", "range error, mm")
    return Picture(
        "figure-4",
        "Figure 4. Range errors in the calibration configurations",
        f"Measured minus predicted ranges, seed {trial.seed} (the seed nearest to the median of validation errors in "
        "both cases; figures 5 to 7 show the same).",
        figure,
        _columns("configuration", np.arange(1, max(CASES.values()) + 1), columns),
    )


def poses(found: Measurements, case: int) -> Picture:
    """Returns figure 5 or 6: pose errors where the readings of case 1 or 2 were taken."""
    figure, axes = panels(2, 2, _PANEL)
    trial, rows = found.typical, CASES[case]
    columns: list[tuple[str, np.ndarray]] = []
    for line, (method, when, colour) in enumerate(((NOMINAL, "before", BEFORE), ("trade-off", "after", AFTER))):
        columns += _pose_line(
            axes[line], trial.runs[Variant(method, rows)].calibration, when, "abcd"[2 * line :], colour
        )
    _pose_labels(axes)
    return Picture(
        f"figure-{4 + case}",
        f"Figure {4 + case}. Pose errors in the calibration configurations, case {case}",
        f"Lengths of position errors and angles of orientation errors in the {rows} calibration configurations, seed "
        f"{trial.seed}.",
        figure,
        _columns("configuration", np.arange(1, rows + 1), columns),
    )


def validation(found: Measurements) -> Picture:
    """Returns figure 7: pose errors in the validation configurations."""
    figure, axes = panels(3, 2, _PANEL)
    trial = found.typical
    shown: list[tuple[str, str, int, str]] = [(NOMINAL, "before", CASES[1], BEFORE)]
    shown += [("trade-off", f"case {case}", rows, COLOURS[0 if case == 1 else 2]) for case, rows in CASES.items()]
    columns: list[tuple[str, np.ndarray]] = []
    for line, (method, when, rows, colour) in enumerate(shown):
        errors = trial.runs[Variant(method, rows)].validation
        columns += _pose_line(axes[line], errors, when, "abcdef"[2 * line :], colour)
    for column in range(2):  # both cases to one scale
        top = max(axes[line, column].get_ylim()[1] for line in (1, 2))
        for line in (1, 2):
            axes[line, column].set_ylim(0, top)
    _pose_labels(axes)
    return Picture(
        "figure-7",
        "Figure 7. Pose errors in the validation configurations",
        f"Before calibration, with the parameters of case 1, and with those of case 2; seed {trial.seed}. Cases 1 and "
        "2 are drawn to one scale.",
        figure,
        _columns("configuration", np.arange(1, len(columns[0][1]) + 1), columns),
    )


def _pose_line(axes: Any, errors: Any, when: str, letters: str, colour: str) -> list[tuple[str, np.ndarray]]:
    """Draws position and orientation errors side by side; returns what was drawn."""
    drawn = []
    for axis, letter, what, values, unit in (
        (axes[0], letters[0], "position", errors.position_mm, "mm"),
        (axes[1], letters[1], "orientation", errors.orientation_mrad, "mrad"),
    ):
        _stems(axis, values, colour)
        axis.set_ylim(0, 1.12 * float(values.max()))
        axis.set_title(f"({letter}) {what}, {when}: RMS {plain(rms(values), 2)} {unit}")
        drawn.append((f"{what}_{when.replace(' ', '_')}_{unit}", values))
    return drawn


def _stems(axis: Any, values: np.ndarray, colour: str) -> None:
    """Draws one value a configuration."""
    number = np.arange(1, len(values) + 1)
    axis.vlines(number, 0.0, values, color=colour, linewidth=0.9, alpha=0.5)
    axis.plot(number, values, "o", color=colour, markersize=2.6 if len(values) > 50 else 3.4)
    axis.axhline(0.0, color=COLOURS[5], linewidth=0.8)
    axis.set_xlim(0, len(values) + 1)
    axis.xaxis.get_major_locator().set_params(integer=True)


def _pose_labels(axes: Any) -> None:
    for line in axes:
        line[0].set_ylabel("position error, mm")
        line[1].set_ylabel("orientation error, mrad")
    for axis in axes[-1]:
        axis.set_xlabel("configuration")


def _outer_labels(axes: Any, below: str, beside: str) -> None:
    for axis in axes[-1]:
        axis.set_xlabel(below)
    for axis in axes[:, 0]:
        axis.set_ylabel(beside)


def _columns(name: str, index: np.ndarray, columns: list[tuple[str, np.ndarray]]) -> str:
    """Returns columns of unequal length as CSV."""
    rows = [
        [str(int(i)), *(f"{values[place]:.9g}" if place < len(values) else "" for _, values in columns)]
        for place, i in enumerate(index)
    ]
    return csv_text([name, *(key for key, _ in columns)], rows)
