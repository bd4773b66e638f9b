"""`boresight study`: runs, goes on, summarises, and says what is wrong with what it was asked."""

import csv
import json
import re
import signal
import sqlite3
import subprocess
import sys
import time

import pytest

STUDY = """\
name: tiny
seeds: 2
robot: {catalogue: space-arm}
sensor: {type: laser_ranger, noise_std: 0.0002, repeats: 10}
targets:
  deck: {type: plane, normal: [0, 1, 4.6], offset: -0.69}
fixed: [j1.theta]
vary:
  rows: [30, 50]
  gross_errors: [0, 0.05]
"""


@pytest.fixture
def tiny(tmp_path):
    (tmp_path / "tiny.yaml").write_text(STUDY)
    return "tiny.yaml"


@pytest.mark.long
def test_a_study_is_made_kept_and_summarised(boresight, tiny, tmp_path):
    said = boresight("study", tiny, "--workers", 1)
    assert said.code == 0, said.err
    assert "tiny  8 of 8 runs, 4 points of 2 seeds" in said.out
    assert re.search(r"^ +30 +0 % +2 ", said.out, re.MULTILINE)
    assert re.search(r"^ +50 +5 % +2 ", said.out, re.MULTILINE)
    folder = tmp_path / "tiny-study"
    names = {path.name for path in folder.iterdir()}
    figures = {f"{name}.{ending}" for name in ("accuracy", "reliability", "effort") for ending in ("png", "svg")}
    assert {"runs.sqlite", "runs.csv", "summary.json", *figures} <= names
    rows = runs(folder)
    assert len(rows) == 8
    assert {(row["rows"], row["gross_errors"], row["seed"]) for row in rows} >= {
        ("30", "0.0", "0"),
        ("50", "0.05", "1"),
    }
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["schema"] == "boresight-study/1"
    assert summary["runs"] == {"done": 8, "asked": 8}
    point = summary["points"][0]
    assert point["settings"]["rows"] == 30
    assert point["position_rms"]["p10"] <= point["position_rms"]["median"] <= point["position_rms"]["p90"]
    low, high = point["reached_optimum"]["interval_95"]
    assert 0.0 <= low <= point["reached_optimum"]["share"] <= high <= 1.0

    again = boresight("study", tiny, "--summary", "--json")
    assert json.loads(again.out) == summary
    fewer = boresight("study", tiny, "--summary", "--seeds", 1)
    assert "4 of 4 runs" in fewer.out

    more = boresight("study", tiny, "--seeds", 3, "--workers", 1)
    assert "12 of 12 runs" in more.out
    kept = {tuple(row.values()) for row in rows}
    assert kept <= {tuple(row.values()) for row in runs(folder)}


def runs(folder):
    return list(csv.DictReader((folder / "runs.csv").read_text().splitlines()))


@pytest.mark.long
def test_shards_are_put_together(boresight, tiny, tmp_path):
    first = boresight("study", tiny, "--shard", "1/2", "-o", "a", "--workers", 1)
    assert "4 of 8 runs" in first.out
    assert "4 of 8 runs" in boresight("study", tiny, "--shard", "2/2", "-o", "b", "--workers", 1).out
    merged = boresight("study", tiny, "-o", "a", "--merge", "b", "--workers", 1)
    assert merged.err == "b: 4 runs that were not here\n"
    assert "8 of 8 runs" in merged.out


WRONG = [
    (["--workers", 0], "--workers: expected 1 to 1024 processes, got 0"),
    (["--seeds", 0], "--seeds: expected 1 to 10000000, got 0"),
    (["--shard", "3/2"], "--shard: expected i/n such as 2/4, the second of four parts, got 3/2"),
    (["--shard", "half"], "--shard: expected i/n such as 2/4, the second of four parts, got half"),
    (
        ["--workers", 2, "--scheduler", "tcp://a:1"],
        "--workers counts processes of this machine and --scheduler has its",
    ),
    (["--summary", "--workers", 2], "--summary runs nothing"),
    (["--summary"], "tiny-study/runs.sqlite: there are no results yet; run the study without --summary first"),
]


@pytest.mark.parametrize(("more", "expected"), WRONG, ids=lambda given: given if isinstance(given, str) else "")
def test_what_cannot_be_is_told(boresight, tiny, tmp_path, more, expected):
    said = boresight("study", tiny, *more)
    assert (said.code, said.out) == (1, "")
    assert expected in said.err
    assert not (tmp_path / "tiny-study").exists()


def test_a_foreign_file_is_left_as_it_is(boresight, tiny, tmp_path):
    (tmp_path / "tiny-study").mkdir()
    (tmp_path / "tiny-study" / "runs.sqlite").write_text("my own notes\n" * 50)
    said = boresight("study", tiny)
    assert said.code == 1
    assert said.err.startswith("Error: tiny-study/runs.sqlite: this is no sqlite file, or a damaged one")
    assert (tmp_path / "tiny-study" / "runs.sqlite").read_text() == "my own notes\n" * 50


def test_a_missing_part_is_told(boresight, tiny):
    said = boresight("study", tiny, "--merge", "nowhere")
    assert said.code == 1
    assert "nowhere: there are no results yet" in said.err


@pytest.mark.long
def test_ctrl_c_keeps_what_is_done_and_says_how_to_go_on(tiny, tmp_path):
    command = [sys.executable, "-m", "boresight", "study", tiny, "--seeds", "4000", "--workers", "1"]
    with subprocess.Popen(
        command,
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    ) as process:
        try:
            deadline = time.monotonic() + 60
            while done(tmp_path) < 3 and time.monotonic() < deadline:
                time.sleep(0.2)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=60)
        finally:
            process.kill()
    assert process.returncode == 130
    assert out == ""
    assert "Traceback" not in err
    said = (
        r"Interrupted; ([\d,]+) of 16,000 runs are kept in tiny-study/runs.sqlite. The same command goes on from there."
    )
    match = re.fullmatch(said, err.splitlines()[-1])
    assert match, err
    assert int(match[1].replace(",", "")) == done(tmp_path) >= 3


def done(folder):
    path = folder / "tiny-study" / "runs.sqlite"
    if not path.exists():
        return 0
    file = sqlite3.connect(path)
    try:
        return file.execute("SELECT count(*) FROM runs").fetchone()[0]
    except sqlite3.Error:
        return 0
    finally:
        file.close()
