import numpy as np

from boresight.geometry import Plane, range_to_plane
from random_cells import random_plane

FLOOR = Plane.of((0.0, 0.0, 1.0), 0.0)


def test_range_is_the_distance_along_the_beam():
    beam = np.array([[0.0, 0.6, -0.8]])
    np.testing.assert_allclose(range_to_plane(np.array([[0.0, 0.0, 2.0]]), beam, FLOOR), [2.5], rtol=1e-15)


def test_beam_that_looks_away_reads_nan_from_either_side():
    origins = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
    beams = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
    np.testing.assert_array_equal(range_to_plane(origins, beams, FLOOR), [np.nan, np.nan, 1.0, 1.0])


def test_beam_along_the_plane_reads_nan():
    assert np.isnan(range_to_plane(np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]), FLOOR))


def test_hit_point_lies_on_the_plane_and_a_batch_equals_a_loop():
    rng = np.random.default_rng(5)
    plane = random_plane(rng)
    origins = rng.normal(size=(4, 25, 3))
    beams = rng.normal(size=(4, 25, 3))
    beams /= np.linalg.norm(beams, axis=-1, keepdims=True)
    ranges = range_to_plane(origins, beams, plane)
    hits = ~np.isnan(ranges)
    assert hits.any()
    assert not hits.all()
    points = origins[hits] + ranges[hits][:, None] * beams[hits]
    assert np.max(np.abs(plane.height(points)) / np.maximum(ranges[hits], 1.0)) < 1e-14
    assert np.all(ranges[hits] > 0.0)
    for place in np.ndindex(4, 25):
        alone = range_to_plane(origins[place], beams[place], plane)
        np.testing.assert_allclose(alone, ranges[place], rtol=1e-12)
