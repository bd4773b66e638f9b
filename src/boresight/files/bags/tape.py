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

MOST_TOPICS, LONGEST_TOPIC = 10_000, 4096
"""Topics of a bag, and characters of a topic's name or type."""

ALWAYS, BYTES_EACH = 1_000_000, 8
"""Messages that a file may have whatever its size, and bytes of it that each of more takes, compressed or not."""

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
        total: messages read so far, of all topics.
    """

    name: str
    types: Collection[str]
    topics: Collection[str] = ()
    transforms: Collection[str] = ()
    type_of: dict[str, str] = field(default_factory=dict)
    counts: Counter[str] = field(default_factory=Counter)
    kept: dict[str, list[tuple[int, bytes]]] = field(default_factory=dict)
    losses: list[str] = field(default_factory=list)
    total: int = 0
    _bytes: int = 0
    _most: float = float("inf")

    def begin(self, size: int) -> None:
        """Notes that a file of so many bytes follows: it has no more messages than fit in."""
        self._most = self.total + max(ALWAYS, size // BYTES_EACH)

    def announce(self, topic: str, kind: str, encoding: str) -> None:
        """Notes that there is a topic, whether or not a message of it follows.

        Args:
            topic: its name.
            kind: the type of its messages, `package/msg/Name` or `package/Name`.
            encoding: how they are serialised; messages in other encodings than `cdr` are not kept.

        Raises:
            TooMuch: there are more topics, or longer names, than any robot has.
        """
        if max(map(len, (topic, kind, encoding))) > LONGEST_TOPIC:
            raise TooMuch(f"{self.name}: a topic has a name or a type of more than {LONGEST_TOPIC:,} characters")
        if len(self.type_of) >= MOST_TOPICS and topic not in self.type_of:
            raise TooMuch(f"{self.name}: there are more than {MOST_TOPICS:,} topics; record those of the arm alone")
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
        """Counts a message.

        Raises:
            TooMuch: no recording has so many in a file of its size.
        """
        self.counts[topic] += 1
        self.total += 1
        if self.total > self._most:
            raise TooMuch(
                f"{self.name}: there are more than {self._most:,} messages; expected at most {ALWAYS:,} in a file, or "
                f"one in every {BYTES_EACH} bytes of it; record the topics of the arm and the sensor alone"
            )

    def keep(self, topic: str, received_ns: int, data: bytes) -> None:
        """Counts and keeps a message.

        Raises:
            TooMuch: the messages kept are too many for the memory they deserve.
        """
        self.count(topic)
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
