"""What a compensation found: a command for every pose, and whether it gets there."""

from __future__ import annotations

import enum
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from boresight.arm import Arm


class Reached(enum.IntEnum):
    """How a pose fared."""

    YES = 0
    NEAR_SINGULAR = 1
    AT_A_LIMIT = 2
    NO = 3

    @property
    def words(self) -> str:
        """The outcome in words."""
        return _WORDS[self]


_WORDS = {
    Reached.YES: "reached",
    Reached.NEAR_SINGULAR: "reached, near a singular configuration",
    Reached.AT_A_LIMIT: "a joint limit is in the way",
    Reached.NO: "not to be reached from these joints",
}


@dataclass(frozen=True)
class Compensation:
    """Joint commands for a batch of poses.

    Attributes:
        nominal: the arm that the controller believes in.
        calibrated: the arm as it is.
        poses: (rows, 4, 4) wanted `T_base_flange`.
        nominal_joints: (rows, joints) readings at which the nominal arm would be there [rad or m].
        joints: (rows, joints) readings at which the calibrated arm is as near as it can be, within its limits.
        missing: (rows, 2) distance [m] and angle [rad] between the wanted pose and that one.
        before: (rows, 2) the same at the nominal readings: what is compensated.
        weakest: (rows,) how far the tool goes a radian of joint motion in the direction it hardly can, angles
            counted at the arm's lever [m/rad].
        reached: (rows,) a `Reached` each.
    """

    nominal: Arm
    calibrated: Arm
    poses: Float[np.ndarray, "rows 4 4"]
    nominal_joints: Float[np.ndarray, "rows joints"]
    joints: Float[np.ndarray, "rows joints"]
    missing: Float[np.ndarray, "rows 2"]
    before: Float[np.ndarray, "rows 2"]
    weakest: Float[np.ndarray, "rows"]
    reached: Int[np.ndarray, "rows"]

    def __len__(self) -> int:
        """Number of poses."""
        return len(self.joints)

    @property
    def controller_poses(self) -> Float[np.ndarray, "rows 4 4"]:
        """The poses to command to a controller that keeps the nominal model: it then finds `joints`."""
        return self.nominal.forward_kinematics(self.joints)

    @property
    def moved(self) -> Float[np.ndarray, "rows joints"]:
        """How far each reading is from the nominal one [rad or m]."""
        return self.joints - self.nominal_joints

    def count(self, outcome: Reached) -> int:
        """Returns how many poses fared so."""
        return int(np.count_nonzero(self.reached == outcome))

    def limits_hit(self, row: int) -> tuple[str, ...]:
        """Returns the names of the joints that stand at a limit in a row."""
        low, high = self.calibrated.limits.T
        q = self.joints[row]
        return tuple(n for n, hit in zip(self.calibrated.joint_names, (q <= low) | (q >= high), strict=True) if hit)
