"""Every chain of joints in two packages of robots, as pinocchio has it: read, converted, and calibrated."""

import numpy as np
import pytest

from boresight.arm import LINK_NUMBERS
from boresight.arm.common_normals import modified_dh, standard_dh
from boresight.arm.screws import screws_of
from boresight.arm.serial import chain_of
from boresight.errors import InputError
from boresight.files.elements import read_elements
from boresight.files.sources import Source
from boresight.files.splicing import calibrated_urdf
from boresight.files.tree import tree_of
from boresight.files.urdf import robot_file_of
from published_urdfs import ARMS, all_urdfs, path_of, pinocchio_poses

EXACT = 1e-12
ROWS = 5


def robot_of(path, base=None, tip=None):
    return robot_file_of(Source(path, path.name, path.read_bytes()), base, tip)


def agree(robot, random):
    """Compares every form of a chain with pinocchio."""
    chain, arm = robot.chain, robot.chain.arm
    joints = random.uniform(-2.0, 2.0, (ROWS, len(arm.driven)))
    theirs = pinocchio_poses(robot.content, chain, joints)
    forms = {
        "D-H with beta": arm,
        "product of exponentials": chain.screws,
        "modified D-H": modified_dh(chain.screws),
        "D-H to modified": modified_dh(screws_of(arm)),
        "modified to D-H": standard_dh(screws_of(modified_dh(chain.screws))),
        "D-H to chain": chain_of(arm).screws,
        "chain to D-H": chain_of(arm).arm,
    }
    for name, form in forms.items():
        np.testing.assert_allclose(form.forward_kinematics(joints), theirs, rtol=0, atol=EXACT, err_msg=name)


def agree_calibrated(robot, random):
    """Compares the calibrated file of an arm whose every number is wrong with pinocchio."""
    chain, arm = robot.chain, robot.chain.arm
    joints = random.uniform(-2.0, 2.0, (ROWS, len(arm.driven)))
    numbers = [f"{joint.name}.{number}" for joint in arm.joints for number in LINK_NUMBERS]
    held = () if chain.ends_with_a_fixed_joint else [f"{arm.joints[-1].name}.{n}" for n in ("a", "alpha", "beta")]
    identified = arm.corrected({name: random.uniform(-0.01, 0.01) for name in numbers if name not in held})
    calibrated = pinocchio_poses(calibrated_urdf(robot, arm, identified), chain, joints)
    np.testing.assert_allclose(identified.forward_kinematics(joints), calibrated, rtol=0, atol=EXACT)


@pytest.mark.parametrize("name", ARMS)
def test_an_arm_agrees_in_every_form_before_and_after(name):
    package, path, base, tip = ARMS[name]
    try:
        robot = robot_of(path_of(package, path), base, tip)
    except InputError as error:  # a tip that is not given is chosen from those the error lists
        assert tip is None
        robot = robot_of(path_of(package, path), base, str(error).rsplit("tip: ", 1)[1])
    assert len(robot.chain.moving) >= 2
    agree(robot, np.random.default_rng(1))
    agree_calibrated(robot, np.random.default_rng(2))


@pytest.mark.long
def test_chains_of_every_robot_agree():
    random, chains, refused = np.random.default_rng(2), 0, []
    for path in all_urdfs():
        try:
            tree = tree_of(read_elements(Source(path, path.name, path.read_bytes())), path.name)
        except InputError as error:
            refused.append(str(error))
            continue
        inner = set(tree.parent.values())
        (root,) = (link for link in tree.links if link not in tree.above)
        leaves = [link for link in tree.links if link not in inner]
        for leaf in leaves if len(leaves) < 12 else leaves[::4]:  # of a humanoid's fingers some will do
            try:
                robot = robot_of(path, root, leaf)
            except InputError as error:
                refused.append(str(error))
                continue
            agree(robot, random)
            chains += 1
            if chains % 10 == 0:
                agree_calibrated(robot, random)
    assert chains > 200
    reasons = (
        "moves; expected an arm", "no links", "not valid XML", "base and tip are both", "mimic: there is no joint",
        "parameters are called after joints",
    )  # fmt: skip
    assert [problem for problem in refused if not any(reason in problem for reason in reasons)] == []
