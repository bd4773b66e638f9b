"""A result folder changes as one: a mixture of two is refused, and what killed runs left is removed."""

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import boresight
from boresight.calibration import Solver, calibrate
from boresight.errors import InputError
from boresight.files import load_campaign
from boresight.files.folders import staged, swap_in
from boresight.files.writing import uninterrupted, write_atomically, written
from boresight.report import write_result
from boresight.report.stored import load_result

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Two accepted results of one campaign, by different numbers of rows."""
    folders = []
    for name in ("space-arm-one-plane", "space-arm-three-planes"):
        campaign = load_campaign(EXAMPLES / name / "campaign.yaml")
        folder = tmp_path_factory.mktemp(name)
        write_result(calibrate(campaign, Solver("least-squares")), folder, boresight.__version__)
        folders.append(folder)
    return folders


def test_every_file_beside_a_result_is_named_by_its_digest(results):
    document = json.loads((results[0] / "result.json").read_text())
    assert set(document["files"]) == {path.name for path in results[0].iterdir()} - {"result.json", "report.html"}
    assert load_result(results[0]).accepted


def test_the_robot_of_another_run_is_refused(results, tmp_path):
    shutil.copytree(results[0], tmp_path / "mixed")
    shutil.copy(results[1] / "robot-calibrated.yaml", tmp_path / "mixed")
    with pytest.raises(InputError, match=r"robot-calibrated\.yaml: does not belong to result\.json beside it"):
        load_result(tmp_path / "mixed")


def test_a_result_of_an_earlier_version_is_read_without_digests(results, tmp_path):
    shutil.copytree(results[0], tmp_path / "old")
    document = json.loads((tmp_path / "old" / "result.json").read_text())
    del document["files"]
    (tmp_path / "old" / "result.json").write_text(json.dumps(document))
    assert load_result(tmp_path / "old").accepted


def test_what_a_killed_run_left_is_removed_and_what_a_running_one_holds_is_not(tmp_path):
    (tmp_path / ".boresight-left").mkdir()
    (tmp_path / ".boresight-left" / "report.html").write_text("half")
    with staged(tmp_path) as first:
        assert not (tmp_path / ".boresight-left").exists()
        code = (
            "import sys; from pathlib import Path; from boresight.files.folders import staged\n"
            "with staged(Path(sys.argv[1])): pass"
        )
        subprocess.run([sys.executable, "-c", code, str(tmp_path)], check=True)
        assert first.exists()
    assert list(tmp_path.iterdir()) == []


def test_temporary_files_of_killed_runs_go_after_an_hour(tmp_path):
    old, young = tmp_path / ".boresight-0123.tmp", tmp_path / ".boresight-4567.tmp"
    for path in (old, young):
        path.write_text("half")
    os.utime(old, (1.0, 1.0))
    write_atomically(tmp_path / "whole.csv", "whole")
    assert sorted(path.name for path in tmp_path.iterdir()) == [young.name, "whole.csv"]


def test_ctrl_c_waits_until_all_files_are_there(tmp_path):
    staging = tmp_path / "staging"
    staging.mkdir()
    for name in ("one", "two"):
        (staging / name).write_text(name)
    done = []

    def interrupted():
        with uninterrupted(tmp_path / "out"):
            os.kill(os.getpid(), signal.SIGINT)
            swap_in(staging, tmp_path, ["one", "two"])
            done.append((tmp_path / "two").exists())

    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it
    try:
        with pytest.raises(KeyboardInterrupt):
            interrupted()
    finally:
        signal.signal(signal.SIGINT, before)
    assert done == [True]
    assert tmp_path / "out" in written()
