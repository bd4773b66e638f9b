"""Runs of an arm between pauses, and ROS 2 bags of them written by rosbags: nothing of the reader under test."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

T0 = 1_700_000_000.0
STORE = get_typestore(Stores.ROS2_JAZZY)
TYPES = STORE.types
NAMES = ("j1", "j2")


def header(stamp):
    time = TYPES["builtin_interfaces/msg/Time"](sec=int(stamp // 1), nanosec=round(stamp % 1 * 1e9) % 10**9)
    return TYPES["std_msgs/msg/Header"](stamp=time, frame_id="ranger_link")


def joint_state(stamp, names, positions):
    none = np.array([])
    position = np.asarray(positions, dtype=float)
    return TYPES["sensor_msgs/msg/JointState"](
        header=header(stamp), name=list(names), position=position, velocity=none, effort=none
    )


def range_message(stamp, value, low=0.05, high=5.0):
    return TYPES["sensor_msgs/msg/Range"](
        header=header(stamp),
        radiation_type=1,
        field_of_view=0.001,
        min_range=low,
        max_range=high,
        range=value,
        variance=0.0,
    )


def point(stamp, xyz):
    x, y, z = map(float, xyz)
    return TYPES["geometry_msgs/msg/PointStamped"](
        header=header(stamp), point=TYPES["geometry_msgs/msg/Point"](x=x, y=y, z=z)
    )


def quaternion(w, x, y, z):
    return TYPES["geometry_msgs/msg/Quaternion"](x=float(x), y=float(y), z=float(z), w=float(w))


def _pose(xyz, turned):
    x, y, z = map(float, xyz)
    at = TYPES["geometry_msgs/msg/Point"](x=x, y=y, z=z)
    return TYPES["geometry_msgs/msg/Pose"](position=at, orientation=quaternion(*turned))


def pose(stamp, xyz, turned):
    return TYPES["geometry_msgs/msg/PoseStamped"](header=header(stamp), pose=_pose(xyz, turned))


def pose_with_covariance(stamp, xyz, turned):
    both = TYPES["geometry_msgs/msg/PoseWithCovariance"](pose=_pose(xyz, turned), covariance=np.zeros(36))
    return TYPES["geometry_msgs/msg/PoseWithCovarianceStamped"](header=header(stamp), pose=both)


def transform(stamp, xyz, turned, frame="tool"):
    x, y, z = map(float, xyz)
    both = TYPES["geometry_msgs/msg/Transform"](
        translation=TYPES["geometry_msgs/msg/Vector3"](x=x, y=y, z=z), rotation=quaternion(*turned)
    )
    return TYPES["geometry_msgs/msg/TransformStamped"](header=header(stamp), child_frame_id=frame, transform=both)


def transforms(*each):
    return TYPES["tf2_msgs/msg/TFMessage"](transforms=list(each))


def number(value):
    return TYPES["std_msgs/msg/Float64"](data=float(value))


def word(text):
    return TYPES["std_msgs/msg/String"](data=text)


@dataclass
class Script:
    """Messages to record: (received [s], topic, message)."""

    messages: list = field(default_factory=list)

    def say(self, received, topic, message):
        self.messages.append((received, topic, message))

    def write(self, path, storage="mcap", compression=None, pieces=1):
        """Writes a rosbag2 folder; with several pieces, as a recorder that begins new files on the way."""
        messages = sorted(self.messages, key=lambda each: each[0])
        if pieces > 1:
            return self._split(Path(path), messages, storage, pieces)
        writer = Writer(path, version=9, storage_plugin=StoragePlugin[storage.upper()])
        if compression:
            writer.set_compression(CompressionMode[compression.upper()], CompressionFormat.ZSTD)
        with writer:
            topics = {}
            for received, topic, message in messages:
                kind = message.__msgtype__
                if topic not in topics:
                    topics[topic] = writer.add_connection(topic, kind, typestore=STORE)
                writer.write(topics[topic], round(received * 1e9), STORE.serialize_cdr(message, kind))
        return Path(path)

    def _split(self, path, messages, storage, pieces):
        path.mkdir()
        listed = []
        for k, part in enumerate(np.array_split(np.arange(len(messages)), pieces)):
            piece = Script([messages[i] for i in part]).write(path / f"piece_{k}", storage)
            (file,) = [f for f in piece.iterdir() if f.suffix != ".yaml"]
            listed.append(f"run_{k}{file.suffix}")
            file.rename(path / listed[-1])
            (piece / "metadata.yaml").unlink()
            piece.rmdir()
        files = ", ".join(listed)
        (path / "metadata.yaml").write_text(f"rosbag2_bagfile_information: {{relative_file_paths: [{files}]}}\n")
        return path


def motion(stops, rest_s=1.2, move_s=0.8, rate=100.0):
    """Returns times [s] and joints of a run that rests at each stop and moves smoothly between."""
    stops = np.asarray(stops, dtype=float)
    period = rest_s + move_s
    time = np.arange(0.0, len(stops) * period - move_s, 1.0 / rate)
    here = np.minimum((time // period).astype(int), len(stops) - 1)
    part = np.clip((time - here * period - rest_s) / move_s, 0.0, 1.0)[:, None]
    smooth = part**3 * (10.0 - 15.0 * part + 6.0 * part**2)
    after = np.minimum(here + 1, len(stops) - 1)
    return time, stops[here] + smooth * (stops[after] - stops[here])


def stops(count, seed=0, joints=2):
    return np.random.default_rng(seed).uniform(-1.0, 1.0, (count, joints))


def distance(joints):
    """A range that depends on every joint [m]."""
    return 1.0 + 0.3 * np.sin(joints[:, 0]) + 0.2 * np.cos(joints[:, 1])


def run(count=6, *, noise=2e-4, joint_noise=1e-5, rate=100.0, range_rate=50.0, seed=0, lost=(), late=0.004):
    """Returns the script of a run, with its stops; readings whose number is in `lost` are infinite."""
    rng = np.random.default_rng([seed, 1])
    at = stops(count, seed)
    time, joints = motion(at, rate=rate)
    script = Script()
    for t, q in zip(time, joints + rng.normal(0.0, joint_noise, joints.shape), strict=True):
        script.say(T0 + t + late, "/joint_states", joint_state(T0 + t, NAMES, q))
    when = np.arange(time[0] + 0.003, time[-1], 1.0 / range_rate)
    there = np.stack([np.interp(when, time, column) for column in joints.T], axis=1)
    values = distance(there) + rng.normal(0.0, noise, len(when))
    for k, (t, value) in enumerate(zip(when, values, strict=True)):
        script.say(T0 + t + late, "/ranger", range_message(T0 + t, np.inf if k in lost else value))
    return script, at
