"""A point that is touched: the vector to it, and its exact derivative by every parameter."""

import numpy as np
import pytest

from boresight.sensing import Cell, PointContact
from random_cells import CONVENTIONS, random_arm, random_frame, random_joints, random_point

STEP = 1e-6


def cell_of(rng, convention):
    arm = random_arm(rng, 6, convention)
    points = {"first": random_point(rng), "second": random_point(rng)}
    return Cell(arm, PointContact(1e-4), random_frame(rng), random_frame(rng), points)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_it_reads_the_vector_from_the_point_to_the_tip(convention):
    rng = np.random.default_rng(1)
    cell = cell_of(rng, convention)
    joints, target = random_joints(rng, cell.arm, 20), np.arange(20) % 2
    tips = cell.poses(joints)[:, :3, 3]
    points = np.array([cell.targets[name].xyz for name in ("first", "second")])
    np.testing.assert_allclose(cell.predict(joints, target), tips - points[target], rtol=0, atol=1e-15)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_jacobian_equals_finite_differences(convention):
    rng = np.random.default_rng(2)
    cell = cell_of(rng, convention)
    joints, target = random_joints(rng, cell.arm, 20), np.arange(20) % 2
    corrections = rng.uniform(-0.003, 0.003, len(cell.parameters))
    _, jacobian = cell.linearise(joints, target, corrections)
    for place, parameter in enumerate(cell.parameters):
        step = STEP * (np.arange(len(corrections)) == place)
        ahead, behind = (cell.predict(joints, target, corrections + sign * step) for sign in (1.0, -1.0))
        numeric = (ahead - behind) / (2.0 * STEP)
        np.testing.assert_allclose(jacobian[:, :, place], numeric, rtol=0, atol=1e-7, err_msg=parameter.name)
