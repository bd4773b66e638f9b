"""The URDFs of two data packages, and what pinocchio makes of a URDF: nothing of it is ours."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

FOLDERS = {
    "rtb-data": Path(pytest.importorskip("rtbdata").__file__).parent,
    "example-robot-data": Path(pin.__file__).parents[4] / "share" / "example-robot-data" / "robots",
}

ARMS = {
    # name: package, path, base, tip
    "ur10": ("example-robot-data", "ur_description/urdf/ur10_robot.urdf", "base_link", "tool0"),
    "ur3": ("example-robot-data", "ur_description/urdf/ur3_robot.urdf", "base_link", "ee_link"),
    "panda": ("example-robot-data", "panda_description/urdf/panda.urdf", "panda_link0", "panda_hand_tcp"),
    "kinova": ("example-robot-data", "kinova_description/robots/kinova.urdf", "j2s6s200_link_base", None),
    "xarm7": ("example-robot-data", "xarm_description/urdf/xarm7.urdf", "link_base", "link_eef"),
    "iiwa14": ("rtb-data", "xacro/kuka_description/kuka_lbr_iiwa/urdf/lbr_iiwa_14_r820.urdf", "base_link", "tool0"),
    "kr16": ("rtb-data", "xacro/kuka_description/kuka_kr16/urdf/kr16_2.urdf", "base_link", "tool0"),
    "irb140": ("rtb-data", "xacro/abb_irb140_description/urdf/irb140.urdf", "base_link", "tool0"),
    "puma560": ("rtb-data", "xacro/unimation_puma560_description/urdf/puma560_robot.urdf", "link1", "link7"),
    "al5d": ("rtb-data", "xacro/lynxmotion_al5d_description/urdf/al5d_robot.urdf", None, "link4"),
    "tiago": ("example-robot-data", "tiago_description/robots/tiago.urdf", "base_footprint", "hand_tool_link"),
    "talos-gripper": (
        "example-robot-data",
        "talos_data/robots/talos_reduced.urdf",
        "base_link",
        "gripper_left_fingertip_1_link",
    ),
}
"""Six and seven axes, near-parallel axes, a lift, and fingers that mimic a joint."""


def path_of(package: str, path: str) -> Path:
    if not FOLDERS[package].is_dir():
        pytest.skip(f"{package} is not installed")
    return FOLDERS[package] / path


def all_urdfs() -> list[Path]:
    """Returns every URDF of both packages."""
    return sorted(path for folder in FOLDERS.values() if folder.is_dir() for path in folder.rglob("*.urdf"))


@lru_cache(maxsize=2)
def _model(urdf: bytes) -> pin.Model:
    return pin.buildModelFromXML(urdf.decode())


def pinocchio_poses(urdf: bytes, chain, joints: np.ndarray) -> np.ndarray:
    """Returns `T_base_tip` of a URDF at readings of the chain's joints, as pinocchio has it.

    What a mimicking joint does is worked out here, since pinocchio's reader leaves it to its caller.
    """
    model = _model(urdf)
    data = model.createData()
    base, tip = model.getFrameId(chain.base), model.getFrameId(chain.tip)
    names = [joint.name for joint in chain.moving if joint.follows is None]
    poses = []
    for row in joints:
        q, reading = pin.neutral(model), dict(zip(names, row, strict=True))
        for joint in chain.moving:
            value = reading[joint.follows] * joint.ratio + joint.offset if joint.follows else reading[joint.name]
            theirs = model.joints[model.getJointId(joint.name)]
            q[theirs.idx_q : theirs.idx_q + theirs.nq] = value if theirs.nq == 1 else [np.cos(value), np.sin(value)]
        pin.framesForwardKinematics(model, data, q)
        poses.append((data.oMf[base].inverse() * data.oMf[tip]).homogeneous)
    return np.array(poses)
