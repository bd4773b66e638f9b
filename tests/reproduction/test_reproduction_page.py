"""What a reproduction writes: files, tables, a page in two forms, nothing foreign overwritten."""

import csv
import io
import re
from dataclasses import replace

import pytest

from boresight.errors import OutputError
from boresight.reproduction import compose, write_reproduction
from boresight.reproduction.folder import check_writable
from boresight.reproduction.measurements import Measurements
from boresight.reproduction.page import as_html, as_markdown
from boresight.reproduction.spread import Spread, percent, plain
from boresight.reproduction.tables import Column, Table
from boresight.reproduction.variants import MODERN

FIGURES = [*(f"figure-{number}" for number in range(3, 8)), "eq-16", "ambiguity", "configurations", "beside"]
TABLES = [
    *(f"table-{number}" for number in range(1, 6)),
    "statements", "eq-16", "ambiguity", "assumptions", "configurations", "beside", "runs",
]  # fmt: skip


@pytest.fixture(scope="module")
def page(found):
    return compose(found, "boresight reproduce --seeds 2 --seed 40")


def test_tables_1_to_5_and_figures_3_to_7_are_there(page):
    assert {picture.name for picture in page.pictures} == set(FIGURES)
    assert {table.name for table in page.tables} == set(TABLES)


def test_figure_3_has_the_papers_four_panels_and_figure_7_its_six(page):
    figures = {picture.name: picture.figure for picture in page.pictures}
    titles = {name: "".join(axis.get_title(loc="left")[1] for axis in figures[name].axes) for name in FIGURES[:5]}
    four = ("figure-3", "figure-4", "figure-5", "figure-6")
    assert titles == dict.fromkeys(four, "abcd") | {"figure-7": "abcdef"}


def test_every_table_is_rectangular_csv(page):
    for table in page.tables:
        header, *rows = csv.reader(io.StringIO(table.as_csv()))
        assert len(rows) == len(table.rows)
        assert {len(row) for row in rows} == {len(header)}
        assert len(set(header)) == len(header)


def test_table_3_has_the_25_parameters_in_the_order_of_equation_19(page):
    (table,) = (each for each in page.tables if each.name == "table-3")
    names = [str(row[0]) for row in table.rows]
    assert len(names) == 25
    assert names[:2] == ["Δθ2", "Δθ3"]
    assert names[-3:] == ["Δβ2", "Δn_x", "Δn_z"]


def test_the_page_shows_every_statement_figure_and_table_and_runs_nothing(page):
    html = as_html(page, "1.2.3")
    assert html.count('class="verdict-word"') == len(page.judged)
    for name in FIGURES:
        assert f'src="figures/{name}.png"' in html
    assert not re.search(r"<script|https?:|url\(", html)
    assert "None" not in html
    assert "nan" not in re.sub(r"<style>.*?</style>", "", html, flags=re.DOTALL).lower().split()


def test_markdown_says_the_same_as_html(page):
    markdown, html = as_markdown(page, "1.2.3"), as_html(page, "1.2.3")
    for each in page.judged:
        assert each.finding.found in markdown
    for section in page.sections:
        assert f"## {section.title}" in markdown
        assert section.title.split("'")[0].split("θ")[0] in html
    for name in FIGURES:
        assert f"(figures/{name}.png)" in markdown


def test_without_minionpy_the_page_says_how_to_get_it(found):
    runs = [{v: r for v, r in trial.runs.items() if v.method not in MODERN} for trial in found.trials]
    lacking = Measurements(
        tuple(replace(trial, runs=own) for trial, own in zip(found.trials, runs, strict=True)), modern=False
    )
    markdown = as_markdown(compose(lacking, "boresight reproduce"), "1.2.3")
    assert 'pip install "boresight[benchmark]"' in markdown
    assert "| L-SHADE |" not in markdown


def test_all_files_are_written_and_a_second_run_replaces_them(page, tmp_path):
    for _ in range(2):
        assert write_reproduction(page, tmp_path / "out", "1.2.3") == tmp_path / "out" / "index.html"
    there = {str(path.relative_to(tmp_path / "out")) for path in (tmp_path / "out").rglob("*") if path.is_file()}
    expected = {f"figures/{name}.{ending}" for name in FIGURES for ending in ("png", "svg", "csv")}
    assert there == expected | {f"tables/{name}.csv" for name in TABLES} | {"index.html", "reproduction.md"}


@pytest.mark.parametrize("name", ["index.html", "reproduction.md", "figures", "tables"])
def test_foreign_files_are_not_overwritten(page, tmp_path, name):
    (tmp_path / name).write_text("mine")
    with pytest.raises(OutputError, match=f"holds {name} but no reproduction"):
        write_reproduction(page, tmp_path, "1.2.3")
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text() == "mine"


def test_a_file_in_the_folders_place_is_refused(tmp_path):
    (tmp_path / "out").write_text("mine")
    with pytest.raises(OutputError, match="is a file"):
        check_writable(tmp_path / "out")


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [(0.041712, 3, "0.0417"), (133.4, 3, "133"), (12345.6, 3, "12,346"), (-0.05, 2, "−0.050"), (0.0, 3, "0"),
     (1e-9, 3, "≈ 0"), (float("inf"), 3, "–")],
)  # fmt: skip
def test_numbers_are_rounded_to_digits_that_matter(value, digits, text):
    assert plain(value, digits) == text


@pytest.mark.parametrize(
    ("share", "text"), [(1.0, "100 %"), (0.9999, "99.9 %"), (0.0, "0 %"), (0.0004, "0.1 %"), (0.5, "50 %")]
)
def test_only_all_is_a_hundred_per_cent_and_only_none_is_nought(share, text):
    assert percent(share) == text


def test_a_spread_is_a_median_and_the_range_of_nine_in_ten():
    spread = Spread.of(list(range(101)))
    assert (spread.low, spread.median, spread.high) == (5.0, 50.0, 95.0)
    assert spread.text(unit="mm") == "50.0 mm (5.00 to 95.0)"


def test_times_are_not_in_a_csv():
    columns = (Column("a", "a"), Column("time, ms", "ms", in_csv=False), Column("b", "b"))
    table = Table("t", "T", columns, ((1, 2.5, Spread(1.0, 0.5, 2.0)), (3, 4.5, "–")))
    assert table.as_csv() == "a,b_median,b_p05,b_p95\n1,1,0.5,2\n3,–,,\n"
