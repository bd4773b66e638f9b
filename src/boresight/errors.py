"""What can go wrong on the user's side, in words the user can act on.

Everything the package raises on purpose is a `BoresightError`; the command line prints its text and exits
with 1. A search that stops early, or a calibration that is rejected, is an outcome, not an error.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence


class BoresightError(Exception):
    """Any failure that the caller can mend; its text says how."""


class InputError(BoresightError):
    """One or more faults in what was given, all of them at once.

    Attributes:
        problems: one sentence or short paragraph each.
    """

    def __init__(self, problems: str | Sequence[str]) -> None:
        self.problems = (problems,) if isinstance(problems, str) else tuple(problems)
        super().__init__("\n".join(self.problems))


class OutputError(BoresightError):
    """A result cannot be written where it was asked for."""


def did_you_mean(given: str, known: Iterable[str]) -> str:
    """Returns " (did you mean X?)" for the nearest known word, or "" where none is near."""
    near = difflib.get_close_matches(given, list(known), n=1, cutoff=0.5)
    return f" (did you mean {near[0]}?)" if near else ""
