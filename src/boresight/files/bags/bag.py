"""A bag's content: its topics, and the messages that a calibration can use."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from boresight.errors import InputError
from boresight.files.bags.messages import TYPES, Decoded, by_frame, decode
from boresight.files.bags.storages import digest, files_of, read_storage
from boresight.files.bags.tape import TRANSFORMS, Tape, TooMuch
from boresight.files.problems import printable

_TOPICS_TOLD = 12


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic of a bag: its name, the type of its messages, and how many could be read."""

    name: str
    type: str
    count: int


@dataclass(frozen=True)
class Bag:
    """What a bag holds.

    Attributes:
        name: what the user calls it.
        topics: all of them, by name.
        messages: the decoded messages of the topics that a calibration can use, by name.
        losses: what could not be read, a sentence each.
        sha256: of its file, or of its files.
    """

    name: str
    topics: Mapping[str, Topic]
    messages: Mapping[str, Decoded]
    losses: tuple[str, ...]
    sha256: str

    def of_type(self, *kinds: str) -> list[str]:
        """Returns the topics of some types that have messages, in order of name."""
        return [name for name in sorted(self.messages) if self.topics[name].type in kinds]

    @property
    def listing(self) -> str:
        """What is in the bag, for messages."""
        told = [f"{printable(t.name)} ({printable(t.type) or 'no type'}, {t.count})" for t in self.topics.values()]
        more = f" and {len(told) - _TOPICS_TOLD} more" if len(told) > _TOPICS_TOLD else ""
        return (", ".join(told[:_TOPICS_TOLD]) or "nothing") + more


def read_bag(path: Path, name: str, topics: Collection[str] = (), transforms: Collection[str] = ()) -> Bag:
    """Returns what can be read of a rosbag2 folder, or of one of its files.

    Args:
        path: of the folder, the `.mcap` or the `.db3` file.
        name: what the user calls it.
        topics: names of the topics to read; every topic of a known type by default.
        transforms: names of the topics of `tf2_msgs/msg/TFMessage` to read too: each frame of one becomes a topic
            of its own, /tf:frame.

    Raises:
        InputError: rosbags is not installed, this is no bag, or nothing in it can be read.
    """
    if find_spec("rosbags") is None:
        raise InputError(f"{name}: reading ROS bags needs rosbags: pip install 'boresight[ros]'")
    tape = Tape(name, TYPES, frozenset(topics), frozenset(transforms))
    try:
        files = files_of(path, name, tape)
        refused: list[str] = []
        for file in files:
            try:
                tape.begin(file.stat().st_size)
                read_storage(file, f"{name}/{file.name}" if path.is_dir() else name, tape)
            except TooMuch:
                raise
            except InputError as error:  # the other files of a bag may be in order
                refused += error.problems
        sha256 = digest(files)
    except OSError as error:
        raise InputError(f"{name}: it cannot be read: {error.strerror or error}") from None
    if refused and not tape.total:
        raise InputError([printable(problem) for problem in refused])
    decoded = {}
    for topic in sorted(tape.kept):
        decoded[topic] = decode(tape.type_of[topic], tape.kept.pop(topic))
        if decoded[topic].unreadable:
            tape.lose(f"{name}: {decoded[topic].unreadable} messages of {topic} could not be decoded")
    told = {topic: Topic(topic, tape.type_of[topic], tape.counts[topic]) for topic in sorted(tape.type_of)}
    for topic in [topic for topic in decoded if tape.type_of[topic] == TRANSFORMS]:
        for frame, poses in by_frame(decoded.pop(topic)).items():
            decoded[f"{topic}:{frame}"] = poses
            told[f"{topic}:{frame}"] = Topic(f"{topic}:{frame}", TRANSFORMS, len(poses))
    return Bag(
        name,
        told,
        decoded,
        tuple(printable(loss) for loss in (*refused, *tape.losses)),
        sha256,
    )
