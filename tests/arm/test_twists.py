import numpy as np
import pytest
from arm_twists import numeric_twist

from random_cells import CONVENTIONS, random_arm, random_joints


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("joints", [1, 4, 7])
def test_twists_equal_finite_differences_of_the_pose(convention, joints):
    rng = np.random.default_rng([joints, 2])
    arm = random_arm(rng, joints, convention)
    readings = random_joints(rng, arm, 3)
    corrections = rng.uniform(-0.1, 0.1, len(arm.chain.parameters))
    motion = arm.chain.linearise(readings, corrections)
    for column in range(len(corrections)):
        numeric = numeric_twist(arm.chain, readings, corrections, column)
        np.testing.assert_allclose(motion.twists[:, column], numeric, rtol=1e-6, atol=1e-8)
