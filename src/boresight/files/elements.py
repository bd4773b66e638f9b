"""XML as elements that remember their lines and bytes; what only attacks or accidents write is refused.

The standard library's expat tells the byte at which every tag begins, so that numbers can later be replaced in
the file itself. Nothing is fetched and nothing is expanded: a document type or an entity ends the reading.
"""

from __future__ import annotations

import codecs
import re
from contextlib import suppress
from dataclasses import dataclass, field
from xml.parsers import expat

from boresight.errors import InputError
from boresight.files.problems import printable, shown
from boresight.files.sources import Source

DEEPEST = 100
"""Elements within elements; descriptions of robots need ten."""

MOST_ELEMENTS = 200_000
"""A humanoid with hands has some thousands."""

KEPT_DEPTH = 3
"""How deep elements are kept: robot, joint, origin. What is deeper is only counted."""

_BEFORE = re.compile(rb"(?:\xef\xbb\xbf)?\s*")
"""What may stand before a declaration: the mark of UTF-8, and white space."""

_LINE_END = re.compile(rb"\r\n?|\n")

_MISPLACED_DECLARATION = expat.errors.codes[expat.errors.XML_ERROR_MISPLACED_XML_PI]

_ASCII_LIKE = re.compile(r"utf-8|ascii|iso8859-\d+|cp125\d")


@dataclass(frozen=True, slots=True)
class Element:
    """An element of an XML file.

    Attributes:
        name: its tag.
        attributes: their values, as text.
        line: where it begins.
        start: the byte at which its tag begins.
        children: the elements directly in it, as far as they are kept.
    """

    name: str
    attributes: dict[str, str]
    line: int
    start: int
    children: list[Element] = field(default_factory=list)

    def all(self, name: str) -> list[Element]:
        """Returns the children of a name."""
        return [child for child in self.children if child.name == name]


def read_elements(source: Source) -> Element:
    """Returns the root element of an XML file.

    Raises:
        InputError: it is not well-formed, or is of a kind that a robot's description never is.
    """
    try:
        return _Reading(source, source.content).root()
    except InputError:
        lenient = _without_comments(source.content)
        if lenient == source.content:
            raise
        with suppress(InputError):
            return _Reading(source, lenient).root()
        raise


def _without_comments(content: bytes) -> bytes:
    """Returns the bytes with spaces for the text of comments, line ends kept: what stands there is nobody's matter.

    Readers of URDF take two hyphens in a row and letters of any encoding there, which XML does not.
    """
    parts, at = [], 0
    while (start := content.find(b"<!--", at)) >= 0 and (end := content.find(b"-->", start + 4)) >= 0:
        parts += [content[at : start + 4], content[start + 4 : end].translate(_BLANK)]
        at = end
    return b"".join([*parts, content[at:]])


_BLANK = bytes(byte if byte in b"\r\n" else ord(" ") for byte in range(256))


class _Reading:
    def __init__(self, source: Source, content: bytes) -> None:
        self._source = source
        before = _BEFORE.match(content)
        assert before is not None
        # A line that is empty before the declaration is not XML, and every reader of URDF skips it.
        self._content, self._skipped = content[before.end() :], before.end()
        self._lines = len(_LINE_END.findall(before[0]))
        self._open: list[Element] = []
        self._depth = self._count = 0
        self._root: Element | None = None
        self._parser = parser = expat.ParserCreate()
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.XmlDeclHandler = self._declaration
        parser.StartDoctypeDeclHandler = self._doctype

    def root(self) -> Element:
        try:
            self._parser.Parse(self._content, True)
        except expat.ExpatError as error:
            if error.code == _MISPLACED_DECLARATION:
                raise self._refused("<?xml begins here and not at the file's beginning; remove what stands before it",
                                    error.lineno) from None  # fmt: skip
            raise self._refused(f"not valid XML: {expat.ErrorString(error.code)}", error.lineno) from None
        except (LookupError, ValueError) as error:  # pyexpat's own, of encodings
            raise self._refused(f"not valid XML: {error}; save the file as UTF-8") from None
        assert self._root is not None
        return self._root

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        self._depth += 1
        self._count += 1
        if self._depth > DEEPEST:
            raise self._refused(f"elements are nested more than {DEEPEST} deep; expected a description of a robot")
        if self._count > MOST_ELEMENTS:
            raise self._refused(f"more than {MOST_ELEMENTS:,} elements; expected a description of a robot")
        if name.startswith("xacro:"):
            raise self._refused(
                f"<{name[:60]}> is xacro, which URDF is made from; expand it first: "
                f"xacro {self._source.name} > arm.urdf"
            )
        if self._depth > KEPT_DEPTH:
            return
        line, byte = self._parser.CurrentLineNumber + self._lines, self._parser.CurrentByteIndex + self._skipped
        element = Element(name, attributes, line, byte)
        if self._open:
            self._open[-1].children.append(element)
        else:
            self._root = element
        self._open.append(element)

    def _end(self, name: str) -> None:
        if self._depth <= KEPT_DEPTH:
            self._open.pop()
        self._depth -= 1

    def _declaration(self, version: str, encoding: str | None, standalone: int) -> None:
        try:
            known = encoding is None or bool(_ASCII_LIKE.fullmatch(codecs.lookup(encoding).name))
        except LookupError:
            known = False
        if not known:
            raise self._refused(f"the encoding {shown(encoding)} is not read; save the file as UTF-8")

    def _doctype(self, *_: object) -> None:
        raise self._refused(
            "a document type (<!DOCTYPE>) begins here, which may define entities; no URDF needs one: remove it"
        )

    def _refused(self, why: str, line: int | None = None) -> InputError:
        where = self._lines + (self._parser.CurrentLineNumber if line is None else line)
        return InputError(printable(f"{self._source.name}, line {where}: {why}"))
