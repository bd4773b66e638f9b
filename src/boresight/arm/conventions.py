"""Link conventions: which elementary motions a joint's five numbers stand for (paper, eq. 1 to 3).

Standard D-H with Hayati's beta:  `Rz(q + theta) Tz(d) Tx(a) Rx(alpha) Ry(beta)`
Modified D-H (Craig) with beta:   `Ry(beta) Rx(alpha) Tx(a) Tz(d) Rz(q + theta)`, the same in reverse order
(Hayati & Mirmirani 1985; Khalil & Dombre 2002 put beta in the same place). A prismatic joint adds q to d.
"""

from __future__ import annotations

import math
from typing import Literal

from boresight.arm.motions import Motion

Convention = Literal["standard-dh", "modified-dh"]
JointType = Literal["revolute", "prismatic"]

LINK_NUMBERS = ("theta", "d", "a", "alpha", "beta")
"""The five numbers of a joint and its link."""

NEARLY_PARALLEL = math.radians(5.0)
"""Consecutive axes closer than this are parallel: their common normal, and so d, is not defined well enough,
and beta stands in for it (Hayati & Mirmirani 1985; paper, eq. 2)."""

_Z, _X, _Y = 2, 0, 1
_STANDARD_ORDER = ("theta", "d", "a", "alpha", "beta")
_MODIFIED_ORDER = ("beta", "alpha", "a", "d", "theta")
_TURNS_ABOUT = {"theta": _Z, "alpha": _X, "beta": _Y}
_SHIFTS_ALONG = {"d": _Z, "a": _X}


def link_motions(
    convention: Convention,
    joint_type: JointType,
    joint: int,
    name: str,
    numbers: dict[str, float],
    ratio: float = 1.0,
) -> tuple[Motion, ...]:
    """Returns one joint's motions in the order of its convention, its reading added to theta or d.

    Args:
        convention: standard or modified D-H.
        joint_type: revolute adds the reading to theta, prismatic to d.
        joint: the column of the joint readings.
        name: the joint's name; parameters are called `<name>.theta` and so on.
        numbers: theta, alpha, beta [rad], d, a [m].
        ratio: what the reading is multiplied by.
    """
    moving = "theta" if joint_type == "revolute" else "d"
    order = _STANDARD_ORDER if convention == "standard-dh" else _MODIFIED_ORDER
    return tuple(
        Motion(
            turns=number in _TURNS_ABOUT,
            axis=_TURNS_ABOUT.get(number, _SHIFTS_ALONG.get(number, 0)),
            value=numbers[number],
            parameter=f"{name}.{number}",
            joint=joint if number == moving else None,
            ratio=ratio if number == moving else 1.0,
        )
        for number in order
    )
