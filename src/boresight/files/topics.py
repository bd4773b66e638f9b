"""Which topics of a bag are meant: those that were named, or the only ones of their type."""

from __future__ import annotations

from dataclasses import dataclass

from boresight.errors import InputError, did_you_mean
from boresight.files.bags import Bag
from boresight.files.bags.messages import JOINTS, POSES, POSITIONS, RANGES, WORDS
from boresight.files.bags.tape import TRANSFORMS
from boresight.files.problems import listed, printable, shown
from boresight.recordings import Rules

CHANNELS = {"range": ("range",), "position": ("x", "y", "z"), "pose": ("x", "y", "z", "qw", "qx", "qy", "qz")}
"""The columns of what a bag can hold, by the key that names its topic."""

_TYPES = {"range": RANGES, "position": (*POSITIONS, *POSES), "pose": POSES}


@dataclass(frozen=True)
class Choice:
    """What to read in a bag.

    Attributes:
        joints: topics of joint states; empty takes the only one there is.
        range: topic of ranges; None takes the only one there is.
        position: topic of measured positions, in place of ranges; or of poses, whose orientation is left out.
        pose: topic of measured poses, in place of ranges.
        target: what the sensor pointed at all the time.
        targets: topic of words that name the target from then on; None takes one that is called `target`.
        time_offset: added to the readings' times [s]: how much the sensor's clock is behind the arm's.
        rules: what counts as still.
    """

    joints: tuple[str, ...] = ()
    range: str | None = None
    position: str | None = None
    pose: str | None = None
    target: str | None = None
    targets: str | None = None
    time_offset: float = 0.0
    rules: Rules = Rules()

    @property
    def topics(self) -> tuple[str, ...]:
        """Every topic that is named."""
        named = (*self.joints, self.range, self.position, self.pose, self.targets)
        return tuple(topic for topic in named if topic is not None)

    @property
    def transforms(self) -> tuple[str, ...]:
        """The topics that poses are read of where they hold many frames: /tf of /tf:tool."""
        return tuple(topic.partition(":")[0] for topic in (self.position, self.pose) if topic is not None)

    def readings(self, kind: str) -> str | None:
        """Returns the topic that is named for a kind of reading."""
        return {"range": self.range, "position": self.position, "pose": self.pose}[kind]


@dataclass(frozen=True)
class Topics:
    """The topics to use.

    Attributes:
        joints: of joint states.
        kind: `range`, `position` or `pose`.
        readings: of these.
        targets: of words that name targets, or None.
    """

    joints: tuple[str, ...]
    kind: str
    readings: str
    targets: str | None

    @property
    def used(self) -> dict[str, str]:
        """The topics by what for."""
        targets = {"targets": self.targets} if self.targets else {}
        return {"joints": ", ".join(self.joints), self.kind: self.readings, **targets}


def topics_of(bag: Bag, choice: Choice, kind: str | None = None) -> Topics:
    """Returns the topics of a bag that a choice means.

    Args:
        bag: where they are.
        choice: what was named.
        kind: `range`, `position` or `pose`; whichever was named or is there, in this order, by default.

    Raises:
        InputError: a topic is missing, of another type, or not to be told from others.
    """
    _check_named(bag, choice)
    kind = kind or _kind(bag, choice)
    types, named = _TYPES[kind], choice.readings(kind)
    joints = choice.joints or (_only(bag, "joints", JOINTS),)
    found = Topics(joints, kind, named or _only(bag, kind, types), choice.targets or _target_topic(bag, choice))
    for joint in found.joints:
        _check_type(bag, "joints", joint, JOINTS)
    _check_type(bag, kind, found.readings, types)
    if found.targets is not None:
        _check_type(bag, "targets", found.targets, WORDS)
    return found


def _kind(bag: Bag, choice: Choice) -> str:
    named = [kind for kind in CHANNELS if choice.readings(kind) is not None]
    there = [("range", RANGES), ("position", POSITIONS), ("pose", POSES)]
    return (named or [kind for kind, types in there if bag.of_type(*types)] or ["range"])[0]


def _check_named(bag: Bag, choice: Choice) -> None:
    problems = []
    for topic in choice.topics:
        if topic not in bag.topics:
            near = did_you_mean(topic[:100], bag.topics)
            problems.append(f"{bag.name}: there is no topic {shown(topic)}{near}; the bag holds {bag.listing}")
    if problems:
        raise InputError([printable(problem) for problem in problems])


def _check_type(bag: Bag, key: str, topic: str, types: tuple[str, ...]) -> None:
    kind, frames = bag.topics[topic].type, [t for t in bag.topics if t.startswith(f"{topic}:")]
    if kind == TRANSFORMS and POSES[0] in types:
        if topic in bag.messages:
            return
        one = f"; name one of them: {key}: {frames[0]}" if frames else ""
        raise InputError(printable(f"{bag.name}: {key}: {topic} holds the frames {listed(frames)}{one}"))
    if kind not in types:
        given = f"{key}: {topic} is of type {bag.topics[topic].type}"
    elif topic not in bag.messages or not len(bag.messages[topic]):
        given = f"{key}: {topic} has no message that could be read"
    else:
        return
    lost = "".join(f"; {loss}" for loss in bag.losses)
    raise InputError(
        printable(f"{bag.name}: {given}; expected {' or '.join(types)}; the bag holds {bag.listing}{lost}")
    )


def _only(bag: Bag, key: str, types: tuple[str, ...]) -> str:
    found = bag.of_type(types[0]) or bag.of_type(*types)
    if len(found) == 1:
        return found[0]
    told = f"are {len(found)} topics of {types[0]}" if found else f"is no topic with messages of {' or '.join(types)}"
    mend = f"name one of them: {key}: {found[0]}" if found else f"expected one for {key}"
    lost = "".join(f"; {loss}" for loss in bag.losses)
    raise InputError(printable(f"{bag.name}: there {told}; {mend}; the bag holds {bag.listing}{lost}"))


def _target_topic(bag: Bag, choice: Choice) -> str | None:
    found = [topic for topic in bag.of_type(*WORDS) if topic.rpartition("/")[2] == "target"]
    return found[0] if len(found) == 1 and choice.target is None else None
