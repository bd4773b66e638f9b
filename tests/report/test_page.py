"""The report page: what it says, that nothing in it is live, and that no gap in a result breaks it."""

import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

from boresight.arm import catalogue
from boresight.calibration import Campaign, Freedom, SetAside, Solver, calibrate
from boresight.calibration.result import ErrorSummary, Estimate, Outlier, Residuals, Result, Unseen, Verdict
from boresight.calibration.solve import Solution, Stage
from boresight.geometry import Plane
from boresight.report.axes import linear_axis, log_axis
from boresight.report.charts import convergence_chart, correction_charts, errors_chart
from boresight.report.page import render_page
from boresight.search import Stops
from boresight.sensing import Cell, LaserRanger, Readings
from boresight.synthetic import draw_configurations, perturbed, simulated_readings

HOSTILE = "<script>alert(1)</script>"
NAN = float("nan")
NOWHERE = Residuals("5-fold cross-validation", 0, 40, ErrorSummary(NAN, NAN, NAN), ErrorSummary(NAN, NAN, NAN))
VOID = {"meta", "br", "path", "circle"}


class Page(HTMLParser):
    """A page taken apart: its tags with their attributes, its text, and whether every tag was closed in turn."""

    def __init__(self, text: str):
        super().__init__(convert_charrefs=True)
        self.tags, self.words, self.open = [], "", []
        self.feed(text)
        self.close()
        self.words = " ".join(self.words.split())

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] != "style":
            self.words += data


def page_of(result: Result) -> Page:
    page = Page(render_page(result, "1.2.3"))
    assert page.open == []
    return page


@pytest.fixture(scope="module")
def result() -> Result:
    widths = {"j2.theta": 0.02, "j3.alpha": 0.02, "j4.a": 0.005, "deck.normal_x": 0.01}
    cell = Cell(catalogue.load("space-arm"), LaserRanger(2e-4, 10), targets={"deck": Plane.of((0.0, 1.0, 4.6), -0.69)})
    true = perturbed(cell, widths, seed=1)
    joints, target = draw_configurations((cell, true), 40, seed=1)
    campaign = Campaign(
        "deck survey",
        cell,
        simulated_readings(true, joints, target, seed=1),
        freedoms=tuple(Freedom(name, width, width / 3**0.5) for name, width in widths.items()),
        inputs={"campaign.yaml": "0123456789abcdef" * 4},
    )
    return calibrate(campaign, Solver(stops=Stops(generations=40)))


def test_page_is_self_contained_and_runs_nothing(result):
    page = page_of(result)
    assert not {"script", "link", "img", "iframe", "object", "base"} & {tag for tag, _ in page.tags}
    for _, attributes in page.tags:
        assert not {name for name in attributes if name.startswith("on")} | attributes.keys() & {"href", "src"}
    assert not re.search(r"url\(|@import|https?:", render_page(result, "1.2.3"))


def test_page_says_the_verdict_the_errors_and_how_they_were_held_out(result):
    words = page_of(result).words
    assert "deck survey" in words
    assert "✓ ACCEPTED" in words
    assert result.verdict.reasons[0].split(":")[0] in words
    assert "40 rows, 5-fold cross-validation" in words
    assert "geometry nominal, unknown frames fitted" in words
    assert "Boresight 1.2.3" in words


def test_page_lists_every_parameter_and_every_input(result):
    page = page_of(result)
    for estimate in result.estimates:
        assert estimate.name in page.words
    assert "0123456789abcdef" * 4 in [attributes.get("title") for _, attributes in page.tags]


def test_every_table_has_a_caption_and_every_chart_a_name(result):
    tags = page_of(result).tags
    names = [tag for tag, _ in tags]
    assert names.count("table") == names.count("caption") > 3
    charts = [attributes for tag, attributes in tags if tag == "svg"]
    assert len(charts) == 5
    assert all(attributes["role"] == "img" and attributes["aria-label"] for attributes in charts)


def test_hostile_names_are_harmless_wherever_they_come_from(result):
    hostile = replace(
        result,
        name=HOSTILE,
        verdict=Verdict(False, (HOSTILE,)),
        estimates=(
            Estimate(HOSTILE, "m", 0.0, 1e-3, 1e-3, 1e-4, "data"),
            Estimate('"><script>', "rad", 0, 1e-3, 1e-3, 1e-4, "fixed"),
        ),
        unseen=(Unseen((HOSTILE,), HOSTILE),),
        warnings=(HOSTILE,),
        notes=(HOSTILE,),
        set_aside=(SetAside(HOSTILE, 3, HOSTILE),),
        inputs={HOSTILE: '" onload="x'},
        validation=replace(result.validation, method=HOSTILE),
    )
    page = page_of(hostile)
    assert "script" not in {tag for tag, _ in page.tags}
    assert not [attributes for _, attributes in page.tags if "onload" in attributes]
    assert page.words.count(HOSTILE) > 8


def test_rejected_result_says_not_to_use_it(result):
    words = page_of(replace(result, verdict=Verdict(False, ("Held-out error did not fall.",)))).words
    assert "✗ REJECTED" in words
    assert "Do not use the calibrated model" in words
    assert "ACCEPTED" not in words


def test_result_without_any_finite_error_is_still_a_page(result):
    nothing = {when: np.full((40, 1), NAN) for when in ("before", "after")}
    gone = replace(
        result, calibration=NOWHERE, validation=NOWHERE, errors=nothing, stated_std=NAN, model_std=NAN, rank=0
    )
    words = page_of(gone).words
    assert "– → –" in words
    assert "No row has an error that could be drawn" in words
    assert "nan" not in words.lower().split()


