import numpy as np
import pytest

from random_cells import CONVENTIONS, random_arm, random_joints

STEP = 1e-6


def twist_between(behind, ahead):
    """Returns (v, w) a unit of the step that leads from one pose to another, by central differences."""
    rate = (ahead - behind) / (2 * STEP)
    middle = 0.5 * (ahead + behind)
    spin = rate[:3, :3] @ middle[:3, :3].T
    w = 0.5 * np.array([spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0], spin[1, 0] - spin[0, 1]])
    return np.concatenate([rate[:3, 3] - np.cross(w, middle[:3, 3]), w])


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("joints", [1, 4, 7])
def test_twists_equal_finite_differences_of_the_pose(convention, joints):
    rng = np.random.default_rng([joints, 2])
    arm = random_arm(rng, joints, convention)
    readings = random_joints(rng, arm, 3)
    corrections = rng.uniform(-0.1, 0.1, len(arm.chain.parameters))
    motion = arm.chain.linearise(readings, corrections)
    for column in range(len(corrections)):
        step = np.zeros_like(corrections)
        step[column] = STEP
        ahead = arm.chain.poses(readings, corrections + step)
        behind = arm.chain.poses(readings, corrections - step)
        for row in range(3):
            numeric = twist_between(behind[row], ahead[row])
            np.testing.assert_allclose(motion.twists[row, column], numeric, rtol=1e-6, atol=1e-8)
