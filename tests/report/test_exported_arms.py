"""Every export format read back moves the tool as the calibrated arm does, or the export is an error in a sentence."""

import ast
import csv
import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from boresight.arm import LINK_NUMBERS, Arm, Joint, catalogue, chain_of
from boresight.arm.common_normals import link_transform
from boresight.arm.conventions import Convention
from boresight.arm.screws import Screw, Screws
from boresight.arm.serial import corrected_chain
from boresight.calibration.campaign import RobotFile
from boresight.errors import InputError
from boresight.files import load_robot
from boresight.files.splicing import calibrated_urdf
from boresight.files.urdf import read_urdf
from boresight.files.urdf_writing import dump_urdf
from boresight.geometry import Frame
from boresight.report.converting import in_convention
from boresight.report.export import FORMATS, export
from boresight.report.stored import StoredResult
from factory_arms import FACTORY, factory_arm
from random_cells import CONVENTIONS, random_arm, random_frame

ROWS = 30
SIX_JOINTS = ("ur-kinematics", "ur-calibration-conf")
EXACT, WRITTEN = 1e-9, 2e-8
"""Largest error [m or rad] of formats whose numbers are whole, and where a comment's nine digits count."""


def corrections(arm, seed, size=0.004):
    rng = np.random.default_rng(seed)
    return {f"{joint.name}.{n}": float(rng.uniform(-size, size)) for joint in arm.joints for n in LINK_NUMBERS}


def result_of(nominal, identified, urdf=None, origins=()):
    return StoredResult(Path("result"), "arm", True, (), nominal, identified, urdf, origins)


def of_table(nominal, seed):
    return result_of(nominal, nominal.corrected(corrections(nominal, seed)))


def of_urdf(robot: RobotFile, seed):
    chain = robot.chain
    nominal = chain.arm
    identified = nominal.corrected(corrections(nominal, seed))
    new = corrected_chain(chain, nominal, identified)
    origins = tuple(
        {
            "joint": was.name,
            "type": was.type,
            "nominal": {"xyz": list(was.origin.xyz), "rpy": list(was.origin.rpy)},
            "identified": {"xyz": list(now.origin.xyz), "rpy": list(now.origin.rpy)},
        }
        for was, now in zip(chain.joints, new.joints, strict=True)
    )
    return result_of(nominal, identified, calibrated_urdf(robot, nominal, identified), origins)


def six_axes(rng, convention):
    """Six revolute axes, the first two at an angle, the others anyhow: nearly parallel ones too."""
    joints = tuple(
        Joint(
            f"axis_{k}",
            theta=float(rng.uniform(-1, 1)),
            d=float(rng.uniform(-0.3, 0.3)),
            a=float(rng.uniform(-0.5, 0.5)),
            alpha=float(rng.choice([0.0, 1e-3, math.pi - 2e-3, math.pi / 2, -math.pi / 2])) if k else 1.5,
        )
        for k in range(6)
    )
    if convention == "modified-dh":
        joints = (replace(joints[0], alpha=0.01), replace(joints[1], alpha=-1.5), *joints[2:])
    return Arm("six", joints, convention, random_frame(rng) if rng.random() < 0.5 else Frame())


def readings(arm):
    lowest, highest = np.where(np.isinf(arm.limits), [-math.pi, math.pi], arm.limits).T
    return np.random.default_rng(9).uniform(lowest, highest, (ROWS, len(lowest)))


def frame_in(text):
    xyz, rpy = (tuple(map(float, re.split(r"[ ,]+", part.strip("[] ")))) for part in re.search(
        r"xyz ([^(]+)\(m\), rpy ([^(]+)\(rad\)", text).groups())  # fmt: skip
    return Frame(xyz, rpy)


def poses_of(to, exported, chain, tmp_path, joints):
    """Returns the tool's poses as a reader of the format finds them, independent of how it was written."""
    content = exported.content if isinstance(exported.content, str) else exported.content.decode()
    if to in ("urdf", "dh"):
        path = tmp_path / ("a.urdf" if to == "urdf" else "a.yaml")
        path.write_text(content)
        return load_robot(path).forward_kinematics(joints)
    if to == "json":
        return poses_of_json(json.loads(content)["identified"], joints)
    if to == "pal":
        return poses_with_deltas(content, chain, joints)
    if to == "ur-calibration-conf":
        return poses_of_conf(content, joints)
    return poses_of_blocks(content, joints) if chain is None else poses_of_own_blocks(content, chain, joints)


def poses_of_json(forms, joints):
    axes = forms["product_of_exponentials"]["joints"]
    screws = tuple(
        Screw(
            axis["name"],
            "revolute" if any(axis["w"]) else "prismatic",
            tuple(axis["w"] if any(axis["w"]) else axis["v"]),
            tuple(np.cross(axis["w"], axis["v"]).tolist()),
            (-1.0, 1.0),
            axis.get("follows"),
            axis.get("ratio", 1.0),
        )
        for axis in axes
    )
    poses = Screws("json", screws, np.array(forms["product_of_exponentials"]["home"])).forward_kinematics(joints)
    for convention in CONVENTIONS:
        form = forms[convention]
        links = tuple(Joint(**joint) for joint in form["joints"])
        root, tip = (Frame(tuple(form[k]["xyz"]), tuple(form[k]["rpy"])) for k in ("root", "tip"))
        ours = Arm("json", links, convention, root, tip).forward_kinematics(joints)
        np.testing.assert_allclose(ours, poses, rtol=0, atol=EXACT)
    return poses


