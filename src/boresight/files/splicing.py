"""A calibrated URDF: the user's own bytes, with new numbers where origins have changed and nowhere else."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from boresight.arm import Arm
from boresight.arm.serial import SerialChain, SerialJoint, corrected_chain
from boresight.calibration.campaign import RobotFile
from boresight.files.elements import Element, read_elements
from boresight.files.sources import Source
from boresight.geometry import Frame

_NAME = re.compile(rb"<[^\s/>]+")
_ATTRIBUTE = re.compile(rb"""\s+([^\s=/>]+)\s*=\s*("[^"]*"|'[^']*')""")
_WORD = re.compile(rb"\S+")
_SPACE = re.compile(rb"\s*")

Edit = tuple[int, int, bytes]
"""First byte, byte behind the last, and what takes their place."""


def calibrated_urdf(robot: RobotFile, nominal: Arm, identified: Arm) -> bytes:
    """Returns the URDF of an identified arm: the file it came from with only the changed origins' numbers new.

    Args:
        robot: the file and its chain.
        nominal: its arm.
        identified: the same arm with other numbers.
    """
    return spliced(robot, corrected_chain(robot.chain, nominal, identified))


def spliced(robot: RobotFile, chain: SerialChain) -> bytes:
    """Returns the file with the origins of another chain of the same joints."""
    root = read_elements(Source(Path(robot.name), robot.name, robot.content))
    elements = {joint.attributes["name"]: joint for joint in root.all("joint")}
    edits: list[Edit] = []
    for old, new in zip(robot.chain.joints, chain.joints, strict=True):
        if new.origin != old.origin:
            edits += _edits(robot.content, elements[old.name], old, new.origin)
    content = robot.content
    for start, end, text in sorted(edits, reverse=True):
        content = content[:start] + text + content[end:]
    return content


@dataclass(frozen=True, slots=True)
class _Tag:
    """A start tag's bytes.

    Attributes:
        named: the byte behind its name.
        end: the byte behind it.
        values: where each attribute's value lies, without its quotes.
    """

    named: int
    end: int
    values: dict[bytes, tuple[int, int]]


def _tag_at(content: bytes, start: int) -> _Tag:
    """Returns the start tag at a byte; the file is well-formed, so this cannot go wrong."""
    name = _NAME.match(content, start)
    assert name is not None
    at, values = name.end(), {}
    while (attribute := _ATTRIBUTE.match(content, at)) is not None:
        values[attribute[1]] = (attribute.start(2) + 1, attribute.end(2) - 1)
        at = attribute.end()
    return _Tag(name.end(), content.index(b">", at) + 1, values)


def _edits(content: bytes, joint: Element, old: SerialJoint, new: Frame) -> list[Edit]:
    origins = joint.all("origin")
    if not origins:
        return [_inserted(content, _tag_at(content, joint.start).end, new)]
    tag = _tag_at(content, origins[0].start)
    edits = []
    for name, was, now in ((b"xyz", old.origin.xyz, new.xyz), (b"rpy", old.origin.rpy, new.rpy)):
        if was == now:
            continue
        if name in tag.values:
            start, end = tag.values[name]
            edits.append((start, end, _renumbered(content[start:end], was, now)))
        else:
            last = max((end + 1 for _, end in tag.values.values()), default=tag.named)
            edits.append((last, last, b' %s="%s"' % (name, _numbers(now))))
    return edits


def _renumbered(text: bytes, was: tuple[float, ...], now: tuple[float, ...]) -> bytes:
    """Returns an attribute's value with the numbers that have changed, spaces and the others as they were."""
    words = list(_WORD.finditer(text))
    if len(words) != len(now) or b"&" in text:
        return _numbers(now)
    for word, a, b in reversed(list(zip(words, was, now, strict=True))):
        if a != b:
            text = text[: word.start()] + _numbers((b,)) + text[word.end() :]
    return text


def _inserted(content: bytes, at: int, origin: Frame) -> Edit:
    """Returns a new origin as the joint's first element, indented as what stands there."""
    space = _SPACE.match(content, at)
    assert space is not None
    indent = space[0] if content[space.end() : space.end() + 1] == b"<" else b""
    return at, at, indent + b'<origin xyz="%s" rpy="%s"/>' % (_numbers(origin.xyz), _numbers(origin.rpy))


def _numbers(values: tuple[float, ...]) -> bytes:
    """Returns numbers in the fewest digits that read back to the same bits."""
    return " ".join(repr(float(value) + 0.0) for value in values).encode("ascii")
