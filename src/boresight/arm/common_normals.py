"""From the joints' axes to D-H numbers, with beta where axes are nearly parallel.

Each axis is a line; the next link's theta, d, a and alpha lead along the common normal to the next line (Denavit &
Hartenberg 1955). Nearly parallel lines meet their common normal anywhere, kilometres away: there the next line is
met where it pierces the plane through the frame's origin instead, d stays 0 and beta completes the direction (Hayati
& Mirmirani 1985). How far along and about its own axis a joint's frame stands moves nothing, so every chain of axes
has such numbers, exactly.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from boresight.arm.arm import Arm, Joint
from boresight.arm.conventions import LINK_NUMBERS, NEARLY_PARALLEL
from boresight.arm.screws import Screw, Screws
from boresight.geometry import Frame, inverse
from boresight.geometry.rotations import axis_rotation

_SAME_LINE = 1e-13
"""Distance [m] below which two parallel axes are one line, whose normal has no direction."""

_ON_AXIS = 1e-6
"""The same for a tool whose z lies along the last axis: the tool's own frame can take up so little."""

_EXACTLY_PARALLEL = 1e-10
"""Sine below which axes are parallel even where beta is not wanted: d would be beyond all measure."""

_ROUNDING = 1e-15
"""Numbers [m or rad] below which there is nothing but rounding."""

_QUARTER = math.pi / 2 + 1e-9

Line = tuple[Float[np.ndarray, "3"] | None, Float[np.ndarray, "3"]]
"""A point, or None where any will do, and a direction."""


def standard_dh(screws: Screws, parallel_below: float = NEARLY_PARALLEL, like: Arm | None = None) -> Arm:
    """Returns an arm in standard D-H with beta that moves as the screws do (paper, eq. 1 to 4).

    Args:
        screws: the arm.
        parallel_below: angle [rad] between axes below which beta takes d's place; 0 for D-H without beta, whose d
            grows without bound as axes become parallel.
        like: of the two directions a normal has, the one is taken whose theta is within a quarter turn of this arm's;
            of 0 by default.
    """
    first = screws.joints[0]
    root = _frame_on(np.array(first.axis), np.array(first.point) if first.type == "revolute" else np.zeros(3))
    near = [joint.theta for joint in like.joints] if like is not None else [0.0] * len(screws.joints)
    numbers, end = _links(root, [_line(screw) for screw in screws.joints], screws.home, parallel_below, near)
    joints = tuple(_joint(screw, link) for screw, link in zip(screws.joints, numbers, strict=True))
    return Arm(screws.name, joints, "standard-dh", _frame(root), _frame(inverse(end) @ screws.home))


def modified_dh(screws: Screws, parallel_below: float = NEARLY_PARALLEL, like: Arm | None = None) -> Arm:
    """Returns an arm in modified D-H (Craig) with beta that moves as the screws do; see `standard_dh`.

    Modified numbers are the standard ones of the arm seen from its tool, each with the other sign.
    """
    back = standard_dh(_reversed(screws), parallel_below, None if like is None else _thetas_from_the_tool(like))
    joints = tuple(
        joint.with_numbers({name: -value + 0.0 for name, value in joint.numbers.items()})
        for joint in reversed(back.joints)
    )
    root, tip = _frame(inverse(back.tip.matrix)), _frame(inverse(back.root.matrix))
    return Arm(screws.name, joints, "modified-dh", root, tip)


