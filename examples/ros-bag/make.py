"""Makes this example: a run of a perturbed arm in MuJoCo, recorded as a rosbag2 folder. Nothing of Boresight is in it.

    pip install mujoco rosbags
    python make.py

The links are written straight from their D-H numbers as MJCF bodies; multiplying up and ray casting is MuJoCo's.
"""

import json
import math
import shutil
from pathlib import Path

import mujoco
import numpy as np
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

HERE = Path(__file__).parent
RNG = np.random.default_rng(2012)
JOINTS = 6
THETA, D = np.zeros(JOINTS), np.array([0.35, 0.0, 0.15, 0.4, 0.0, 0.12])
A, ALPHA = np.array([0.0, 0.45, 0.0, 0.0, 0.0, 0.06]), np.radians([-90.0, 0.0, 90.0, -90.0, 90.0, 30.0])
PLANES = {
    "deck": ([0.0, 0.212429644331, 0.977176363923], -0.146576454588),
    "wall_x": ([-0.970142500145, 0.145521375022, 0.194028500029], 1.55222800023),
    "wall_y": ([0.098413566261, -0.98413566261, 0.147620349392], 1.67303062644),
}
STOPS_PER_PLANE, VALIDATION = 32, 40
REST_S, MOVE_S, JOINT_HZ, RANGE_HZ = 1.6, 1.0, 18.0, 10.0
NOISE_M, LOST, NEAREST_M, FARTHEST_M = 0.0002, 0.03, 0.1, 3.0
ENCODER_RAD, TREMBLE_RAD = 2.0**-17, 1e-5
RANGER_LATE_S, JOINTS_LATE_S = 0.021, 0.004
BEGAN_S = 1_700_000_000.0


def truth():
    """Returns theta, d, a, alpha, beta of the true arm: errors up to 0.025 rad and 10 mm."""
    turn, shift = (lambda: RNG.uniform(-0.025, 0.025, JOINTS)), (lambda: RNG.uniform(-0.010, 0.010, JOINTS))
    theta, d, a, alpha = THETA + turn(), D + shift(), A + shift(), ALPHA + turn()
    theta[0], d[1] = THETA[0], D[1]  # the definition of azimuth, and d of parallel axes: beta is in its place
    beta = np.zeros(JOINTS)
    beta[1] = RNG.uniform(-0.025, 0.025)
    return theta, d, a, alpha, beta


def turned(axis, angle):
    """Returns the attribute of a body turned about an axis."""
    quaternion = [math.cos(angle / 2), 0.0, 0.0, 0.0]
    quaternion[1 + "xyz".index(axis)] = math.sin(angle / 2)
    return f'quat="{" ".join(map(repr, quaternion))}"'


def mjcf(theta, d, a, alpha, beta):
    """Returns the cell: link i is Rz(q + theta) Tz(d) Tx(a) Rx(alpha) Ry(beta); plane k is in group k, two-sided."""
    inertial = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
    arm = '<site name="ranger"/>'
    for i in reversed(range(JOINTS)):
        arm = f"<body {turned('x', float(alpha[i]))}><body {turned('y', float(beta[i]))}>{arm}</body></body>"
        arm = f'<body pos="{float(a[i])!r} 0 {float(d[i])!r}">{arm}</body>'
        arm = f"<body {turned('z', float(theta[i]))}>{arm}</body>"
        arm = f'<body>{inertial}<joint type="hinge" axis="0 0 1"/>{arm}</body>'
    faces = ""
    for k, (normal, offset) in enumerate(PLANES.values()):
        place = " ".join(repr(-offset * part) for part in normal)
        for side in (1.0, -1.0):
            up = " ".join(repr(side * part) for part in normal)
            faces += f'<geom type="plane" size="0 0 1" group="{k}" pos="{place}" zaxis="{up}"/>'
    options = '<compiler angle="radian" autolimits="false"/><option gravity="0 0 0"/>'
    return f"<mujoco>{options}<worldbody>{faces}{arm}</worldbody></mujoco>"


class Cell:
    """The true cell."""

    def __init__(self, numbers):
        self.model = mujoco.MjModel.from_xml_string(mjcf(*numbers))
        self.data = mujoco.MjData(self.model)

    def pose(self, joints):
        """Returns position and rotation of the ranger; its beam is its z axis."""
        self.data.qpos[:] = joints
        mujoco.mj_kinematics(self.model, self.data)
        site = self.data.site("ranger")
        return site.xpos.copy(), site.xmat.reshape(3, 3).copy()

    def distance(self, joints, plane):
        """Returns the range to a plane; infinite where the beam misses it."""
        position, rotation = self.pose(joints)
        groups = np.zeros(6, dtype=np.uint8)
        groups[list(PLANES).index(plane)] = 1
        hit, normal = np.zeros(1, dtype=np.int32), np.zeros(3)
        found = mujoco.mj_ray(self.model, self.data, position, rotation[:, 2], groups, 1, -1, hit, normal)
        return found if found >= 0.0 else math.inf


