import numpy as np

from boresight.sensing import Readings


def readings(rows=5):
    count = np.arange(rows)
    values = count[:, None].astype(float)
    return Readings(np.column_stack([values, -values]), values, np.ones((rows, 1)), count % 2, count + 2)


def test_chosen_rows_keep_everything_together_by_index_or_mask():
    everything = readings()
    assert len(everything) == 5
    by_index, by_mask = everything.chosen(np.array([1, 4])), everything.chosen(np.array([0, 1, 0, 0, 1], dtype=bool))
    for part in (by_index, by_mask):
        assert len(part) == 2
        np.testing.assert_array_equal(part.joints, [[1.0, -1.0], [4.0, -4.0]])
        np.testing.assert_array_equal(part.values, [[1.0], [4.0]])
        np.testing.assert_array_equal(part.target, [1, 0])
        np.testing.assert_array_equal(part.line, [3, 6])
