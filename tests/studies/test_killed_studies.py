"""A study whose process is killed resumes: nothing is lost, nothing is made twice, nobody is left behind."""

import os
import signal
import sqlite3
import subprocess
import sys
import time

import pytest
from small_studies import numbers, small_study

from boresight.studies import Store, study, summarise

SCRIPT = """
import sys
from pathlib import Path
from small_studies import small_study
from boresight.studies import study

if __name__ == "__main__":
    asked, path = small_study(int(sys.argv[2])), Path(sys.argv[1])
    study(asked, path, workers=2, on_progress=lambda *both: print(*both, flush=True))
"""

SEEDS = 20


def begun(path, folder):
    """The study as a process group of its own."""
    script = folder / "begin.py"
    script.write_text(SCRIPT)
    places = os.pathsep.join([str(os.path.dirname(__file__)), *sys.path])
    return subprocess.Popen(
        [sys.executable, str(script), str(path), str(SEEDS)],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": places},
        start_new_session=True,
    )


def others_in_session(leader):
    """Processes that the leader started and left behind."""
    left = []
    for entry in os.listdir("/proc"):
        if entry.isdigit() and int(entry) != leader:
            try:
                with open(f"/proc/{entry}/stat") as file:
                    fields = file.read().rpartition(")")[2].split()
            except OSError:
                continue
            if int(fields[3]) == leader and fields[0] != "Z":
                left.append(int(entry))
    return left


@pytest.mark.long
@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="counts processes in /proc")
def test_a_study_killed_twice_ends_with_the_numbers_of_one_that_was_not(tmp_path):
    asked, path = small_study(SEEDS), tmp_path / "runs.sqlite"
    done = 0
    for _ in range(2):
        with begun(path, tmp_path) as process:
            first = int(process.stdout.readline().split()[0])
            assert first >= done  # what was told before the last kill is still there
            for line in process.stdout:
                done = int(line.split()[0])
                if done >= first + 5:
                    break
            process.send_signal(signal.SIGKILL)
        assert done < len(asked)
        deadline = time.monotonic() + 15
        while others_in_session(process.pid) and time.monotonic() < deadline:
            time.sleep(0.1)
        assert others_in_session(process.pid) == []
        with Store.open(path, create=False) as store:
            assert summarise(asked, store).done >= done
    kept = times(path)
    resumed = study(asked, path, workers=2)
    assert {run: seconds for run, seconds in times(path).items() if run in kept} == kept  # none was made again
    whole = study(asked, tmp_path / "whole.sqlite", workers=2)
    assert resumed.done == len(asked)
    assert numbers(resumed) == numbers(whole)


def times(path):
    """The search's time of every run: no second run would take the same to the last bit."""
    with sqlite3.connect(path) as file:
        found = {(point, seed): s for point, seed, s in file.execute("SELECT point, seed, seconds FROM runs")}
    file.close()
    return found
