"""A study's numbers do not depend on who makes the runs, in which order, or how often it is begun."""

import os
import signal
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import pytest
from small_studies import numbers, point, small_study

from boresight.errors import BoresightError, OutputError
from boresight.parallel import local_workers
from boresight.studies import Store, run, study
from boresight.studies.study import Shard, missing, run_task


@pytest.fixture(scope="module")
def reference():
    """The outcomes, one after the other in this process."""
    asked = small_study()
    return [(each.key, seed, run(each, seed).numbers) for each in asked.points for seed in range(asked.seeds)]


@pytest.mark.long
def test_numbers_are_the_same_on_one_worker_two_workers_and_threads(tmp_path, reference):
    asked = small_study()
    assert numbers(study(asked, tmp_path / "one.sqlite", workers=1)) == reference
    assert numbers(study(asked, tmp_path / "two.sqlite", workers=2)) == reference
    with ThreadPoolExecutor(5) as threads:
        assert numbers(study(asked, tmp_path / "threads.sqlite", executor=threads)) == reference


def test_shards_put_together_are_the_whole(tmp_path, reference):
    asked = small_study()
    with ThreadPoolExecutor(2) as pool:
        counts = [
            study(asked, tmp_path / f"{number}.sqlite", executor=pool, shard=Shard(number, 3)).done
            for number in (1, 2, 3)
        ]
        with Store.open(tmp_path / "1.sqlite") as store:
            assert store.absorb(tmp_path / "2.sqlite") + store.absorb(tmp_path / "3.sqlite") == counts[1] + counts[2]
        assert sum(counts) == len(asked) == 8
        whole = study(asked, tmp_path / "1.sqlite", executor=pool)
    assert numbers(whole) == reference


def test_shards_of_one_machine_may_share_a_file(tmp_path, reference):
    asked = small_study()
    with ThreadPoolExecutor(2) as studies, ThreadPoolExecutor(2) as pool:
        parts = [
            studies.submit(study, asked, tmp_path / "runs.sqlite", executor=pool, shard=Shard(n, 2)) for n in (1, 2)
        ]
        assert [part.result() is not None for part in parts] == [True, True]
        assert numbers(study(asked, tmp_path / "runs.sqlite", executor=pool)) == reference


class Counting(ThreadPoolExecutor):
    """Counts the runs that are handed out."""

    runs = 0

    def submit(self, function, task):
        assert function is run_task
        self.runs += len(task)
        return super().submit(function, task)


def test_nothing_is_made_twice_and_a_longer_study_goes_on(tmp_path, reference):
    path = tmp_path / "runs.sqlite"
    with Counting(2) as pool:
        study(small_study(2), path, executor=pool)
        assert pool.runs == 4
        study(small_study(2), path, executor=pool)
        assert pool.runs == 4
        assert numbers(study(small_study(), path, executor=pool)) == reference
        assert pool.runs == 8
        wider = small_study(4, {"rows": (30, 45, 60)})
        assert study(wider, path, executor=pool).done == 12
        assert pool.runs == 12


def test_progress_counts_what_was_done_before(tmp_path):
    seen = []
    with ThreadPoolExecutor(1) as pool:
        study(small_study(1), tmp_path / "runs.sqlite", executor=pool)
        study(small_study(3), tmp_path / "runs.sqlite", executor=pool, on_progress=lambda *both: seen.append(both))
    assert seen[0] == (2, 6)
    assert seen[-1] == (6, 6)
    assert [done for done, _ in seen] == sorted(done for done, _ in seen)


def test_a_task_whose_worker_failed_is_handed_out_again(tmp_path, reference):
    class Unreliable(ThreadPoolExecutor):
        failures = 3

        def submit(self, function, task):
            if self.failures:
                self.failures -= 1
                return super().submit(fail)
            return super().submit(function, task)

    with Unreliable(2) as pool:
        assert numbers(study(small_study(), tmp_path / "runs.sqlite", executor=pool)) == reference


def fail():
    raise OSError("the worker is gone")


@pytest.mark.long
def test_a_killed_worker_process_costs_nothing(tmp_path, reference, monkeypatch):
    path, killed = tmp_path / "runs.sqlite", []

    def kill_one(done, asked):
        if done and not killed:
            killed.append(next(iter(pools[-1]._processes)))
            os.kill(killed[0], signal.SIGKILL)

    pools = []
    start = ProcessPoolExecutor.__init__

    def remembered(self, *arguments, **options):
        start(self, *arguments, **options)
        pools.append(self)

    monkeypatch.setattr(ProcessPoolExecutor, "__init__", remembered)
    assert numbers(study(small_study(), path, workers=2, on_progress=kill_one)) == reference
    assert len(killed) == 1
    assert len(pools) == 2


def test_workers_that_keep_dying_are_told_and_what_was_done_is_kept(tmp_path):
    with local_workers(1) as pool:
        pool.submit(os.getpid).result()
        for process in list(pool._processes):
            os.kill(process, signal.SIGKILL)
        deadline = time.monotonic() + 20
        while not pool._broken and time.monotonic() < deadline:
            time.sleep(0.05)
        with pytest.raises(BoresightError, match="worker processes keep dying"):
            study(small_study(), tmp_path / "runs.sqlite", executor=pool)
    assert (tmp_path / "runs.sqlite").exists()


def test_missing_runs_keep_their_order(tmp_path):
    with Store.open(tmp_path / "runs.sqlite") as store:
        store.add(point(rows=30), 1, run(point(rows=30), 1))
        left = missing(store, list(small_study(2).runs()))
    assert [(each.settings.rows, seed) for each, seed in left] == [(30, 0), (45, 0), (45, 1)]


def test_a_shard_that_does_not_exist_is_refused():
    with pytest.raises(ValueError, match="shard 3 of 2"):
        Shard(3, 2)


def test_a_half_written_run_is_no_run(tmp_path):
    with Store.open(tmp_path / "runs.sqlite") as store:
        with pytest.raises(OutputError):
            store.add_many([(point(), 0, run(point(), 0)), (point(), [], run(point(), 1))])
        assert store.seeds(point()) == set()
