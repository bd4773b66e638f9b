"""From a stream of YAML events to plain data; nothing is ever constructed from a tag.

Size, nesting and the writing out of aliases are bounded while the text is read, before it can cost more
than it is worth. ruamel's own composer recurses as deep as the text says, and its aliases multiply unseen.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from ruamel.yaml import YAML, events

from boresight.errors import InputError
from boresight.files.problems import Problems, printable, shown
from boresight.files.scalars import TAGS, plain_scalar

KeyPath = tuple[str | int, ...]

DEEPEST = 50
MOST_VALUES = 100_000


@dataclass(frozen=True, slots=True)
class Node:
    """A value as written: text or a scalar, a list of nodes, or keys with their lines and nodes."""

    line: int
    value: Any


class Composer:
    """Turns an event stream into nodes, once."""

    def __init__(self, text: str, name: str, problems: Problems) -> None:
        self._events: Iterator[Any] = YAML(typ="safe", pure=True).parse(text)
        self._name = name
        self._problems = problems
        self._anchors: dict[str, Node | None] = {}
        self._count = 0

    def root(self) -> Node:
        """Returns the only document's node; an empty one's value is None."""
        root = None
        for event in self._events:
            if isinstance(event, events.DocumentStartEvent) and root is not None:
                raise self._refused(event, "a second document begins here; expected one document in a file")
            if isinstance(event, events.NodeEvent):
                root = self._node(event, 0)
        return root or Node(1, None)

    def _node(self, event: Any, depth: int) -> Node:
        self._count += 1
        if self._count > MOST_VALUES:
            raise self._refused(event, f"more than {MOST_VALUES:,} values; readings belong in a CSV file")
        if depth > DEEPEST:
            raise self._refused(event, f"nested more than {DEEPEST} deep; expected a few levels of keys")
        if isinstance(event, events.AliasEvent):
            return self._alias(event)
        if event.anchor is not None:
            self._anchors[event.anchor] = None  # open: an alias to it in here would never end
        line = event.start_mark.line + 1
        if isinstance(event, events.ScalarEvent):
            node = Node(line, self._scalar(event))
        elif isinstance(event, events.SequenceStartEvent):
            self._refuse_tag(event, "tag:yaml.org,2002:seq")
            node = Node(line, [self._node(item, depth + 1) for item in self._until(events.SequenceEndEvent)])
        else:
            self._refuse_tag(event, "tag:yaml.org,2002:map")
            node = Node(line, self._keys(depth))
        if event.anchor is not None:
            self._anchors[event.anchor] = node
        return node

    def _until(self, end: type) -> Iterator[Any]:
        for event in self._events:
            if isinstance(event, end):
                return
            yield event

    def _keys(self, depth: int) -> dict[str, tuple[int, Node]]:
        keys: dict[str, tuple[int, Node]] = {}
        for event in self._until(events.MappingEndEvent):
            if not isinstance(event, events.ScalarEvent):
                raise self._refused(event, "a key is a list, a block or an alias; expected a plain word")
            self._refuse_tag(event, "!", *TAGS)
            line, key = event.start_mark.line + 1, event.value
            value = self._node(next(self._events), depth + 1)
            if key in keys:
                first = keys[key][0]
                self._problems.add(f"{self._name}, line {line}: the key {shown(key)} is there already, on line {first}")
            else:
                keys[key] = (line, value)
        return keys

    def _scalar(self, event: Any) -> Any:
        if event.tag in (None, "!"):
            return plain_scalar(event.value) if event.implicit[0] and event.tag is None else event.value
        self._refuse_tag(event, *TAGS)
        return event.value if event.tag == "tag:yaml.org,2002:str" else plain_scalar(event.value)

    def _alias(self, event: Any) -> Node:
        if event.anchor not in self._anchors:
            raise self._refused(
                event, f"the alias *{event.anchor} stands for nothing; no &{event.anchor} comes before it"
            )
        node = self._anchors[event.anchor]
        if node is None:
            raise self._refused(
                event, f"the alias *{event.anchor} stands inside what it stands for and would never end"
            )
        return node

    def _refuse_tag(self, event: Any, *known: str) -> None:
        if event.tag is not None and event.tag not in known:
            line = event.start_mark.line + 1
            self._problems.add(
                f"{self._name}, line {line}: the tag {shown(event.tag)} is not known; expected plain data"
            )

    def _refused(self, event: Any, why: str) -> InputError:
        return InputError(printable(f"{self._name}, line {event.start_mark.line + 1}: {why}"))


def expanded(node: Node, key_path: KeyPath, lines: dict[KeyPath, int], name: str) -> Any:
    """Returns a node's plain data, aliases written out, and notes the line of every part."""
    if len(lines) > MOST_VALUES or len(key_path) > DEEPEST:
        raise InputError(printable(f"{name}, line {node.line}: its aliases, written out, are too many or too deep"))
    if isinstance(node.value, list):
        for place, item in enumerate(node.value):
            lines[*key_path, place] = item.line
        return [expanded(item, (*key_path, place), lines, name) for place, item in enumerate(node.value)]
    if isinstance(node.value, dict):
        for key, (line, _) in node.value.items():
            lines[*key_path, key] = line
        return {key: expanded(item, (*key_path, key), lines, name) for key, (_, item) in node.value.items()}
    return node.value
