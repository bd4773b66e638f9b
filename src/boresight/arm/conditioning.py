"""Tables whose nearly parallel axes carry lengths far beyond the arm's own, brought to the form with beta.

Between nearly parallel axes the common normal may lie hundreds of metres away, so that in D-H without beta a thousandth
of a radian moves the tool by decimetres and no prior of angles and lengths means what it says. The same axes have
numbers of the arm's own size where d stays 0 and beta takes its place (Hayati & Mirmirani 1985).
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from boresight.arm.arm import Arm
from boresight.arm.common_normals import modified_dh, standard_dh
from boresight.arm.conventions import NEARLY_PARALLEL
from boresight.arm.screws import screws_of

SHORTER = 2.0
"""An arm is written anew where its lengths together become so many times shorter."""

_ROUNDING = 1e-12
"""Largest difference of poses [m and rad, by metre of the table's lengths] that is nothing but rounding."""


def well_conditioned(arm: Arm) -> Arm:
    """Returns the arm with lengths of its own size, which moves the same; the arm itself where it has them already.

    The form is the one that a URDF's axes get: beta in d's place between nearly parallel axes. What joints turn by
    beside their readings stays with harmonics; an arm that sags is returned as it is, since its levers end where its
    table's frames stand.
    """
    if any(joint.sag for joint in arm.joints) or not _has_nearly_parallel_axes(arm):
        return arm
    like = replace(arm, joints=tuple(replace(j, theta=t) for j, t in zip(arm.joints, _thetas(arm), strict=True)))
    convert = standard_dh if arm.convention == "standard-dh" else modified_dh
    found = convert(screws_of(arm.rigid), NEARLY_PARALLEL, like)
    if not SHORTER * found.reach < arm.reach:
        return arm
    joints = tuple(replace(n, harmonics=o.harmonics) for n, o in zip(found.joints, arm.joints, strict=True))
    found = replace(found, joints=joints, gravity=arm.gravity)
    return found if _moves_alike(found, arm) else arm


def _has_nearly_parallel_axes(arm: Arm) -> bool:
    return any(abs(math.sin(joint.alpha)) < math.sin(NEARLY_PARALLEL) for joint in arm.joints)


def _thetas(arm: Arm) -> list[float]:
    """Returns the angles [rad] near which the new form's theta are looked for.

    Nearly parallel axes whose normals lie far away have angles of any size, of which only the sum up to the next axis
    at an angle says how the arm stands.
    """
    thetas, turned = [], 0.0
    for joint in arm.joints if arm.convention == "standard-dh" else reversed(arm.joints):
        turned += joint.theta
        parallel = abs(math.sin(joint.alpha)) < math.sin(NEARLY_PARALLEL)
        thetas.append(0.0 if parallel else turned)
        turned = turned if parallel else 0.0
    return thetas if arm.convention == "standard-dh" else thetas[::-1]


def _moves_alike(one: Arm, other: Arm) -> bool:
    count = len(other.driven)
    joints = np.random.Generator(np.random.Philox(0)).uniform(-1.0, 1.0, (20, count))
    difference = np.abs(one.forward_kinematics(joints) - other.forward_kinematics(joints)).max()
    return bool(difference < _ROUNDING * max(1.0, other.reach))
