"""Where the commands print: a reader who has seen enough may close the pipe, and nothing has gone wrong.

A closed standard output is no reason to fail, a full one is told; what an encoding lacks is written as an escape.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator
from typing import Any, NoReturn

from rich.console import Console
from rich.segment import Segment

from boresight.errors import OutputError


class PipedConsole(Console):
    """A console that falls silent where its reader leaves, so that the exit code stays that of the work done."""

    def on_broken_pipe(self) -> None:
        """Sends what is still to come nowhere; rich would exit with 1, which here means an error in input."""
        self.quiet = True
        silence_output()

    def render(self, renderable: Any, options: Any = None) -> Iterator[Segment]:
        """Yields what is printed, with characters that a terminal would obey written as escapes.

        Names of files, topics and sessions may hold any.
        """
        for segment in super().render(renderable, options):
            text = segment.text
            if segment.control or text.isprintable() or all(c.isprintable() or c == "\n" for c in text):
                yield segment
            else:
                shown = "".join(c if c.isprintable() or c == "\n" else ascii(c)[1:-1] for c in text)
                yield Segment(shown, segment.style, segment.control)

    def print(self, *objects: Any, **options: Any) -> None:
        """Prints as rich does.

        Raises:
            OutputError: standard output takes no more.
        """
        try:
            super().print(*objects, **options)
        except BrokenPipeError:
            self.on_broken_pipe()
        except OSError as error:
            self.quiet = True
            _refuse(error)


def print_plain(text: str) -> None:
    """Prints text for programs, as it stands.

    Raises:
        OutputError: standard output takes no more.
    """
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except BrokenPipeError:
        silence_output()
    except OSError as error:
        _refuse(error)


def print_json(text: str) -> None:
    """Prints a JSON document, in ASCII where standard output is not in UTF-8.

    Raises:
        OutputError: standard output takes no more.
    """
    if (sys.stdout.encoding or "").lower().replace("-", "") != "utf8" and not text.isascii():
        text = json.dumps(json.loads(text), indent=2) + "\n"
    print_plain(text)


def prepare_output() -> None:
    """Makes standard streams that are closed or narrow ones that can be written to.

    A closed one is opened onto nothing: the next file that is opened would otherwise take its place.
    """
    for name in ("stdin", "stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "r" if name == "stdin" else "w"))  # noqa: SIM115  for good
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")


def _refuse(error: OSError) -> NoReturn:
    silence_output()
    raise OutputError(
        f"standard output: {error.strerror or error}; files that the command names were written"
    ) from None


def silence_output() -> None:
    """Sends standard output nowhere from now on; Python's own flush at exit would complain of the closed pipe."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
