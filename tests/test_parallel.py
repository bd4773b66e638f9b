"""Independent tasks on several workers."""

import os
from concurrent.futures import ThreadPoolExecutor

import pytest

from boresight.parallel import completed, in_order, local_workers


def square(number):
    return number * number


def threads(_):
    return os.environ.get("OMP_NUM_THREADS")


def refuse(number):
    raise ValueError(f"no {number}")


def test_values_come_in_the_order_of_tasks_on_any_executor():
    expected = [n * n for n in range(50)]
    with local_workers(2) as processes, ThreadPoolExecutor(3) as pool:
        assert in_order(processes, square, range(50)) == in_order(pool, square, range(50)) == expected


def test_every_task_is_completed_once():
    with ThreadPoolExecutor(2) as pool:
        places = [place for place, _ in completed(pool, square, list(range(30)), ahead=3)]
    assert sorted(places) == list(range(30))


def test_workers_use_one_thread_each_and_the_parent_is_left_alone(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    with local_workers(1) as pool:
        assert in_order(pool, threads, [0]) == ["1"]
    assert os.environ["OMP_NUM_THREADS"] == "7"


def test_a_task_that_fails_says_so():
    with ThreadPoolExecutor(1) as pool, pytest.raises(ValueError, match="no 3"):
        in_order(pool, refuse, [3])


def test_a_task_is_handed_out_again_as_often_as_asked():
    tries = []

    def flaky(number):
        tries.append(number)
        if tries.count(number) < 3:
            raise OSError("gone")
        return number

    with ThreadPoolExecutor(1) as pool:
        assert dict(completed(pool, flaky, [7, 8], retries=2)) == {0: 7, 1: 8}
    assert sorted(tries) == [7, 7, 7, 8, 8, 8]
    tries.clear()
    with ThreadPoolExecutor(1) as pool, pytest.raises(OSError, match="gone"):
        list(completed(pool, flaky, [7], retries=1))


def test_tasks_are_taken_as_they_are_handed_out():
    taken = []

    def tasks():
        for number in range(20):
            taken.append(number)
            yield number

    with ThreadPoolExecutor(1) as pool:
        for place, _ in completed(pool, square, tasks(), ahead=2):
            assert len(taken) <= place + 4
    assert len(taken) == 20
