"""Universal Robots UR10 (CB3).

Source: Universal Robots, "DH parameters for calculations of kinematics and dynamics" (support article,
CB3 table). Joint names are those of its ROS description.

Standard D-H; the base frame is UR's own "base" (the ROS `base_link` is turned half a turn about z), the tool
frame is the flange, ROS's `tool0`. Axes 2, 3 and 4 are parallel: identify beta in place of d for joints 2 and 3.
"""

from __future__ import annotations

from boresight.arm.catalogue.tables import revolute_arm

_TURN = (-360.0, 360.0)

ARM = revolute_arm(
    "ur10",
    (
        ("shoulder_pan_joint", 0.0, 0.1273, 0.0, 90.0, _TURN),
        ("shoulder_lift_joint", 0.0, 0.0, -0.612, 0.0, _TURN),
        ("elbow_joint", 0.0, 0.0, -0.5723, 0.0, _TURN),
        ("wrist_1_joint", 0.0, 0.163941, 0.0, 90.0, _TURN),
        ("wrist_2_joint", 0.0, 0.1157, 0.0, -90.0, _TURN),
        ("wrist_3_joint", 0.0, 0.0922, 0.0, 0.0, _TURN),
    ),
)
