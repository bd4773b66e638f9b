"""The turn about z0 that no range sees, and its removal."""

import numpy as np
import pytest

from boresight.geometry.rotations import axis_rotation
from boresight.reproduction.ambiguity import azimuth_between, turned_about_base, without_azimuth
from boresight.reproduction.experiment import Assumptions, experiment


@pytest.mark.parametrize("angle", [-2.5, -0.01, 0.0, 1e-4, 0.7])
def test_a_turned_arm_and_plane_read_the_same_and_differ_by_that_turn_alone(angle):
    drawn = experiment(2, Assumptions(azimuth=True))
    truth, joints = drawn.truth, drawn.validation
    normal = axis_rotation(2, angle) @ np.asarray(truth.targets["deck"].normal)
    first, second = (normal[axis] - truth.targets["deck"].normal[axis] for axis in (0, 2))
    turned = truth.corrected({"j1.theta": angle, "deck.normal_x": first, "deck.normal_z": second})
    if normal[1] > 0.0:  # n_y follows from |n| = 1 with the sign it had
        read = [cell.predict(drawn.readings.joints, drawn.readings.target) for cell in (truth, turned)]
        assert np.allclose(*read, rtol=0, atol=1e-12)
    found, real = turned.poses(joints), truth.poses(joints)
    assert np.allclose(without_azimuth(found, real), real, rtol=0, atol=1e-12)
    assert azimuth_between(found, real) == pytest.approx(-angle, abs=1e-12)


def test_removing_the_turn_never_makes_positions_worse_and_no_other_turn_is_better():
    rng = np.random.default_rng(0)
    real = experiment(0).truth.poses(experiment(0).validation)
    found = real.copy()
    found[:, :3, 3] += rng.normal(0.0, 0.01, (len(real), 3))

    def squares(poses):
        return np.sum((poses[:, :3, 3] - real[:, :3, 3]) ** 2)

    best = squares(without_azimuth(found, real))
    assert best < squares(found)
    for angle in (-0.02, -1e-3, 1e-3, 0.02):
        assert squares(turned_about_base(without_azimuth(found, real), angle)) > best


def test_heights_are_not_touched():
    poses = experiment(0).truth.poses(experiment(0).validation)
    assert np.array_equal(turned_about_base(poses, 0.4)[:, 2, 3], poses[:, 2, 3])
