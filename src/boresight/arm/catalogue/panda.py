"""Franka Emika Panda.

Source: Franka Emika, "Robot and interface specifications: Denavit-Hartenberg parameters" and "Joint space
limits" (Franka Control Interface documentation, Panda, 2017 to 2021).

Modified D-H (Craig). The tool frame is the flange (`panda_link8`). Franka prints it as an eighth, fixed row
with d = 0.107 m; a shift along z and the turn of joint 7 about the same z commute, so it stands in row 7 here.
The hand, turned by -45 degrees, is not in the table.
"""

from __future__ import annotations

import math

from boresight.arm.catalogue.tables import revolute_arm


def _degrees(lowest_rad: float, highest_rad: float) -> tuple[float, float]:
    return math.degrees(lowest_rad), math.degrees(highest_rad)


ARM = revolute_arm(
    "panda",
    (
        ("panda_joint1", 0.0, 0.333, 0.0, 0.0, _degrees(-2.8973, 2.8973)),
        ("panda_joint2", 0.0, 0.0, 0.0, -90.0, _degrees(-1.7628, 1.7628)),
        ("panda_joint3", 0.0, 0.316, 0.0, 90.0, _degrees(-2.8973, 2.8973)),
        ("panda_joint4", 0.0, 0.0, 0.0825, 90.0, _degrees(-3.0718, -0.0698)),
        ("panda_joint5", 0.0, 0.384, -0.0825, -90.0, _degrees(-2.8973, 2.8973)),
        ("panda_joint6", 0.0, 0.0, 0.0, 90.0, _degrees(-0.0175, 3.7525)),
        ("panda_joint7", 0.0, 0.107, 0.088, 90.0, _degrees(-2.8973, 2.8973)),
    ),
    "modified-dh",
)
