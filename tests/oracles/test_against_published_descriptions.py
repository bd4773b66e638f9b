"""The catalogue against descriptions of the same arms that others wrote, read by pinocchio.

The base is known for each; the one other constant, from our tool frame to theirs, is found at one
configuration and held at a hundred others. Where a description's own numbers are coarser or older than our
source's, the difference is entered here as a correction, and nothing else is fitted.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from boresight.arm import catalogue
from boresight.geometry import Frame, inverse
from random_cells import random_joints

HALF_TURN = np.pi


@dataclass(frozen=True)
class Description:
    """Somebody else's model of an arm in the catalogue.

    Attributes:
        package: the Python package that ships it.
        path: the URDF below that package's data.
        base, tool: the links that our base and, up to a constant, our tool frame lie in.
        tolerance_m: what the rounding of its numbers allows.
        offset: its joint readings less ours [rad].
        T_base_ours: our base in its base link.
        differs: our parameters where its numbers are other than our source's.
    """

    package: str
    path: str
    base: str
    tool: str
    tolerance_m: float
    offset: tuple[float, ...] = ()
    T_base_ours: Frame = Frame()
    differs: dict[str, float] = field(default_factory=dict)


PUBLISHED = {
    # Right angles to eleven decimals: 5e-12 rad over 1.7 m.
    "ur10": Description("example_robot_data", "ur_description/urdf/ur10_robot.urdf", "base", "tool0", 1e-9),
    "panda": Description("example_robot_data", "panda_description/urdf/panda.urdf", "panda_link0", "panda_link8", 1e-9),
    # Its axes 2 and 3 stand 0.43624 mm beside axis 1, and axes 4 to 7 come back; KUKA's drawings have neither.
    "iiwa14": Description(
        "rtbdata",
        "kuka_description/kuka_lbr_iiwa/urdf/lbr_iiwa_14_r820.urdf",
        "base_link",
        "tool0",
        1e-9,
        differs={"joint_a1.a": -0.00043624, "joint_a3.a": 0.00043624},
    ),
    # Right angles as 1.570796325, 1.8e-9 rad short each, seven of them over 1 m; d_3 and d_4 are Armstrong's. It
    # shifts axis 3 by the 20.3 mm that belong between axes 3 and 4: entered as a longer, turned upper arm.
    "puma560": Description(
        "rtbdata",
        "unimation_puma560_description/urdf/puma560_robot.urdf",
        "link1",
        "link7",
        2e-8,
        offset=(0.0, 0.0, HALF_TURN, HALF_TURN, 0.0, 0.0),
        T_base_ours=Frame((0.0, 0.0, 0.6718)),
        differs={
            "j2.a": np.hypot(0.4318, 0.0203) - 0.4318,
            "j2.theta": -np.arctan2(0.0203, 0.4318),
            "j3.theta": np.arctan2(0.0203, 0.4318),
            "j3.a": -0.0203,
            "j3.d": 0.1501 - 0.15005,
            "j4.d": 0.4331 - 0.4318,
        },
    ),
}


def data_folder(package: str) -> Path:
    if package == "rtbdata":
        return Path(pytest.importorskip(package).__file__).parent / "xacro"
    folder = Path(pin.__file__).parents[4] / "share" / "example-robot-data" / "robots"
    if not folder.is_dir():
        pytest.skip("example-robot-data is not installed")
    return folder


def their_poses(description: Description, joints: np.ndarray) -> np.ndarray:
    """Returns `T_base_tool` of the description."""
    model = pin.buildModelFromUrdf(str(data_folder(description.package) / description.path))
    data = model.createData()
    base, tool = model.getFrameId(description.base), model.getFrameId(description.tool)
    poses = []
    for row in joints:
        q = pin.neutral(model)
        q[: len(row)] = row
        pin.framesForwardKinematics(model, data, q)
        poses.append((data.oMf[base].inverse() * data.oMf[tool]).homogeneous)
    return np.array(poses)


@pytest.mark.parametrize("name", PUBLISHED)
def test_catalogue_equals_published_description(name):
    description = PUBLISHED[name]
    arm = catalogue.load(name).corrected(description.differs)
    joints = random_joints(np.random.default_rng(5), arm, 101)
    offset = np.array(description.offset or (0.0,) * len(arm.joints))
    theirs = their_poses(description, joints + offset)
    ours = description.T_base_ours.matrix @ arm.forward_kinematics(joints)
    T_tool_theirs = inverse(ours[0]) @ theirs[0]
    np.testing.assert_allclose(ours @ T_tool_theirs, theirs, rtol=0, atol=description.tolerance_m)
    if name in ("ur10", "panda", "iiwa14"):
        np.testing.assert_allclose(T_tool_theirs, np.eye(4), rtol=0, atol=description.tolerance_m)


CANADARM2_JOINTS = (
    # name, axis in the straight pose, shift from the joint before [m]; x along the boom
    ("roll", "X", (1.3589, 0.0, 0.0)),
    ("yaw", "Z", (0.0, 0.0, 0.7026)),
    ("pitch", "Y", (0.0, -0.5692, 0.0)),
    ("pitch", "Y", (7.11, -0.475, 0.0)),
    ("pitch", "Y", (7.11, 0.0, 0.0)),
    ("yaw", "Z", (0.0, -0.5692, 0.0)),
    ("roll", "X", (0.0, 0.0, -0.7026)),
)
CANADARM2_TIP = (1.3589, 0.0, 0.0)


def test_canadarm2_equals_its_published_axes():
    """No description of Canadarm2 is shipped under a licence to depend on: its axes and offsets, as printed."""
    model = pin.Model()
    for number, (_, axis, shift) in enumerate(CANADARM2_JOINTS):
        place = pin.SE3(np.eye(3), np.array(shift))
        model.addJoint(number, getattr(pin, f"JointModelR{axis}")(), place, f"joint{number + 1}")
    data, arm = model.createData(), catalogue.load("canadarm2")
    joints = random_joints(np.random.default_rng(6), arm, 101)
    theirs = []
    for row in joints:
        pin.forwardKinematics(model, data, row)
        theirs.append((data.oMi[7] * pin.SE3(np.eye(3), np.array(CANADARM2_TIP))).homogeneous)
    # our base and tool have z along their x and x along their -y (base) or y (tool)
    T_theirs_base = np.array([[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=float)
    T_tool_theirs = np.array([[0, 1, 0, 0], [0, 0, 1, 0], [1, 0, 0, 0], [0, 0, 0, 1]], dtype=float)
    ours = T_theirs_base @ arm.forward_kinematics(joints) @ T_tool_theirs
    np.testing.assert_allclose(ours, np.array(theirs), rtol=0, atol=1e-12)
