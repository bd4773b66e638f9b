"""Whether the corrections are expected to bring the tool nearer to the truth."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from boresight.calibration.complete_model import CompleteModel
from boresight.inference.accuracy import without_rigid_motion
from boresight.inference.pose import tool_slopes
from boresight.sensing import Cell


def expected_gain(
    cell: Cell,
    known: CompleteModel,
    x: Float[np.ndarray, "free"],
    joints: Float[np.ndarray, "configurations joints"],
) -> float:
    """Returns by how much the tool's mean squared error is expected to fall, over what the corrections move it squared.

    With z the truth, expected at x + m, the errors before and after are T z and T (z - x), and the expected fall of
    their squares is |T x|² + 2 m'T'T x: 1 where nothing but the corrections is known, negative where what was not
    estimated is likely to undo them. Rigid motions of the whole arm, which an unknown base takes, are left out.

    Args:
        cell: the identified cell.
        known: the complete model, whose posterior mean is m away from the estimate.
        x: the corrections.
        joints: configurations [rad or m] at which the tool is asked for.
    """
    slopes, columns = tool_slopes(cell, known.names, joints)
    slopes = without_rigid_motion(slopes, cell.poses(joints)[:, :3, 3])[:, :, :3]
    moved = np.append(x, np.zeros(len(known.names) - len(x)))[columns]
    shift, rest = (np.einsum("rpi,p->ri", slopes, each) for each in (moved, known.mean[columns]))
    square = float(np.sum(shift**2))
    return 1.0 + 2.0 * float(np.sum(rest * shift)) / square if square > 0.0 else 1.0
