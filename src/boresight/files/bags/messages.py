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
from boresight.files.bags.tape import LARGEST_MESSAGE
from boresight.files.signatures import ZSTD

JOINTS = ("sensor_msgs/msg/JointState",)
RANGES = ("sensor_msgs/msg/Range", "std_msgs/msg/Float64", "std_msgs/msg/Float32")
POSITIONS = ("geometry_msgs/msg/PointStamped",)
WORDS = ("std_msgs/msg/String",)
TYPES = (*JOINTS, *RANGES, *POSITIONS, *WORDS)
"""The types of message that are decoded."""

_LONGEST_WORD = 200
_MOST_JOINTS = 10_000


@dataclass(frozen=True)
class Decoded:
    """The messages of a topic.

    Attributes:
        received: (messages,) when the recorder got each [s].
        stamp: (messages,) the header's time of each [s]; None where there is no header, or one that was left at zero.
        values: a row a message: joint positions [rad or m] by name; (range, lowest, highest) [m]; (x, y, z) [m];
            a word.
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
        kind: one of `TYPES`.
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


def _word(message: Any) -> str:
    return str(message.data)[:_LONGEST_WORD]


_TAKERS: dict[str, Callable[[Any], Any]] = {
    **dict.fromkeys(JOINTS, _joints),
    **dict.fromkeys(RANGES, _number),
    RANGES[0]: _range,
    **dict.fromkeys(POSITIONS, _position),
    **dict.fromkeys(WORDS, _word),
}
