"""Names that users give, written so that no format reads them as anything else."""

from __future__ import annotations

import json
import re

from boresight.files.problems import printable

_PLAIN_KEY = re.compile(r"[A-Za-z_][A-Za-z0-9_/-]*", re.ASCII)
_WORDS = {"y", "n", "yes", "no", "on", "off", "true", "false", "null"}
_FORMULA = ("=", "+", "-", "@")


def yaml_quoted(name: str) -> str:
    """Returns a name in quotes: YAML 1.2 holds JSON, so a quoted name is itself, whatever it looks like."""
    quoted = json.dumps(name, ensure_ascii=False)
    return "".join(c if c.isprintable() else f"\\u{ord(c):04x}" for c in quoted)


def yaml_key(name: str) -> str:
    """Returns a name as a key, in quotes where YAML would read it as anything but itself."""
    plain = _PLAIN_KEY.fullmatch(name) and name.lower() not in _WORDS
    return name if plain else yaml_quoted(name)


def comment_lines(text: str) -> list[str]:
    """Returns the lines of a comment, characters that a format may not hold written as escapes."""
    return [printable(line).rstrip() for line in text.splitlines()]


def xml_comment(text: str) -> str:
    """Returns a comment's text for XML, whose comments end at two hyphens and hold no control characters."""
    return re.sub(r"-(?=-)", "- ", "\n".join(comment_lines(text)))


def csv_word(name: str) -> str:
    """Returns a name as the cell of a table for people: spreadsheets would run one that begins like a formula."""
    return f"'{name}" if name.startswith(_FORMULA) else name
