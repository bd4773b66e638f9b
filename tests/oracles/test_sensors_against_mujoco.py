"""Campaigns of every sensor, measured in MuJoCo, read from files and calibrated: the arm that MuJoCo had comes out."""

from __future__ import annotations

import csv

import mujoco
import numpy as np
import pytest
from test_against_mujoco import Mujoco

import boresight
from boresight.arm import catalogue
from boresight.calibration import Solver
from boresight.geometry import Frame, vector_rotation
from boresight.sensing import Cell, Position
from boresight.synthetic import perturbed

ARM = catalogue.load("space-arm")
BALL, BEAM = Frame((0.05, -0.03, 0.08)), Frame((0.0, 0.02, 0.04), (0.2, -0.1, 0.4))
POINTS = {"a": (1.5, 0.1, 0.0), "b": (0.1, 1.5, 0.2), "c": (0.5, -1.0, 1.2)}
PLANES = {"deck": ((0.0, 1.0, 4.6), -0.69), "wall": ((1.0, 0.0, 0.1), -0.5), "side": ((0.0, 1.0, 0.1), -0.5)}
LIMITS = np.radians(100.0)


class World:
    """An arm off its nominal geometry, in MuJoCo, seen on several mounts."""

    def __init__(self, seed: int, base: Frame, mounts: dict[str, Frame]):
        self.random = np.random.default_rng(seed)
        widths = {f"{j}.{n}": 0.005 for j in ARM.joint_names for n in ("theta", "alpha")}
        widths |= {f"{j}.{n}": 0.003 for j in ARM.joint_names for n in ("d", "a")}
        arm = perturbed(Cell(ARM, Position(1.0)), widths, seed).arm
        self.mounts = {name: Mujoco(Cell(arm, Position(1.0), base, mount)) for name, mount in mounts.items()}

    def configuration(self) -> np.ndarray:
        return self.random.uniform(-LIMITS, LIMITS, len(ARM.joints))

    def pose(self, joints, mount):
        self.mounts[mount].move(joints)
        return self.mounts[mount].pose

    def touching(self, plane, mount):
        """A configuration in which the tip is on a plane, by bisection along a way between two sides of it."""
        normal, offset = np.array(PLANES[plane][0]), PLANES[plane][1]
        height = lambda joints: normal @ self.pose(joints, mount)[:3, 3] + offset  # noqa: E731
        while True:
            below, above = self.configuration(), self.configuration()
            if height(below) < 0.0 < height(above):
                break
        for _ in range(60):
            middle = 0.5 * (below + above)
            below, above = (middle, above) if height(middle) < 0.0 else (below, middle)
        return below


def wire(world, joints, mount, noise):
    name = str(world.random.choice(list(POINTS)))
    length = np.linalg.norm(world.pose(joints, mount)[:3, 3] - POINTS[name])
    return {"distance": length + world.random.normal(0.0, noise), "target": name}


def position(world, joints, mount, noise):
    return dict(zip("xyz", world.pose(joints, mount)[:3, 3] + world.random.normal(0.0, noise, 3), strict=True))


def pose(world, joints, mount, noise, angle_noise=1e-4):
    row = position(world, joints, mount, noise)
    quaternion = np.empty(4)
    turned = world.pose(joints, mount)[:3, :3] @ vector_rotation(world.random.normal(0.0, angle_noise, 3))
    mujoco.mju_mat2Quat(quaternion, turned.ravel())
    sign = world.random.choice([-1.0, 1.0])  # q and -q are one orientation
    return row | dict(zip(("qw", "qx", "qy", "qz"), sign * quaternion, strict=True))