def test_search_without_evolution_has_no_convergence_chart(result):
    stage = Stage("least squares from the nominal model", 40.0, 6e-5, 0.01, 7, "no step improves the fit any further")
    solution = Solution(result.solution.fit, (stage,), np.empty((0, 2)), stage, True)
    page = page_of(replace(result, solution=solution, solver=Solver(name="least-squares")))
    assert "was the whole search" in page.words
    assert "generation" not in page.words.lower()
    assert len([tag for tag, _ in page.tags if tag == "svg"]) == 4


@pytest.mark.parametrize(
    ("suffices", "sentence"),
    [
        (True, "alone would have reached the same optimum"),
        (False, "alone would not have reached this optimum"),
        (None, "was not tried"),
    ],
)
def test_page_says_whether_evolution_was_needed(result, suffices, sentence):
    nominal = None if suffices is None else result.solution.nominal
    solution = replace(result.solution, nominal=nominal, nominal_suffices=suffices)
    assert sentence in page_of(replace(result, solution=solution)).words


def test_unknown_nominal_value_is_a_dash_and_has_no_correction(result):
    unknown = Estimate("base.x", "m", None, 0.507, None, 1e-4, "data")
    words = page_of(replace(result, estimates=(unknown,))).words
    assert re.search(r"base\.x ?–", words)
    assert "the value was unknown" in words
    assert correction_charts([unknown]) == ()


def test_unseen_directions_and_parameters_held_by_the_prior_are_named(result):
    held = Estimate("j1.theta", "rad", 0.0, 0.0, 0.0, 0.01, "prior")
    blind = replace(
        result,
        rank=3,
        unseen=(Unseen(("j1.theta",), "j1.theta does not change any reading"),),
        estimates=(held,),
        priors={},
    )
    words = page_of(blind).words
    assert "3 of 4" in words
    assert "j1.theta does not change any reading." in words
    assert "The prior rather than the readings decides j1.theta." in words


def test_long_lists_are_cut_and_say_how_many_are_left_out(result):
    outliers = tuple(Outlier(line, -0.1, 50.0) for line in range(2, 1002))
    words = page_of(replace(result, outliers=outliers)).words
    assert "And 950 more" in words


def test_page_of_a_hundred_thousand_rows_stays_small(result):
    rows = 100_000
    rng = np.random.default_rng(0)
    readings = Readings(
        np.zeros((rows, 6)),
        np.zeros((rows, 1)),
        np.full((rows, 1), 1e-4),
        np.zeros(rows, dtype=int),
        np.arange(2, rows + 2),
    )
    errors = {"before": rng.normal(0, 1e-2, (rows, 1)), "after": rng.normal(0, 1e-4, (rows, 1))}
    errors["after"][77_777] = 0.5
    large = replace(result, readings=readings, errors=errors, outliers=(Outlier(77_779, -0.5, 5000.0),))
    assert len(render_page(large, "1.2.3")) < 300_000
    chart = errors_chart(large)
    assert chart.shown <= 1001
    assert chart.outliers.count("M") == 1


def test_positions_are_drawn_as_lengths_of_error_vectors(result):
    rows = len(result.readings)
    vectors = np.tile([3e-3, 4e-3, 0.0], (rows, 1))
    chart = errors_chart(replace(result, errors={"before": vectors, "after": vectors}))
    heights = {float(mark.split()[1].split("m")[0]) for mark in chart.before.split("M")[1:]}
    assert heights == {round(float(chart.y.at(np.array(5.0))), 1)}


def test_wide_prior_does_not_squeeze_what_the_data_decide():
    seen = Estimate("j2.theta", "rad", 0.0, 0.002, 0.002, 1e-4, "data")
    held = Estimate("j1.theta", "rad", 0.0, 0.0, 0.0, 1.0, "prior")
    (chart,) = correction_charts([seen, held])
    assert chart.x.high < 3.0
    assert (chart.bars[1].off_low, chart.bars[1].off_high) == (True, True)
    assert (chart.bars[0].off_low, chart.bars[0].off_high) == (False, False)


def test_costs_that_are_infinite_are_left_out_of_the_convergence_chart():
    chart = convergence_chart(np.array([[1e-3, np.inf], [1e-4, 1e-2], [1e-5, 1e-4]]))
    assert chart.best.count("L") == 2
    assert chart.mean.count("L") == 1


@pytest.mark.parametrize(("low", "high"), [(0.0, 1.0), (-7.3, 12.1), (1.0, 100_001.0), (2.0, 2.0), (-3e-7, 4e-7)])
def test_linear_axis_has_a_handful_of_ticks_inside(low, high):
    axis = linear_axis(low, high, 10.0, 110.0)
    assert 2 <= len(axis.ticks) <= 7
    assert all(10.0 - 1e-6 <= tick.at <= 110.0 + 1e-6 for tick in axis.ticks)
    assert len({tick.text for tick in axis.ticks}) == len(axis.ticks)


@pytest.mark.parametrize(("low", "high"), [(0.02, 37.0), (1.0, 1.0), (1e-9, 1e8), (3.0, 5.0), (0.001, 0.001)])
def test_log_axis_spans_whole_decades_with_a_handful_of_ticks(low, high):
    axis = log_axis(low, high, 200.0, 0.0)
    assert axis.low <= low * (1 + 1e-6)
    assert axis.high >= high * (1 - 1e-6)
    assert 2 <= len(axis.ticks) <= 9
    assert axis.ticks[0].at == 200.0
