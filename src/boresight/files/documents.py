"""YAML documents as plain data that remember their lines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ruamel.yaml.error import MarkedYAMLError, YAMLError

from boresight.errors import InputError
from boresight.files.composing import Composer, KeyPath, expanded
from boresight.files.problems import Problems, printable
from boresight.files.sources import read_source

LIMIT_MIB = 1


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
        root = Composer(source.content.decode("utf-8-sig"), name, problems).root()
        lines: dict[KeyPath, int] = {(): root.line}
        data = expanded(root, (), lines, name)
    except UnicodeDecodeError as error:
        line = source.content.count(b"\n", 0, error.start) + 1
        raise InputError(printable(f"{name}, line {line}: not UTF-8 text; save the file as UTF-8")) from None
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = mark.line + 1 if mark else 1
        said = ", ".join(part for part in (error.context, error.problem) if part)
        raise InputError(printable(f"{name}, line {line}: not valid YAML: {said}")) from None
    except OverflowError:  # of ruamel's scanner
        raise InputError(
            printable(f"{name}: not valid YAML: an escape such as \\UFFFFFFFF names no character")
        ) from None
    except (YAMLError, ValueError, AttributeError) as error:  # the last two escape from ruamel's scanner
        said = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError(printable(f"{name}: not valid YAML: {said}")) from None
    problems.raise_if_any()
    return Document(Path(path), name, data, lines, source.sha256)