def write(folder, campaign, rows):
    (folder / "campaign.yaml").write_text(campaign)
    header = list(dict.fromkeys(key for row in rows for key in row))
    with open(folder / "observations.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, header, restval="")
        writer.writeheader()
        writer.writerows(rows)
    return boresight.load_campaign(folder / "campaign.yaml")


def with_joints(joints, row):
    return dict(zip(ARM.joint_names, joints, strict=True)) | row


def position_error(world, cell, mount):
    """The largest error [m] of the calibrated arm's position over configurations that were not measured."""
    joints = np.array([world.configuration() for _ in range(30)])
    truth = np.array([world.pose(each, mount)[:3, 3] for each in joints])
    place = next(place for place, aim in enumerate(cell.aims) if aim.mount == mount or len(cell.mounts) == 1)
    found = cell.poses(joints, None, np.full(len(joints), place))[:, :3, 3]
    return float(np.max(np.linalg.norm(found - truth, axis=1)))


HEAD = "robot: {catalogue: space-arm}\nobservations: observations.csv\n"
TARGETS = "".join(
    [f"  {n}: {{type: point, position: {list(p)}}}\n" for n, p in POINTS.items()]
    + [f"  {n}: {{type: plane, normal: {list(p)}, offset: {f}}}\n" for n, (p, f) in PLANES.items()]
)


def test_draw_wires_find_the_arm(tmp_path):
    world = World(1, Frame(), {"mount": Frame()})
    joints = [world.configuration() for _ in range(120)]
    rows = [with_joints(q, wire(world, q, "mount", 5e-5)) for q in joints]
    text = f"{HEAD}sensor: {{type: draw_wire, noise_std: 5.0e-5}}\ntargets:\n{TARGETS}"
    result = boresight.calibrate(write(tmp_path, text, rows), Solver("least-squares"))
    assert result.verdict.accepted
    assert position_error(world, result.cell, "mount") < 5e-4
    assert 0.7 < result.noise.ratio < 1.3


def test_poses_find_the_arm_and_unknown_frames(tmp_path):
    world = World(2, Frame((0.3, -0.2, 0.1), (0.4, 0.9, -2.0)), {"mount": BEAM})
    joints = [world.configuration() for _ in range(60)]
    rows = [with_joints(q, pose(world, q, "mount", 5e-5)) for q in joints]
    sensor = "sensor: {type: pose, noise_std: 5.0e-5, noise_angle_std: 1.0e-4}\n"
    text = f"{HEAD}{sensor}base: {{xyz: unknown, rpy: unknown}}\nmount: {{xyz: unknown, rpy: unknown}}\n"
    result = boresight.calibrate(write(tmp_path, text, rows), Solver("least-squares"))
    assert result.verdict.accepted
    assert position_error(world, result.cell, "mount") < 1.5e-4
    by = {each.what: each for each in result.by_sensor}
    assert by["orientation"].unit == "rad"
    assert by["orientation"].after.rms == pytest.approx(1e-4 * np.sqrt(3), rel=0.25)
    assert by["position"].after.rms == pytest.approx(5e-5 * np.sqrt(3), rel=0.25)


def test_contacts_find_the_arm(tmp_path):
    world = World(3, Frame(), {"mount": BALL})
    planes = [str(world.random.choice(list(PLANES))) for _ in range(120)]
    rows = [with_joints(world.touching(plane, "mount"), {"target": plane}) for plane in planes]
    sensor = "sensor: {type: plane_contact, noise_std: 2.0e-5}\nmount: {xyz: [0.05, -0.03, 0.08]}\n"
    result = boresight.calibrate(write(tmp_path, f"{HEAD}{sensor}targets:\n{TARGETS}", rows), Solver("least-squares"))
    assert result.verdict.accepted
    assert position_error(world, result.cell, "mount") < 2e-4


def test_markers_on_unknown_places_of_the_tool_find_the_arm(tmp_path):
    mounts = {"m1": BALL, "m2": Frame((-0.04, 0.06, 0.1)), "m3": Frame((0.02, 0.09, -0.05))}
    world = World(4, Frame((0.3, -0.2, 0.1), (0.4, 0.9, -2.0)), mounts)
    rows = []
    for number in range(90):
        q, marker = world.configuration(), list(mounts)[number % 3]
        rows.append(with_joints(q, position(world, q, marker, 5e-5) | {"marker": marker}))
    sensor = "sensor: {type: position, noise_std: 5.0e-5}\nbase: {xyz: unknown, rpy: unknown}\n"
    markers = "markers: {m1: {xyz: unknown}, m2: {xyz: unknown}, m3: {xyz: unknown}}\n"
    result = boresight.calibrate(write(tmp_path, HEAD + sensor + markers, rows), Solver("least-squares"))
    assert result.verdict.accepted
    for marker in mounts:
        assert position_error(world, result.cell, marker) < 2.5e-4


def test_mixed_sensors_find_the_arm_and_an_unknown_point(tmp_path):
    mounts = {"beam": BEAM, "ball": BALL}
    world = World(5, Frame(), mounts)
    rows = []
    for number in range(120):
        kind = ("tracker", "wire", "probe")[number % 3]
        if kind == "probe":
            plane = str(world.random.choice(list(PLANES)))
            rows.append(with_joints(world.touching(plane, "ball"), {"sensor": kind, "target": plane}))
            continue
        q = world.configuration()
        marker = "beam" if kind == "wire" else "ball"
        read = wire(world, q, marker, 2e-4) if kind == "wire" else position(world, q, marker, 5e-5)
        rows.append(with_joints(q, read | {"sensor": kind}))
    sensors = """sensors:
  tracker: {type: position, noise_std: 5.0e-5, markers: [ball]}
  wire: {type: draw_wire, noise_std: 2.0e-4, markers: [beam]}
  probe: {type: plane_contact, noise_std: 2.0e-5, markers: [ball]}
markers:
  beam: {xyz: [0, 0.02, 0.04], rpy: [0.2, -0.1, 0.4]}
  ball: {xyz: unknown}
"""
    targets = TARGETS.replace(str(list(POINTS["c"])), "unknown")
    result = boresight.calibrate(write(tmp_path, f"{HEAD}{sensors}targets:\n{targets}", rows), Solver("least-squares"))
    assert result.verdict.accepted
    assert position_error(world, result.cell, "ball") < 2e-4
    np.testing.assert_allclose(result.cell.targets["c"].xyz, POINTS["c"], atol=5e-4)
    assert [each.sensor for each in result.by_sensor] == ["tracker", "wire", "probe"]


def test_distances_find_the_arm_wherever_the_tracker_stands(tmp_path):
    world = World(6, Frame(), {"mount": BALL})
    R, t = vector_rotation(np.array([0.3, -1.0, 2.0])), np.array([5.0, -3.0, 1.0])  # the tracker's own frame
    rows = []
    for _ in range(240):
        q = world.configuration()
        p = R @ world.pose(q, "mount")[:3, 3] + t + world.random.normal(0.0, 5e-5, 3)
        rows.append(with_joints(q, dict(zip("xyz", p, strict=True))))
    text = f"{HEAD}sensor: {{type: distances, noise_std: 5.0e-5}}\nmount: {{xyz: [0.05, -0.03, 0.08]}}\n"
    campaign = write(tmp_path, text, rows)
    assert len(campaign.readings) == 120
    result = boresight.calibrate(campaign, Solver("least-squares"))
    assert result.verdict.accepted
    assert 0.75 < result.noise.ratio < 1.25
    joints = np.array([world.configuration() for _ in range(40)])
    truth = np.array([world.pose(each, "mount")[:3, 3] for each in joints])
    found = result.cell.poses(joints)[:, :3, 3]
    gaps = np.linalg.norm(found[::2] - found[1::2], axis=1) - np.linalg.norm(truth[::2] - truth[1::2], axis=1)
    assert np.max(np.abs(gaps)) < 3e-4
