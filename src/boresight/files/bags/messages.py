"""Serialised ROS messages as plain arrays of time and value.

Only these standard types are decoded. The definitions that a bag carries are not used: making classes of them
would run code that a stranger's file brings.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from boresight.files.bags.inflating import inflate
from boresight.files.bags.joint_states import JointStateReader
from boresight.files.bags.tape import LARGEST_MESSAGE, TRANSFORMS
from boresight.files.signatures import ZSTD

JOINTS = ("sensor_msgs/msg/JointState",)
RANGES = ("sensor_msgs/msg/Range", "std_msgs/msg/Float64", "std_msgs/msg/Float32")
POSITIONS = ("geometry_msgs/msg/PointStamped",)
POSES = (
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    "geometry_msgs/msg/TransformStamped",
)
WORDS = ("std_msgs/msg/String",)
TYPES = (*JOINTS, *RANGES, *POSITIONS, *POSES, *WORDS)
"""The types of message that are decoded."""

Pose = tuple[float, float, float, float, float, float, float]

_LONGEST_WORD = 200
_MOST_JOINTS = 10_000


@dataclass(frozen=True)
class Decoded:
    """The messages of a topic.

    Attributes:
        received: (messages,) when the recorder got each [s].
        stamp: (messages,) the header's time of each [s]; None where there is no header, or one that was left at zero.
        values: a row a message: joint positions [rad or m] by name; (range, lowest, highest) [m]; (x, y, z) [m];
            (x, y, z) [m] and a quaternion, w first; a word; ((frame, stamp [ns], pose), ...) of a `TRANSFORMS`.
        unreadable: how many messages were not what their type says.
    """

    received: Float[np.ndarray, " messages"]
    stamp: Float[np.ndarray, " messages"] | None
    values: list[Any]
    unreadable: int

    def __len__(self) -> int:
        """Number of messages."""
        return len(self.values)


def decode(kind: str, messages: Iterable[tuple[int, bytes]]) -> Decoded:
    """Returns the messages of a topic, those that cannot be decoded left out and counted.

    Args:
        kind: one of `TYPES`, or `TRANSFORMS`.
        messages: (received [ns], serialised) of each; inflated here where each was compressed by itself.
    """
    read, received, stamps, values, unreadable = _reader(kind), [], [], [], 0
    for when, data in messages:
        try:
            stamp, value = read(_bare(data))
        except Exception:  # whatever the decoder stumbles over in a stranger's bytes
            unreadable += 1
            continue
        received.append(when)
        stamps.append(stamp)
        values.append(value)
    stamped = all(stamps) and bool(stamps)
    return Decoded(_seconds(received), _seconds(stamps) if stamped else None, values, unreadable)


def by_frame(decoded: Decoded) -> dict[str, Decoded]:
    """Returns the poses of every frame that messages of type `TRANSFORMS` tell of, by its name."""
    found: dict[str, list[tuple[float, int, Pose]]] = {}
    for received, transforms in zip(decoded.received.tolist(), decoded.values, strict=True):
        for frame, stamp, pose in transforms:
            found.setdefault(frame.lstrip("/"), []).append((received, stamp, pose))
    return {frame: _of_frame(*zip(*messages, strict=True)) for frame, messages in found.items()}


def _of_frame(received: tuple[float, ...], stamps: tuple[int, ...], poses: tuple[Pose, ...]) -> Decoded:
    return Decoded(np.array(received), _seconds(list(stamps)) if all(stamps) else None, list(poses), 0)


def _seconds(nanoseconds: list[int]) -> Float[np.ndarray, " messages"]:
    """Returns seconds; a double holds today's Unix time to a quarter of a microsecond."""
    return np.array(nanoseconds, dtype=np.float64) * 1e-9


def _bare(data: bytes) -> bytes:
    return inflate(data, "zstd", LARGEST_MESSAGE)[0] if data.startswith(ZSTD) else data


def _reader(kind: str) -> Callable[[bytes], tuple[int, Any]]:
    """Returns the function from a serialised message to (stamp [ns], value)."""
    from rosbags.typesys import Stores, get_typestore

    # Range got a variance between these two; its length tells which of them wrote it.
    stores = [get_typestore(store) for store in (Stores.ROS2_JAZZY, Stores.ROS2_HUMBLE)]
    take = _TAKERS[kind]

    def read(data: bytes) -> tuple[int, Any]:
        try:
            message: Any = stores[0].deserialize_cdr(data, kind)
        except Exception:
            message = stores[1].deserialize_cdr(data, kind)
        stamp = message.header.stamp if hasattr(message, "header") else None
        return (stamp.sec * 10**9 + stamp.nanosec if stamp else 0), take(message)

    return JointStateReader(read) if kind in JOINTS else read


def _joints(message: Any) -> tuple[tuple[str, ...], Float[np.ndarray, " joints"]]:
    names = tuple(message.name) if len(message.position) else ()  # some publish velocities alone
    if len(names) != len(message.position) or len(names) > _MOST_JOINTS:
        raise ValueError("names and positions differ in number")
    return names, np.array(message.position, dtype=np.float64)


def _range(message: Any) -> tuple[float, float, float]:
    return message.range, message.min_range, message.max_range


def _number(message: Any) -> tuple[float, float, float]:
    return message.data, 0.0, 0.0


def _position(message: Any) -> tuple[float, float, float]:
    return message.point.x, message.point.y, message.point.z


def _pose_stamped(message: Any) -> Pose:
    return _pose(message.pose.position, message.pose.orientation)


def _pose_with_covariance(message: Any) -> Pose:
    return _pose(message.pose.pose.position, message.pose.pose.orientation)


def _transform(message: Any) -> Pose:
    return _pose(message.transform.translation, message.transform.rotation)


def _transforms(message: Any) -> tuple[tuple[str, int, Pose], ...]:
    return tuple(
        (each.child_frame_id, each.header.stamp.sec * 10**9 + each.header.stamp.nanosec, _transform(each))
        for each in message.transforms
    )


def _pose(at: Any, turned: Any) -> Pose:
    return at.x, at.y, at.z, turned.w, turned.x, turned.y, turned.z


def _word(message: Any) -> str:
    return str(message.data)[:_LONGEST_WORD]


_TAKERS: dict[str, Callable[[Any], Any]] = {
    **dict.fromkeys(JOINTS, _joints),
    **dict.fromkeys(RANGES, _number),
    RANGES[0]: _range,
    **dict.fromkeys(POSITIONS, _position),
    **dict(zip(POSES, (_pose_stamped, _pose_with_covariance, _transform), strict=True)),
    TRANSFORMS: _transforms,
    **dict.fromkeys(WORDS, _word),
}
