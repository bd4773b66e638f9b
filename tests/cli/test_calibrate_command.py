"""`boresight calibrate`: what it prints, writes and leaves alone."""

import json

import pytest
from example_files import content

QUICK = ("--solver", "least-squares")
FILES = {
    "convergence.csv",
    "pose-uncertainty.csv",
    "report.html",
    "residuals.csv",
    "result.json",
    "robot-calibrated.yaml",
}


def test_an_accepted_calibration_exits_with_0_and_writes_its_files(boresight, one_plane, tmp_path):
    said = boresight("calibrate", one_plane.campaign)
    assert said.code == 0
    assert said.out.startswith("ACCEPTED  mine\n")
    assert "Files: mine-result/" in said.out
    assert set(content(tmp_path / "mine-result")) == FILES


def test_json_is_all_that_is_printed_and_the_same_as_the_file(boresight, one_plane, tmp_path):
    said = boresight("calibrate", one_plane.campaign, "--json", *QUICK)
    assert said.code == 0
    assert said.err == ""
    assert json.loads(said.out)["verdict"]["accepted"] is True
    assert said.out == (tmp_path / "mine-result" / "result.json").read_text()


def test_nothing_is_coloured_and_no_progress_shown_where_nobody_watches(boresight, one_plane):
    said = boresight("calibrate", one_plane.campaign)
    assert "\x1b" not in said.out + said.err
    assert "generations, best" not in said.err


def test_a_rejected_result_exits_with_2_and_stands_beside_the_accepted_one(boresight, one_plane, tmp_path):
    assert boresight("calibrate", one_plane.campaign, "-o", "here", *QUICK).code == 0
    before = content(tmp_path / "here")
    one_plane.shuffle_ranges()
    said = boresight("calibrate", one_plane.campaign, "-o", "here", *QUICK)
    assert said.code == 2
    assert said.out.startswith("REJECTED  mine\n")
    assert "Files: here-rejected/" in said.out
    assert content(tmp_path / "here") == before
    assert set(content(tmp_path / "here-rejected")) == FILES
    assert "REJECTED" in (tmp_path / "here-rejected" / "robot-calibrated.yaml").read_text().splitlines()[0]


def test_a_rejected_result_stands_beside_an_accepted_one_in_the_present_folder(boresight, one_plane, tmp_path):
    work = tmp_path / "work"
    work.mkdir()
    assert boresight("calibrate", one_plane.campaign, "-o", work, *QUICK).code == 0
    before = content(work)
    one_plane.shuffle_ranges()
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(work)
        patch.setattr("sys.argv", ["boresight"])
        from boresight.cli.calibrate import run_calibrate

        settings = {"solver": "least-squares", "strategy": "trade-off", "population": 150, "generations": 500}
        settings |= {"device": "cpu", "precision": "double"}
        code = run_calibrate(one_plane.campaign, type(work)(), **settings, seed=0, as_json=True)
    assert code == 2
    assert content(work) == before
    assert (tmp_path / "work-rejected" / "result.json").exists()


def test_an_accepted_result_replaces_an_earlier_one(boresight, one_plane, tmp_path):
    accepted = one_plane.campaign.read_text(), (one_plane.folder / "observations.csv").read_text()
    one_plane.shuffle_ranges()
    assert boresight("calibrate", one_plane.campaign, "-o", "here", *QUICK).code == 2
    assert json.loads((tmp_path / "here" / "result.json").read_text())["verdict"]["accepted"] is False
    one_plane.campaign.write_text(accepted[0])
    (one_plane.folder / "observations.csv").write_text(accepted[1])
    assert boresight("calibrate", one_plane.campaign, "-o", "here", *QUICK).code == 0
    assert json.loads((tmp_path / "here" / "result.json").read_text())["verdict"]["accepted"] is True
    assert not (tmp_path / "here-rejected").exists()


def test_other_files_in_the_folder_are_left_alone(boresight, one_plane, tmp_path):
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "notes.txt").write_text("mine")
    assert boresight("calibrate", one_plane.campaign, "-o", "here", *QUICK).code == 0
    assert set(content(tmp_path / "here")) == FILES | {"notes.txt"}
    assert (tmp_path / "here" / "notes.txt").read_text() == "mine"


def test_a_write_that_fails_leaves_the_earlier_result(boresight, one_plane, tmp_path, monkeypatch):
    assert boresight("calibrate", one_plane.campaign, "-o", "here", *QUICK).code == 0
    before = content(tmp_path / "here")
    real = type(tmp_path).write_text

    def full(path, text, **options):
        if path.name == "report.html":
            raise OSError(28, "No space left on device")
        return real(path, text, **options)

    monkeypatch.setattr(type(tmp_path), "write_text", full)
    said = boresight("calibrate", one_plane.campaign, "-o", "here", *QUICK)
    assert (said.code, said.out) == (1, "")
    assert said.err == "Error: here: cannot write the result: No space left on device\n"
    assert content(tmp_path / "here") == before


def test_ctrl_c_says_one_thing_and_leaves_the_earlier_result(boresight, one_plane, tmp_path, monkeypatch):
    assert boresight("calibrate", one_plane.campaign, "-o", "here", *QUICK).code == 0
    before = content(tmp_path / "here")

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("boresight.cli.calibrate.calibrate", interrupted)
    said = boresight("calibrate", one_plane.campaign, "-o", "here")
    assert (said.code, said.out, said.err) == (130, "", "Interrupted; nothing was written.\n")
    assert content(tmp_path / "here") == before


def test_the_same_seed_gives_the_same_answer(boresight, one_plane):
    def answer(seed):
        said = boresight("calibrate", one_plane.campaign, "--json", "--solver", "evolution", "--seed", seed)
        document = json.loads(said.out)
        document["search"].pop("stages")  # they tell the time
        return document

    first, again, other = answer(7), answer(7), answer(8)
    assert first == again
    assert first["parameters"] != other["parameters"]


@pytest.mark.parametrize(
    "strategy", ["trade-off", "rand-to-best/1", "current-to-best/1", "best/1", "rand/1", "downhill"]
)
def test_every_strategy_runs(boresight, one_plane, strategy):
    said = boresight("calibrate", one_plane.campaign, "--json", "--strategy", strategy, "--generations", "30")
    assert said.code == 0
    assert json.loads(said.out)["search"]["strategy"] == strategy


def test_single_precision_finds_the_same_and_is_told(boresight, one_plane, tmp_path):
    found = {}
    for precision in ("double", "single"):
        said = boresight("calibrate", one_plane.campaign, "-o", precision, "--precision", precision, "--json")
        assert said.code == 0
        found[precision] = json.loads((tmp_path / precision / "result.json").read_text())
    assert found["single"]["search"]["device"] == "cpu, single precision"
    assert found["double"]["search"]["device"] == "cpu"
    for single, double in zip(found["single"]["parameters"], found["double"]["parameters"], strict=True):
        assert single["identified"] == pytest.approx(double["identified"], abs=1e-6 * (double["std"] or 1.0))


def test_precision_without_evolution_is_told(boresight, one_plane):
    said = boresight("calibrate", one_plane.campaign, "--precision", "single", *QUICK)
    assert said.code == 1
    assert "--precision single is for evolution, and none was asked for: leave it out" in said.err
