"""A study on a real Dask scheduler with worker processes of its own, one of which is killed mid-way."""

import os
import re
import signal
import subprocess
import sys
from contextlib import ExitStack, contextmanager

import pytest
from small_studies import numbers, small_study

from boresight.errors import InputError
from boresight.studies import run, study

pytest.importorskip("distributed")

SEEDS = 12


@contextmanager
def started(*arguments, until):
    """A process of Dask's own command line, once it has said a line that matches."""
    places = os.pathsep.join([os.path.dirname(__file__), *sys.path])
    process = subprocess.Popen(
        [sys.executable, "-m", *arguments],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": places},
        start_new_session=True,
    )
    try:
        for line in process.stderr:
            if match := re.search(until, line):
                break
        else:
            raise AssertionError(f"{arguments} ended with {process.wait()}")
        yield process, match
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.stderr.close()
        process.wait()


@contextmanager
def a_cluster(workers):
    """A scheduler's address and its worker processes."""
    dashboard = ("--no-dashboard",)
    with ExitStack() as stack:
        scheduler = started(
            "distributed.cli.dask_scheduler", "--port", "0", "--host", "127.0.0.1", *dashboard, until=r"(tcp://\S+:\d+)"
        )
        _, match = stack.enter_context(scheduler)
        address = match[1]
        options = ("--nthreads", "1", "--no-nanny", *dashboard)
        each = [
            stack.enter_context(started("distributed.cli.dask_worker", address, *options, until="Registered to"))[0]
            for _ in range(workers)
        ]
        yield address, each


@pytest.mark.long
@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning")
def test_a_worker_killed_midway_costs_nothing(tmp_path):
    asked, path = small_study(SEEDS), tmp_path / "runs.sqlite"
    killed = []

    with a_cluster(2) as (address, workers):

        def kill_one(done, asked):
            if done >= 4 and not killed:
                killed.append(done)
                os.kill(workers[0].pid, signal.SIGKILL)

        found = study(asked, path, scheduler=address, on_progress=kill_one)
        assert workers[0].wait() == -signal.SIGKILL
        assert workers[1].poll() is None
    assert killed[0] < len(asked)
    expected = [(each.key, seed, run(each, seed).numbers) for each in asked.points for seed in range(SEEDS)]
    assert numbers(found) == expected


@pytest.mark.long
@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning")
def test_a_scheduler_that_is_not_there_or_has_no_workers_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr("boresight.studies.cluster.PATIENCE_S", 1.0)
    with pytest.raises(InputError, match=r"no Dask scheduler answers at tcp://127\.0\.0\.1:9"):
        study(small_study(), tmp_path / "runs.sqlite", scheduler="tcp://127.0.0.1:9")
    with a_cluster(0) as (address, _), pytest.raises(InputError, match="has no workers; start some: dask worker"):
        study(small_study(), tmp_path / "runs.sqlite", scheduler=address)


def test_without_dask_it_is_told_how_to_install_it(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError, match=r"pip install 'boresight\[cluster\]'"):
        study(small_study(), tmp_path / "runs.sqlite", scheduler="tcp://localhost:8786")


@pytest.mark.parametrize(
    "address",
    ["", "tcp://", "file:///etc/passwd", "tcp://host", "tcp://host:0", "tcp://host:99999", "x" * 5000, "a\udcff:1"],
)
def test_addresses_that_are_none_are_told_at_once(tmp_path, address):
    with pytest.raises(InputError, match="expected an address such as tcp://host:8786"):
        study(small_study(), tmp_path / "runs.sqlite", scheduler=address)
