"""Joint commands, or poses for a controller, as CSV."""

from __future__ import annotations

import csv
import io

import numpy as np

from boresight.compensation import Compensation, Reached
from boresight.files.columns import QUATERNION
from boresight.files.poses import POSITION
from boresight.geometry import matrix_quaternion
from boresight.units import Units

_WORDS = {Reached.YES: "yes", Reached.NEAR_SINGULAR: "near-singular", Reached.AT_A_LIMIT: "at-limit", Reached.NO: "no"}


def commands_csv(
    found: Compensation, units: Units, others: tuple[tuple[str, ...], ...] = (), controller_poses: bool = False
) -> str:
    """Returns the text of a file of commands: a row a pose, in its order.

    Args:
        found: the commands.
        units: to write them in, those of the poses' file.
        others: header and cells of columns to hand on, before ours.
        controller_poses: whether to write poses for a controller with the nominal model rather than joint readings.
    """
    if controller_poses:
        poses = found.controller_poses
        names: tuple[str, ...] = (*POSITION, *QUATERNION)
        numbers = np.hstack([poses[:, :3, 3] / units.metres, matrix_quaternion(poses[:, :3, :3])])
    else:
        names = found.calibrated.joint_names
        scales = [units.radians if joint.type == "revolute" else units.metres for joint in found.calibrated.driven]
        numbers = found.joints / scales
    missing = found.missing / [units.metres, units.radians]
    kept = others or ((),) * (len(found) + 1)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*kept[0], *names, "reached", "missing_position", "missing_orientation"])
    for own, row, reached, left in zip(kept[1:], numbers, found.reached, missing, strict=True):
        writer.writerow([*own, *map(repr, row.tolist()), _WORDS[Reached(reached)], *(f"{m:.3g}" for m in left)])
    return text.getvalue()