def stop(cell, plane):
    """Returns joints from which the ranger sees a plane well enough."""
    normal = np.array(PLANES[plane][0])
    while True:
        joints = RNG.uniform(-2.9, 2.9, JOINTS)
        _, rotation = cell.pose(joints)
        if abs(rotation[:, 2] @ normal) > 0.35 and 0.2 < cell.distance(joints, plane) < 2.5:
            return joints


def between(stops, time):
    """Returns the joints and the number of the stop that is next, at a time of the run."""
    period = REST_S + MOVE_S
    here = min(int(time // period), len(stops) - 1)
    part = min(max((time - here * period - REST_S) / MOVE_S, 0.0), 1.0)
    after = min(here + 1, len(stops) - 1)
    smooth = part**3 * (10.0 - 15.0 * part + 6.0 * part**2)
    return stops[here] + smooth * (stops[after] - stops[here]), after if part > 0.0 else here


def reading(cell, joints, plane, lost):
    """Returns what the ranger says: +Inf where it sees nothing, -Inf where it is too near (REP 117)."""
    distance = cell.distance(joints, plane)
    if lost or distance > FARTHEST_M:
        return math.inf
    return -math.inf if distance < NEAREST_M else distance + RNG.normal(0.0, NOISE_M)


def record(cell, stops, planes, blind):
    """Writes the run: joint states, a gripper's among them, ranges, and the names of the targets."""
    store = get_typestore(Stores.ROS2_JAZZY)
    types, folder = store.types, HERE / "run"
    shutil.rmtree(folder, ignore_errors=True)
    writer = Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP)
    writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    none, names = np.array([]), [f"j{i + 1}" for i in range(JOINTS)]

    def header(time, frame):
        sec, nanosec = divmod(round((BEGAN_S + time) * 1e9), 10**9)
        return types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](sec, nanosec), frame)

    def joint_state(time, names, positions):
        return types["sensor_msgs/msg/JointState"](header(time, ""), names, positions, none, none)

    end = len(stops) * (REST_S + MOVE_S) - MOVE_S
    messages = []
    for time in np.arange(0.0, end, 1.0 / JOINT_HZ):
        joints = between(stops, time)[0] + RNG.normal(0.0, TREMBLE_RAD, JOINTS)
        seen = np.round(joints / ENCODER_RAD) * ENCODER_RAD
        messages.append((time + JOINTS_LATE_S, "/joint_states", joint_state(time, names, seen)))
    for time in np.arange(0.2, end, 1.0):
        messages.append((time + 0.002, "/joint_states", joint_state(time, ["gripper"], np.array([0.04]))))
    for time in np.arange(0.03, end, 1.0 / RANGE_HZ):
        joints, following = between(stops, time)
        value = reading(cell, joints, planes[following], following == blind or RNG.random() < LOST)
        message = types["sensor_msgs/msg/Range"](
            header(time, "ranger_link"), 1, 0.001, NEAREST_M, FARTHEST_M, value, NOISE_M**2
        )
        messages.append((time + RANGER_LATE_S, "/ranger/range", message))
    for k, plane in enumerate(planes):
        if k == 0 or plane != planes[k - 1]:
            time = max(0.0, k * (REST_S + MOVE_S) - MOVE_S)
            messages.append((time + JOINTS_LATE_S, "/ranger/target", types["std_msgs/msg/String"](plane)))
    with writer:
        topics = {}
        for time, topic, message in sorted(messages, key=lambda each: each[0]):
            kind = message.__msgtype__
            if topic not in topics:
                topics[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(topics[topic], round((BEGAN_S + time) * 1e9), store.serialize_cdr(message, kind))


def main():
    """Writes `run/`, `validation.csv` and `truth.json`."""
    numbers = truth()
    cell = Cell(numbers)
    planes = [plane for plane in PLANES for _ in range(STOPS_PER_PLANE)]
    record(cell, [stop(cell, plane) for plane in planes], planes, blind=40)
    lines, positions, rotations = ["j1,j2,j3,j4,j5,j6,range,target"], [], []
    for k in range(VALIDATION):
        plane = list(PLANES)[k % len(PLANES)]
        joints = np.round(stop(cell, plane), 9)
        position, rotation = cell.pose(joints)
        value = cell.distance(joints, plane) + RNG.normal(0.0, NOISE_M / math.sqrt(10))
        lines.append(",".join([*(f"{q:.9f}" for q in joints), f"{value:.9f}", plane]))
        positions.append(position.tolist())
        rotations.append(rotation.tolist())
    (HERE / "validation.csv").write_text("\n".join(lines) + "\n")
    true = dict(zip(("theta", "d", "a", "alpha", "beta"), (n.tolist() for n in numbers), strict=True))
    document = {"true": true, "validation_position": positions, "validation_rotation": rotations}
    (HERE / "truth.json").write_text(json.dumps(document) + "\n")


if __name__ == "__main__":
    main()