def poses_with_deltas(content, chain, joints):
    """Adds every delta to the URDF's origins number by number and moves the chain."""
    deltas = {key: float(value) for key, value in re.findall(r"^    (.+): (\S+)$", content, re.M)}
    moved = []
    for joint in chain.joints:
        names = [f"{joint.name}_{part}" for part in ("dx", "dy", "dz", "droll", "dpitch", "dyaw")]
        numbers = [a + deltas.get(n, 0.0) for a, n in zip((*joint.origin.xyz, *joint.origin.rpy), names, strict=True)]
        moved.append(joint.placed(Frame(tuple(numbers[:3]), tuple(numbers[3:]))))
    return replace(chain, joints=tuple(moved)).screws.forward_kinematics(joints)


def turned_base(content):
    """The arm's own base in the format's, which a comment tells."""
    found = re.search(r"turned by (\S+) rad about z", content)
    return link_transform(float(found[1]), 0.0, 0.0, 0.0, 0.0) if found else np.eye(4)


def poses_of_blocks(content, joints):
    names = re.findall(r"^  (\w+):$", content, re.M)
    numbers = [float(v) for v in re.findall(r"^    (?:x|y|z|roll|pitch|yaw): (\S+)$", content, re.M)]
    behind = re.search(r"^# .*(?:Behind it|fixed joint).*$", content, re.M)
    tool = frame_in(behind[0]).matrix if behind else np.eye(4)
    poses = np.tile(turned_base(content), (len(joints), 1, 1))
    for k, _ in enumerate(names):
        x, y, z, roll, pitch, yaw = numbers[6 * k : 6 * k + 6]
        turns = np.array([link_transform(float(q), 0.0, 0.0, 0.0, 0.0) for q in joints[:, k]])
        poses = poses @ Frame((x, y, z), (roll, pitch, yaw)).matrix @ turns
    return poses @ tool


def poses_of_own_blocks(content, chain, joints):
    """Puts the block's origins, and the one that a comment tells, into the URDF's own chain."""
    blocks = re.findall(r"^  (\w+):\n((?:    .*\n){6})", content, re.M)
    numbers = {name: [float(line.split(": ")[1]) for line in block.splitlines()] for name, block in blocks}
    numbers |= {
        name: [*(frame := frame_in(text)).xyz, *frame.rpy]
        for name, text in re.findall(r"^# The fixed joint (\S+) (.*)$", content, re.M)
    }
    moved = [
        joint.placed(Frame(tuple(numbers[joint.name][:3]), tuple(numbers[joint.name][3:])))
        if joint.name in numbers
        else joint
        for joint in chain.joints
    ]
    return replace(chain, joints=tuple(moved)).screws.forward_kinematics(joints)


def poses_of_conf(content, joints):
    table = [list(map(float, row)) for row in re.findall(r"^#   \w+: (\S+), (\S+), (\S+), (\S+)$", content, re.M)]
    deltas = {key: ast.literal_eval(value) for key, value in re.findall(r"^delta_(\w+) = (\[.*\])$", content, re.M)}
    links = tuple(
        Joint(f"j{k}", theta=theta + deltas["theta"][k], d=d + deltas["d"][k], a=a + deltas["a"][k],
              alpha=alpha + deltas["alpha"][k])
        for k, (theta, d, a, alpha) in enumerate(table)
    )  # fmt: skip
    return turned_base(content) @ Arm("conf", links).forward_kinematics(joints)


def assert_every_format_moves_alike(stored, tmp_path, chain=None):
    """Returns the formats that could be written."""
    joints = readings(stored.identified)
    expected = stored.identified.forward_kinematics(joints)
    written = []
    for to in FORMATS:
        try:
            exported = export(stored, to)
        except InputError:
            continue
        poses = poses_of(to, exported, chain, tmp_path, joints)
        tolerance = WRITTEN if to in SIX_JOINTS else EXACT
        np.testing.assert_allclose(poses, expected, rtol=0, atol=tolerance, err_msg=to)
        written.append(to)
    for convention in CONVENTIONS:
        poses = poses_of("dh", export(stored, "dh", convention), chain, tmp_path, joints)
        np.testing.assert_allclose(poses, expected, rtol=0, atol=EXACT, err_msg=convention)
        table = export(stored, "dh", convention, table=True)
        np.testing.assert_allclose(poses_of_table(table, joints), expected, rtol=0, atol=EXACT, err_msg="csv")
    return written


