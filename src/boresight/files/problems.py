"""Faults of the user's files, gathered so that all of them can be told at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from boresight.errors import InputError

LISTED = 20
"""How many faults one error lists before it only counts."""

_LONGEST_VALUE = 60


class ManyProblems(InputError):
    """Several faults, of which only the first are listed.

    Attributes:
        listed: those in words.
        more: how many others there are.
    """

    def __init__(self, listed: Sequence[str], more: int) -> None:
        super().__init__([*listed, *([f"and {more} more"] if more else [])])
        self.listed, self.more = tuple(listed), more


class Problems:
    """The faults found so far: the first `LISTED` in words, the others counted."""

    def __init__(self) -> None:
        self._listed: list[str] = []
        self._more = 0

    def __bool__(self) -> bool:
        """Whether there is any."""
        return bool(self._listed)

    @property
    def full(self) -> bool:
        """Whether further faults are only counted, so that looking for helpful words is wasted."""
        return len(self._listed) == LISTED

    def add(self, problem: str) -> None:
        """Adds one fault, a sentence."""
        if not self.full:
            self._listed.append(printable(problem))
        else:
            self._more += 1

    def extend(self, problems: Iterable[str]) -> None:
        """Adds several faults."""
        for problem in problems:
            self.add(problem)

    @contextmanager
    def gathered(self) -> Iterator[None]:
        """Returns a context that keeps the faults of an `InputError` raised in it and goes on."""
        try:
            yield
        except ManyProblems as error:
            self.extend(error.listed)
            self._more += error.more
        except InputError as error:
            self.extend(error.problems)

    def raise_if_any(self) -> None:
        """Raises all faults as one `InputError`, if there are any."""
        if self._listed:
            raise ManyProblems(self._listed, self._more)


def printable(text: str) -> str:
    """Returns the text with everything a terminal would not show, or would obey, escaped."""
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)


def shown(value: Any) -> str:
    """Returns a value from a file as a short phrase for a message."""
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return "a block of keys" if value else "an empty block"
    text = repr(value)
    return text if len(text) <= _LONGEST_VALUE else text[: _LONGEST_VALUE - 3] + "..."


def listed(words: Iterable[str]) -> str:
    """Returns words separated by commas, or "none"; a long list is cut short."""
    known = list(words)
    more = f" and {len(known) - LISTED} more" if len(known) > LISTED else ""
    return (", ".join(known[:LISTED]) or "none") + more
