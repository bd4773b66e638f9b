"""Where the commands print: a reader who has seen enough may close the pipe, and nothing has gone wrong."""

from __future__ import annotations

import os
import sys

from rich.console import Console


class PipedConsole(Console):
    """A console that falls silent where its reader leaves, so that the exit code stays that of the work done."""

    def on_broken_pipe(self) -> None:
        """Sends what is still to come nowhere; rich would exit with 1, which here means an error in input."""
        self.quiet = True
        silence_output()


def print_plain(text: str) -> None:
    """Prints text for programs, as it stands."""
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except BrokenPipeError:
        silence_output()


def silence_output() -> None:
    """Sends standard output nowhere from now on; Python's own flush at exit would complain of the closed pipe."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
