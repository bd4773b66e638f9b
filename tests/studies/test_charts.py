"""Figures show the medians, all panels alike, and no more lines than can be read."""

from dataclasses import replace

import numpy as np
import pytest
from small_studies import planes, point, small_study

from boresight.plots import save
from boresight.studies import Summary, run
from boresight.studies.charts import MOST_LINES, accuracy_figure, effort_figure, reliability_figure
from boresight.studies.summary import PointSummary


@pytest.fixture(scope="module")
def outcome():
    return run(point(), 0)


def summary_of(axes, outcome):
    """A summary whose position errors are 1, 2, 3, ... mm, point by point."""
    study = small_study(3, axes)
    outcomes = [
        {seed: replace(outcome, position_rms=1e-3 * (place + 1) * factor) for seed, factor in enumerate((0.5, 1, 2))}
        for place in range(len(study.points))
    ]
    found = tuple(PointSummary(point, each) for point, each in zip(study.points, outcomes, strict=True))
    return Summary(study, found)


def drawn(axes):
    """(label, x, y) of every line of medians."""
    return [
        (container.get_label(), *(np.asarray(v, dtype=float) for v in container.lines[0].get_data()))
        for container in axes.containers
    ]


def test_a_line_is_drawn_through_the_medians(outcome):
    (axes,) = accuracy_figure(summary_of({"rows": (20, 40, 80)}, outcome)).axes
    ((_, x, y),) = drawn(axes)
    assert x.tolist() == [20, 40, 80]
    assert y == pytest.approx([1, 2, 3])


def test_each_varied_thing_has_a_panel_with_lines_of_the_other(outcome):
    figure = accuracy_figure(summary_of({"rows": (20, 40, 80), "noise_std": (1e-4, 2e-4)}, outcome))
    first, second = figure.axes
    assert [label for label, _, _ in drawn(first)] == ["0.1 mm noise", "0.2 mm noise"]
    assert [label for label, _, _ in drawn(second)] == ["20 readings", "40 readings", "80 readings"]
    assert first.get_ylim() == second.get_ylim()
    assert drawn(first)[0][2] == pytest.approx([1, 3, 5])
    assert drawn(second)[1][2] == pytest.approx([3, 4])


def test_names_stand_side_by_side(outcome):
    axes = {"planes": (planes(1), planes(3)), "rows": (20, 40)}
    first, _ = accuracy_figure(summary_of(axes, outcome)).axes
    assert [text.get_text() for text in first.get_xticklabels()] == ["1", "3"]
    assert [len(x) for _, x, _ in drawn(first)] == [2, 2]


def test_many_values_are_thinned_and_panels_bounded(outcome):
    axes = {"rows": tuple(range(20, 90, 10)), "noise_std": (1e-4, 2e-4, 4e-4), "repeats": (1, 2, 4, 8, 16, 32)}
    figure = accuracy_figure(summary_of(axes, outcome))
    panels = [each for each in figure.axes if each.has_data()]
    assert len(panels) <= 12
    assert max(len(drawn(each)) for each in panels) == MOST_LINES


@pytest.mark.parametrize("draw", [accuracy_figure, reliability_figure, effort_figure])
def test_figures_are_the_same_bytes_every_time(draw, outcome, tmp_path):
    summary = summary_of({"rows": (20, 40), "solver": ("least-squares", "evolution")}, outcome)
    one, two = (save(draw(summary), tmp_path / name) for name in ("one", "two"))
    assert [path.read_bytes() for path in one] == [path.read_bytes() for path in two]


def test_a_study_of_one_point_has_a_figure_too(outcome):
    (axes,) = reliability_figure(summary_of({}, outcome)).axes
    ((_, x, y),) = drawn(axes)
    assert (x.tolist(), y.tolist()) == ([40], [100])
