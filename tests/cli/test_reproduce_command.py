"""`boresight reproduce`: a tiny run of the whole, and what is refused."""

import pytest


@pytest.fixture(autouse=True)
def compiled_before(monkeypatch):
    monkeypatch.setattr("boresight.cli.compiling.first_compile_ahead", lambda *called: False)


@pytest.mark.long
def test_one_seed_writes_the_page_and_says_what_holds(boresight, tmp_path):
    said = boresight("reproduce", "--seeds", "1", "--workers", "1")
    assert (said.code, said.err) == (0, "")
    assert said.out.splitlines()[-1] == "Page: reproduction/index.html"
    assert "1 seed. Of 16 statements:" in said.out
    html = (tmp_path / "reproduction" / "index.html").read_text(encoding="utf-8")
    assert "<code>boresight reproduce --seeds 1</code>" in html
    assert (tmp_path / "reproduction" / "figures" / "figure-3.png").stat().st_size > 10_000


def test_foreign_files_are_told_before_anyone_waits(boresight, tmp_path):
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "index.html").write_text("mine")
    said = boresight("reproduce", "-o", "full")
    assert said.code == 1
    assert said.err == (
        "Error: full: holds index.html but no reproduction; nothing is overwritten: name another folder with -o\n"
    )
    assert (tmp_path / "full" / "index.html").read_text() == "mine"


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--seeds", "0"], "Error: --seeds: expected 1 to 100000, got 0\n"),
        (["--workers", "0"], "Error: --workers: expected 1 to 1024, got 0\n"),
    ],
)
def test_an_option_that_makes_no_sense_is_refused(boresight, options, told):
    said = boresight("reproduce", *options)
    assert (said.code, said.err) == (1, told)