def axis_frame(axis: Sequence[float] | Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
    """Returns a rotation that turns z into a unit vector: the least, or of vectors that look back the least after half
    a turn about x, since near -z the least has no direction.
    """
    x, y, z = (float(value) for value in axis)
    if z < 0.0:
        return np.diag([1.0, -1.0, -1.0]) @ axis_frame((x, -y, -z))
    cross = np.array([[0.0, 0.0, x], [0.0, 0.0, y], [-x, -y, 0.0]])
    return np.eye(3) + cross + cross @ cross / (1.0 + z)


def link_transform(theta: float, d: float, a: float, alpha: float, beta: float) -> Float[np.ndarray, "4 4"]:
    """Returns `Rz(theta) Tz(d) Tx(a) Rx(alpha) Ry(beta)` (paper, eq. 1)."""
    T = np.eye(4)
    turn = axis_rotation(2, theta)
    T[:3, :3] = turn @ axis_rotation(0, alpha) @ axis_rotation(1, beta)
    T[:3, 3] = a * turn[:, 0] + [0.0, 0.0, d]
    return T


def _links(root, lines: list[Line], home, parallel_below, near):
    """Returns the numbers of every link, the last leading to the tool's z, and the frame they end in."""
    frame, numbers = root, []
    for place in range(len(lines)):
        last = place == len(lines) - 1
        point, direction = (home[:3, 3], home[:3, 2]) if last else lines[place + 1]
        R = frame[:3, :3]
        seen = np.zeros(3) if point is None else R.T @ (point - frame[:3, 3])
        along = R.T @ direction
        if math.hypot(along[0], along[1]) > max(math.sin(parallel_below), _EXACTLY_PARALLEL):
            link = _by_common_normal(seen, along, near[place])
        elif last:
            link = _to_parallel_tool(seen, along, R.T @ home[:3, 0], near[place])
        else:
            link = _by_piercing(seen, along, near[place])
        numbers.append(link)
        frame = frame @ link_transform(*link)
    return numbers, frame


def _by_common_normal(point, direction, near):
    """Returns the numbers that lead to a line by the common normal of it and z."""
    sine = math.hypot(direction[0], direction[1])
    theta, (x, y) = _within_a_quarter(-direction[1] / sine, direction[0] / sine, near)
    across = -y * direction[0] + x * direction[1]  # of the direction, along z × normal
    alpha = math.atan2(-across, direction[2])
    step = -(-y * point[0] + x * point[1]) / across
    return theta, float(point[2] + step * direction[2]), float(x * point[0] + y * point[1]), alpha, 0.0


def _by_piercing(point, direction, near, d: float = 0.0):
    """Returns the numbers that lead to a line nearly along z, by where it pierces the plane z = d."""
    x, y = point[:2] - (point[2] - d) / direction[2] * direction[:2]
    distance = math.hypot(x, y)
    theta, (c, s) = (0.0, (1.0, 0.0)) if distance < _SAME_LINE else _within_a_quarter(x / distance, y / distance, near)
    a = 0.0 if distance < _SAME_LINE else float(c * x + s * y)
    across = -s * direction[0] + c * direction[1]
    return theta, d, a, math.atan2(-across, direction[2]), math.asin(c * direction[0] + s * direction[1])


def _to_parallel_tool(point, direction, tool_x, near):
    """Returns the numbers that lead to a tool whose z is nearly along the last axis, d reaching its origin."""
    if math.hypot(point[0], point[1]) > _ON_AXIS:
        return _by_piercing(point, direction, near, float(point[2]))
    alpha = 0.0 if direction[2] > 0.0 else math.pi
    return math.atan2(tool_x[1], tool_x[0]), float(point[2]), 0.0, alpha, 0.0


def _within_a_quarter(x: float, y: float, near: float):
    """Returns theta [rad] and the direction (x, y) it leads to, or the other way where that is nearer to an angle."""
    theta = math.atan2(y, x)
    if abs(math.remainder(theta - near, 2 * math.pi)) > _QUARTER:
        return math.atan2(-y, -x), (-x, -y)
    return theta, (x, y)


def _frame_on(axis, point) -> Float[np.ndarray, "4 4"]:
    """Returns a frame with z along an axis, its origin where the axis passes nearest to the base's."""
    T = np.eye(4)
    T[:3, :3] = axis_frame(axis)
    nearest = point - (point @ axis) * axis
    T[:3, 3] = nearest if np.linalg.norm(nearest) > _SAME_LINE else 0.0
    return T


def _line(screw: Screw) -> Line:
    return (np.array(screw.point) if screw.type == "revolute" else None), np.array(screw.axis)


def _joint(screw: Screw, numbers) -> Joint:
    links = dict(zip(LINK_NUMBERS, map(_tidy, numbers), strict=True))
    joint = Joint(screw.name, screw.type, limits=screw.limits, follows=screw.follows, ratio=screw.ratio)
    return joint.with_numbers(links)


def _frame(T: Float[np.ndarray, "4 4"]) -> Frame:
    found = Frame.of(T)
    (x, y, z), (roll, pitch, yaw) = (map(_tidy, part) for part in (found.xyz, found.rpy))
    return Frame((x, y, z), (roll, pitch, yaw))


def _tidy(number: float) -> float:
    return float(number) if abs(number) > _ROUNDING else 0.0


def _thetas_from_the_tool(arm: Arm) -> Arm:
    """Returns a modified arm's angles as the standard arm has them that is seen from its tool."""
    return Arm(arm.name, tuple(replace(joint, theta=-joint.theta) for joint in reversed(arm.joints)))


def _reversed(screws: Screws) -> Screws:
    """Returns the arm seen from its tool: `T_tool_base`, each joint reading with the other sign."""
    seen = screws.seen_from(inverse(screws.home))
    return Screws(screws.name, tuple(reversed(seen.joints)), inverse(screws.home))
