"""What is gathered while a bag's files are read one after the other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass, field

from boresight.errors import InputError

LIMIT_MIB = 1024
"""As much as the messages that are kept may hold together: millions of joint states."""

LARGEST_MESSAGE = 2**20
"""No joint state or range is longer than this [bytes]; a message that says so is not one."""

TRANSFORMS = "tf2_msgs/msg/TFMessage"
"""The type that holds the transforms of many frames, as a rule of the robot's own: kept where a topic is named."""

_TOLD = 10


class TooMuch(InputError):
    """There are more messages than memory should hold."""


@dataclass
class Tape:
    """Messages of the wanted topics, how many there were of every topic, and what could not be read.

    Attributes:
        name: what the user calls the bag.
        types: message types that are worth keeping.
        topics: names of the topics to keep; empty keeps every topic of these types.
        transforms: names of the topics of `TRANSFORMS` to keep too.
        type_of: type of every topic, by name.
        counts: messages of every topic.
        kept: (received [ns], serialised message), by topic.
        losses: what could not be read, a sentence each.
    """

    name: str
    types: Collection[str]
    topics: Collection[str] = ()
    transforms: Collection[str] = ()
    type_of: dict[str, str] = field(default_factory=dict)
    counts: Counter[str] = field(default_factory=Counter)
    kept: dict[str, list[tuple[int, bytes]]] = field(default_factory=dict)
    losses: list[str] = field(default_factory=list)
    _bytes: int = 0

    def announce(self, topic: str, kind: str, encoding: str) -> None:
        """Notes that there is a topic, whether or not a message of it follows.

        Args:
            topic: its name.
            kind: the type of its messages, `package/msg/Name` or `package/Name`.
            encoding: how they are serialised; messages in other encodings than `cdr` are not kept.
        """
        package, _, rest = kind.partition("/")
        full = kind if "/" in rest or not rest else f"{package}/msg/{rest}"
        self.type_of.setdefault(topic, full if encoding == "cdr" else f"{full} in {encoding}")

    def wants(self, topic: str) -> bool:
        """Whether messages of a topic are kept."""
        kind = self.type_of.get(topic)
        if kind == TRANSFORMS:
            return topic in self.transforms
        return kind in self.types and (not self.topics or topic in self.topics)

    def count(self, topic: str) -> None:
        """Counts a message that is not kept."""
        self.counts[topic] += 1

    def keep(self, topic: str, received_ns: int, data: bytes) -> None:
        """Counts and keeps a message.

        Raises:
            TooMuch: the messages kept are too many for the memory they deserve.
        """
        self.counts[topic] += 1
        self._bytes += len(data) + 64
        if self._bytes > LIMIT_MIB * 2**20:
            raise TooMuch(
                f"{self.name}: the messages of {', '.join(sorted(self.kept))} hold more than {LIMIT_MIB} MiB; "
                "name the topics to read, or split the bag"
            )
        self.kept.setdefault(topic, []).append((received_ns, data))

    def lose(self, what: str) -> None:
        """Notes something that could not be read; a bag in ruins is not told piece by piece."""
        if len(self.losses) < _TOLD:
            self.losses.append(what)
        elif len(self.losses) == _TOLD:
            self.losses.append(f"{self.name}: more is damaged than is told here")

    @property
    def total(self) -> int:
        """Messages read so far, of all topics."""
        return self.counts.total()
