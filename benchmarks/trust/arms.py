"""Nominal arms, of the kinds that people calibrate; their tables are this file's own and end in the sensor's frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from benchmarks.trust.kinematics import Arm

TURN = (-170.0, 170.0)
"""Limits of a revolute joint [deg]."""

Row = tuple[str, float, float, float, float, tuple[float, float]]
"""Type, theta [deg], d [m], a [m], alpha [deg], limits [deg or m]."""


def table(*rows: Row) -> Arm:
    """Returns an arm from rows in degrees and metres."""
    types = "".join(row[0] for row in rows)
    theta, d, a, alpha = np.array([row[1:5] for row in rows], dtype=float).T
    limits = np.array([np.deg2rad(row[5]) if row[0] == "r" else row[5] for row in rows])
    return Arm(types, np.deg2rad(theta), d, a, np.deg2rad(alpha), np.zeros(len(rows)), limits)


def scara() -> Arm:
    return table(
        ("r", 0, 0.60, 0.35, 0, (-150, 150)),
        ("r", 0, 0, 0.28, 180, (-150, 150)),
        ("p", 0, 0.05, 0, 0, (0.0, 0.30)),
        ("r", 0, 0.06, 0.04, 35, TURN),
    )


def five_axes() -> Arm:
    return table(
        ("r", 0, 0.35, 0.05, -90, TURN),
        ("r", 0, 0, 0.40, 0, TURN),
        ("r", 0, 0, 0.35, 0, TURN),
        ("r", 0, 0, 0, -90, TURN),
        ("r", 0, 0.15, 0.05, 25, TURN),
    )


def gantry() -> Arm:
    return table(
        ("p", 0, 0.5, 0.02, -90, (0.0, 1.2)),
        ("p", 90, 0.4, 0.03, 90, (0.0, 1.0)),
        ("p", -90, 0.6, 0, 180, (0.0, 0.6)),
        ("r", 0, 0.10, 0, -90, TURN),
        ("r", 0, 0, 0, 90, TURN),
        ("r", 0, 0.12, 0.06, 30, TURN),
    )


def space_arm() -> Arm:
    return table(
        ("r", 0, 0.35, 0, -90, TURN),
        ("r", 0, 0, 0.45, 0, TURN),
        ("r", 0, 0.15, 0, 90, TURN),
        ("r", 0, 0.40, 0, -90, TURN),
        ("r", 0, 0, 0, 90, (-120, 120)),
        ("r", 0, 0.12, 0.06, 30, TURN),
    )


def puma_like() -> Arm:
    return table(
        ("r", 0, 0.40, 0.05, -90, TURN),
        ("r", 0, 0, 0.42, 0, TURN),
        ("r", 0, 0.12, 0.03, -90, TURN),
        ("r", 0, 0.42, 0, 90, TURN),
        ("r", 0, 0, 0, -90, TURN),
        ("r", 0, 0.10, 0.05, 25, TURN),
    )


def ur_like() -> Arm:
    return table(
        ("r", 0, 0.13, 0, 90, TURN),
        ("r", 0, 0, -0.61, 0, TURN),
        ("r", 0, 0, -0.57, 0, TURN),
        ("r", 0, 0.16, 0, 90, TURN),
        ("r", 0, 0.12, 0, -90, TURN),
        ("r", 0, 0.10, 0.05, 30, TURN),
    )


def seven_axes() -> Arm:
    return table(
        ("r", 0, 0.36, 0, -90, TURN),
        ("r", 0, 0, 0, 90, (-120, 120)),
        ("r", 0, 0.42, 0, 90, TURN),
        ("r", 0, 0, 0, -90, (-120, 120)),
        ("r", 0, 0.40, 0, -90, TURN),
        ("r", 0, 0, 0, 90, (-120, 120)),
        ("r", 0, 0.20, 0.06, 25, TURN),
    )


def long_seven_axes() -> Arm:
    return table(
        ("r", 0, 0.38, 0, 90, TURN),
        ("r", 0, 0.14, 0, 90, TURN),
        ("r", 0, 0.05, 0.72, 0, TURN),
        ("r", 0, 0, 0.70, 0, TURN),
        ("r", 0, 0.12, 0, 90, TURN),
        ("r", 0, 0.14, 0, -90, TURN),
        ("r", 0, 0.21, 0.05, 20, TURN),
    )


ARMS: dict[str, Callable[[], Arm]] = {
    "SCARA": scara,
    "five axes": five_axes,
    "gantry": gantry,
    "space arm": space_arm,
    "PUMA-like": puma_like,
    "UR-like": ur_like,
    "seven axes": seven_axes,
    "long seven axes": long_seven_axes,
}


def arm_of(name: str, size: float = 1.0) -> Arm:
    """Returns a nominal arm, all of its lengths times `size`."""
    arm = ARMS[name]()
    limits = np.where(arm.revolute[:, None], arm.limits, size * arm.limits)
    return replace(arm, d=size * arm.d, a=size * arm.a, limits=limits)