def poses_of_table(table, joints):
    """Moves the table's rows with what the comments below them say."""
    notes = [line for line in table.content.splitlines() if line.startswith("#")]
    assert notes == [f"# {note}" for note in table.notes]
    said = "\n".join(notes)
    follows = dict(re.findall(r"Joint (\S+) follows (\S+):", said))
    ratios = dict(re.findall(r"Joint (\S+) follows .* is (\S+) times", said))
    links = tuple(
        Joint(row["joint"], row["type"], *(float(row[k]) for k in ("theta_rad", "d_m", "a_m", "alpha_rad", "beta_rad")),
              follows=follows.get(row["joint"]), ratio=float(ratios.get(row["joint"], 1.0)))
        for row in csv.DictReader(line for line in table.content.splitlines() if not line.startswith("#"))
    )  # fmt: skip
    root, tip = (re.search(f"^.*{place}, .*xyz.*$", said, re.M) for place in ("root", "tip"))
    convention: Convention = "modified-dh" if "modified-dh" in said else "standard-dh"
    ends = (frame_in(place[0]) if place else Frame() for place in (root, tip))
    return Arm("csv", links, convention, *ends).forward_kinematics(joints)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("convention", CONVENTIONS)
def test_random_tables(seed, convention, tmp_path):
    rng = np.random.default_rng(seed)
    drawn = random_arm(rng, convention=convention)
    arm = replace(drawn, root=random_frame(rng), tip=random_frame(rng)) if seed % 2 else drawn
    written = assert_every_format_moves_alike(of_table(arm, seed), tmp_path)
    assert {"urdf", "dh", "json"} <= set(written)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("convention", CONVENTIONS)
def test_six_axes_with_every_number_wrong(seed, convention, tmp_path):
    arm = six_axes(np.random.default_rng(seed), convention)
    written = assert_every_format_moves_alike(of_table(arm, seed), tmp_path)
    assert {"urdf", "dh", "json"} <= set(written)
    assert "ur-kinematics" in written or arm.root != Frame()  # tilted so that UR's frames have no place


@pytest.mark.parametrize("name", catalogue.names())
def test_the_catalogue(name, tmp_path):
    assert_every_format_moves_alike(of_table(catalogue.load(name), 1), tmp_path)


@pytest.mark.parametrize("name", FACTORY)
def test_factory_tables(name, tmp_path):
    arm = factory_arm(name)
    assert_every_format_moves_alike(result_of(arm, arm.corrected({"j2.theta": 0.001})), tmp_path)


@pytest.mark.parametrize("seed", range(8))
def test_urdfs(seed, tmp_path):
    rng = np.random.default_rng(seed)
    drawn = random_arm(rng, joints=6 if seed % 2 else None)
    chain = chain_of(in_convention(drawn, "standard-dh"))
    (tmp_path / "in.urdf").write_text(dump_urdf(chain))
    robot = read_urdf(tmp_path / "in.urdf")
    written = assert_every_format_moves_alike(of_urdf(robot, seed), tmp_path, robot.chain)
    assert {"urdf", "dh", "json", "pal"} <= set(written)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_joints_that_follow_others(convention, tmp_path):
    joints = (
        Joint("lift", "prismatic", alpha=0.3, limits=(0.0, 0.5)),
        Joint("j2", theta=0.2, a=0.3, alpha=1.2),
        Joint("j3", d=0.1, a=0.2, alpha=-1.0, follows="j2", ratio=-2.0),
        Joint("j4", "prismatic", a=0.1, alpha=0.5, follows="j2", ratio=0.05),
    )
    assert_every_format_moves_alike(of_table(Arm("geared", joints, convention), 3), tmp_path)


def test_what_stands_before_the_first_axis_of_a_modified_table_is_in_the_shoulder(tmp_path):
    rows = [
        (0.16, 0.0, 0.0),
        (0.2, 0.0, -1.57),
        (0.0, 0.65, 3.144),
        (0.0, 0.6, 3.143),
        (0.1, 0.0, -1.57),
        (0.09, 0.0, 1.57),
    ]
    joints = tuple(Joint(f"joint_{k}", d=d, a=a, alpha=alpha) for k, (d, a, alpha) in enumerate(rows, 1))
    arm = Arm("other brand", joints, "modified-dh")
    exported = export(result_of(arm, arm.corrected({"joint_1.a": 0.002, "joint_1.alpha": 0.003})), "ur-kinematics")
    roll = float(re.search(r"shoulder:\n(?:    [xyz]: .*\n){3}    roll: (\S+)", exported.content)[1])
    assert abs(roll) == pytest.approx(0.003, abs=1e-6)


def test_the_rows_of_a_table_without_root_and_tip_have_no_comments_below():
    arm = catalogue.load("ur10")
    assert "#" not in export(result_of(arm, arm), "dh", table=True).content


@pytest.mark.parametrize("name", FACTORY)
def test_a_urdf_made_of_a_factory_table_has_short_origins(name, tmp_path):
    arm = factory_arm(name)
    (tmp_path / "a.urdf").write_text(export(result_of(arm, arm), "urdf").content)
    chain = read_urdf(tmp_path / "a.urdf").chain
    assert max(abs(value) for joint in chain.joints for value in joint.origin.xyz) < 0.62
