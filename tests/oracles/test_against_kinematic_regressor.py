"""The twist of every chain parameter against pinocchio's kinematic regressor."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from independent_arms import pinocchio_model

from random_cells import CONVENTIONS, random_arm, random_cell, random_joints


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("joints", range(1, 9))
def test_twists_equal_the_kinematic_regressor(convention, joints):
    rng = np.random.default_rng([joints, CONVENTIONS.index(convention), 7])
    cell = random_cell(rng, arm=random_arm(rng, joints, convention))
    model, displaced = pinocchio_model(cell)
    data = model.createData()
    readings = random_joints(rng, cell.arm, 10)
    motion = cell.chain.linearise(readings)
    assert set(displaced) == set(cell.chain.parameters)
    for row, q in enumerate(readings):
        q = np.append(q, 0.0)
        pin.forwardKinematics(model, data, q)
        np.testing.assert_allclose(motion.poses[row], data.oMi[model.njoints - 1].homogeneous, rtol=0, atol=1e-12)
        regressor = pin.computeJointKinematicRegressor(model, data, model.njoints - 1, pin.ReferenceFrame.WORLD)
        for column, parameter in enumerate(cell.chain.parameters):
            joint, displacement = displaced[parameter]
            expected = regressor[:, 6 * (joint - 1) : 6 * joint] @ displacement
            np.testing.assert_allclose(motion.twists[row, column], expected, rtol=1e-9, atol=1e-9)
