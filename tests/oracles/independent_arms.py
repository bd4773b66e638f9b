"""A cell written as MJCF and as a pinocchio model, straight from equation (1), without the package's chain.

Both are built from one list of elementary steps. A step's orientation is a quaternion of its own, and
multiplying up is left to MuJoCo or pinocchio.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from boresight.geometry import Frame
from boresight.sensing import Cell

INERTIAL = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'


@dataclass(frozen=True)
class Step:
    """A turn about (`rx`, `ry`, `rz`) or shift along (`tx`, `ty`, `tz`) an axis, or a joint about or along z."""

    kind: str
    value: float = 0.0
    parameter: str | None = None


def frame_steps(name: str, frame: Frame) -> list[Step]:
    x, y, z = frame.xyz
    roll, pitch, yaw = frame.rpy
    return [
        *(Step(f"t{axis}", value, f"{name}.{axis}") for axis, value in zip("xyz", (x, y, z), strict=True)),
        Step("rz", yaw),
        Step("ry", pitch),
        Step("rx", roll),
        Step("rz", 0.0, f"{name}.yaw"),
        Step("ry", 0.0, f"{name}.pitch"),
        Step("rx", 0.0, f"{name}.roll"),
    ]


def joint_steps(joint, convention: str) -> list[Step]:
    """`Rz(q + theta) Tz(q + d) Tx(a) Rx(alpha) Ry(beta)`, or `Ry(beta) Rx(alpha) Tx(a) Tz(q + d) Rz(q + theta)`."""
    theta = Step("rz", joint.theta, f"{joint.name}.theta")
    d = Step("tz", joint.d, f"{joint.name}.d")
    a = Step("tx", joint.a, f"{joint.name}.a")
    alpha = Step("rx", joint.alpha, f"{joint.name}.alpha")
    beta = Step("ry", joint.beta, f"{joint.name}.beta")
    moving = [Step("hinge"), theta, d] if joint.type == "revolute" else [theta, Step("slide"), d]
    if convention == "standard-dh":
        return [*moving, a, alpha, beta]
    moving = [d, Step("hinge"), theta] if joint.type == "revolute" else [d, Step("slide"), theta]
    return [beta, alpha, a, *moving]


def cell_steps(cell: Cell) -> list[Step]:
    links = [step for joint in cell.arm.joints for step in joint_steps(joint, cell.arm.convention)]
    return [*frame_steps("base", cell.base), *links, *frame_steps("mount", cell.mount)]


def quaternion(axis: str, angle_rad: float) -> list[float]:
    """Returns (w, x, y, z)."""
    values = [math.cos(angle_rad / 2), 0.0, 0.0, 0.0]
    values[1 + "xyz".index(axis)] = math.sin(angle_rad / 2)
    return values


def text(values) -> str:
    return " ".join(repr(float(value)) for value in values)


def mjcf(cell: Cell) -> str:
    """Returns the cell with a body a step, a site `sensor` with a rangefinder, and plane k's two faces in group k."""
    head, tail = [], []
    for step in cell_steps(cell):
        if step.kind == "hinge" or step.kind == "slide":
            head.append(f'<body>{INERTIAL}<joint type="{step.kind}" axis="0 0 1"/>')
        elif step.kind[0] == "t":
            position = [step.value if axis == step.kind[1] else 0.0 for axis in "xyz"]
            head.append(f'<body pos="{text(position)}">')
        else:
            head.append(f'<body quat="{text(quaternion(step.kind[1], step.value))}">')
        tail.append("</body>")
    faces = [
        f'<geom type="plane" size="0 0 1" group="{group}" pos="{text(-plane.offset * np.array(plane.normal))}" '
        f'zaxis="{text(side * np.array(plane.normal))}"/>'
        for group, plane in enumerate(cell.targets.values())
        for side in (1.0, -1.0)
    ]
    return (
        '<mujoco><compiler angle="radian" autolimits="false"/><option gravity="0 0 0"/><worldbody>'
        + "".join(faces)
        + "".join(head)
        + '<site name="sensor"/>'
        + "".join(tail)
        + '</worldbody><sensor><rangefinder site="sensor"/></sensor></mujoco>'
    )


def placement(step: Step) -> pin.SE3:
    if step.kind[0] == "t":
        return pin.SE3(np.eye(3), np.array([step.value if axis == step.kind[1] else 0.0 for axis in "xyz"]))
    w, x, y, z = quaternion(step.kind[1], step.value)
    return pin.SE3(pin.Quaternion(w, x, y, z), np.zeros(3))


def unit_twist(step: Step) -> np.ndarray:
    """Returns (v, w) of a unit of the step, in its own frame."""
    twist = np.zeros(6)
    twist["xyz".index(step.kind[1]) + (0 if step.kind[0] == "t" else 3)] = 1.0
    return twist


def pinocchio_model(cell: Cell) -> tuple[pin.Model, dict[str, tuple[int, np.ndarray]]]:
    """Returns the model, closed by a joint that stays at 0 in the sensor's frame, and for each parameter of the
    chain the joint whose placement it displaces and by which twist, in the frame of that placement."""
    model, parent, segment, displaced = pin.Model(), 0, [], {}
    for step in [*cell_steps(cell), Step("hinge")]:
        if step.kind not in ("hinge", "slide"):
            segment.append(step)
            continue
        whole = pin.SE3.Identity()
        for passed in segment:
            whole = whole * placement(passed)
        joint = pin.JointModelRZ() if step.kind == "hinge" else pin.JointModelPZ()
        parent = model.addJoint(parent, joint, whole, f"joint{parent + 1}")
        after = pin.SE3.Identity()
        for passed in reversed(segment):
            after = placement(passed) * after
            if passed.parameter is not None:
                displaced[passed.parameter] = (parent, after.toActionMatrixInverse() @ unit_twist(passed))
        segment = []
    return model, displaced
