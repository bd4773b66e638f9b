"""YAML documents as plain data that remember their lines.

Only ruamel's event stream is used: no object is ever constructed from a tag, and a file's size, nesting
and alias expansion are bounded while it is read, before it can cost more than it is worth.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML, events
from ruamel.yaml.error import MarkedYAMLError, YAMLError

from boresight.errors import InputError
from boresight.files.problems import Problems, printable, shown
from boresight.files.scalars import TAGS, plain_scalar
from boresight.files.sources import read_source

KeyPath = tuple[str | int, ...]

LIMIT_MIB = 10
DEEPEST = 50
MOST_VALUES = 100_000


@dataclass(frozen=True, slots=True)
class Document:
    """A YAML file's content.

    Attributes:
        path: where the file is.
        name: what the user calls it.
        data: dicts, lists, text, numbers, booleans and None.
        lines: the line of every key and list item.
        sha256: of the file.
    """

    path: Path
    name: str
    data: Any
    lines: Mapping[KeyPath, int]
    sha256: str

    def line_of(self, key_path: KeyPath) -> int:
        """Returns the line of a key or list item; for one that is not there, that of the nearest it would be in."""
        while key_path not in self.lines:
            key_path = key_path[:-1]
        return self.lines[key_path]

    def at(self, key_path: KeyPath) -> str:
        """Returns the beginning of a message: `campaign.yaml, line 7: targets.deck.normal: `."""
        keys = "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in key_path).removeprefix(".")
        return f"{self.name}, line {self.line_of(key_path)}: {keys + ': ' if keys else ''}"


@dataclass(frozen=True, slots=True)
class _Node:
    """A value as written: text or a scalar, a list of nodes, or keys with their lines and nodes."""

    line: int
    value: Any


def read_document(path: Path | str, name: str | None = None, named_by: str = "") -> Document:
    """Returns the content of a YAML file.

    Args:
        path: where it is.
        name: what the user calls it; the path as given by default.
        named_by: the place that names the file, as the beginning of a sentence.

    Raises:
        InputError: it cannot be read, or is not one small document of plain data.
    """
    name = str(path) if name is None else name
    source = read_source(
        Path(path),
        name,
        kind="a YAML file",
        limit_mib=LIMIT_MIB,
        mend="readings belong in a CSV file",
        named_by=named_by,
    )
    problems = Problems()
    try:
        root = _Composer(source.content.decode("utf-8-sig"), name, problems).root()
        lines: dict[KeyPath, int] = {(): root.line}
        data = _expanded(root, (), lines, name)
    except UnicodeDecodeError as error:
        line = source.content.count(b"\n", 0, error.start) + 1
        raise InputError(printable(f"{name}, line {line}: not UTF-8 text; save the file as UTF-8")) from None
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = mark.line + 1 if mark else 1
        said = ", ".join(part for part in (error.context, error.problem) if part)
        raise InputError(printable(f"{name}, line {line}: not valid YAML: {said}")) from None
    except (YAMLError, ValueError, AttributeError) as error:  # the last two escape from ruamel's scanner
        said = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError(printable(f"{name}: not valid YAML: {said}")) from None
    problems.raise_if_any()
    return Document(Path(path), name, data, lines, source.sha256)


class _Composer:
    """Turns an event stream into nodes, once."""

    def __init__(self, text: str, name: str, problems: Problems) -> None:
        self._events: Iterator[Any] = YAML(typ="safe", pure=True).parse(text)
        self._name = name
        self._problems = problems
        self._anchors: dict[str, _Node | None] = {}
        self._count = 0

    def root(self) -> _Node:
        """Returns the only document's node; an empty one's value is None."""
        root = None
        for event in self._events:
            if isinstance(event, events.DocumentStartEvent) and root is not None:
                raise self._refused(event, "a second document begins here; expected one document in a file")
            if isinstance(event, events.NodeEvent):
                root = self._node(event, 0)
        return root or _Node(1, None)

    def _node(self, event: Any, depth: int) -> _Node:
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
            node = _Node(line, self._scalar(event))
        elif isinstance(event, events.SequenceStartEvent):
            self._refuse_tag(event, "tag:yaml.org,2002:seq")
            node = _Node(line, [self._node(item, depth + 1) for item in self._until(events.SequenceEndEvent)])
        else:
            self._refuse_tag(event, "tag:yaml.org,2002:map")
            node = _Node(line, self._keys(depth))
        if event.anchor is not None:
            self._anchors[event.anchor] = node
        return node

    def _until(self, end: type) -> Iterator[Any]:
        for event in self._events:
            if isinstance(event, end):
                return
            yield event

    def _keys(self, depth: int) -> dict[str, tuple[int, _Node]]:
        keys: dict[str, tuple[int, _Node]] = {}
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

    def _alias(self, event: Any) -> _Node:
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


def _expanded(node: _Node, key_path: KeyPath, lines: dict[KeyPath, int], name: str) -> Any:
    """Returns a node's plain data, aliases written out, and notes the line of every part."""
    if len(lines) > MOST_VALUES or len(key_path) > DEEPEST:
        raise InputError(printable(f"{name}, line {node.line}: its aliases, written out, are too many or too deep"))
    if isinstance(node.value, list):
        for place, item in enumerate(node.value):
            lines[*key_path, place] = item.line
        return [_expanded(item, (*key_path, place), lines, name) for place, item in enumerate(node.value)]
    if isinstance(node.value, dict):
        for key, (line, _) in node.value.items():
            lines[*key_path, key] = line
        return {key: _expanded(item, (*key_path, key), lines, name) for key, (_, item) in node.value.items()}
    return node.value
