import numpy as np

from boresight.calibration.thinning import FEWEST, thinned
from boresight.sensing import Readings


def readings(target):
    count = len(target)
    return Readings(
        np.zeros((count, 6)), np.ones((count, 1)), np.ones((count, 1)), np.asarray(target), np.arange(count)
    )


def test_few_rows_are_kept_whole():
    assert thinned(readings(np.zeros(200, dtype=int)), few=100).tolist() == list(range(200))


def test_many_rows_are_thinned_evenly_over_the_file_and_the_same_way_every_time():
    many = readings(np.zeros(100_000, dtype=int))
    chosen = thinned(many, few=1_000)
    assert chosen.tolist() == thinned(many, few=1_000).tolist()
    assert len(chosen) == len(set(chosen.tolist())) == 1_000
    assert np.all(np.diff(chosen) > 0)
    assert np.all(np.bincount(chosen // 10_000, minlength=10) == 100)


def test_rows_in_cycles_are_not_hit_in_step():
    chosen = thinned(readings(np.zeros(100_000, dtype=int)), few=1_000)
    shares = np.bincount(chosen % 10, minlength=10) / len(chosen)
    assert np.all(np.abs(shares - 0.1) < 0.05)


def test_every_aim_keeps_enough():
    target = np.zeros(100_000, dtype=int)
    target[::1000] = 1
    target[5::100] = 2
    chosen = target[thinned(readings(target), few=1_000)]
    assert np.count_nonzero(chosen == 1) == 100
    assert np.count_nonzero(chosen == 2) == FEWEST
