"""Rows of one configuration are one piece of evidence."""

import numpy as np
import pytest

from boresight.calibration.configurations import FEW, SAME, configurations_of, repeats_of


def test_rows_that_differ_by_a_hairs_breadth_are_one_configuration():
    joints = np.array([[0.0, 1.0], [0.5, 1.0], [0.004, 0.996], [0.5, 1.03]])
    assert configurations_of(joints).tolist() == [0, 1, 0, 2]
    assert repeats_of(joints).tolist() == [2, 1, 2, 1]


@pytest.mark.parametrize("rows", [40, FEW + 40])
def test_repeats_are_counted_whether_rows_are_few_or_many(rows):
    random = np.random.default_rng(0)
    postures = np.round(random.uniform(-3.0, 3.0, (rows // 4, 6)) / (20 * SAME)) * 20 * SAME
    joints = np.repeat(np.unique(postures, axis=0), 4, axis=0)
    assert np.all(repeats_of(joints) == 4)
    assert len(np.unique(configurations_of(joints))) == len(joints) // 4
