"""The command line: its arguments, its errors in a sentence each, its exit code."""

from __future__ import annotations

import sys

from cyclopts import CycloptsError

from boresight.cli import conversions  # noqa: F401  its commands are the app's
from boresight.cli.app import app
from boresight.cli.codes import INTERRUPTED
from boresight.cli.consoles import PipedConsole
from boresight.errors import BoresightError


def main() -> None:
    """Runs the command line and exits with its code."""
    try:
        # cyclopts itself would exit with 2, which here means a rejected result.
        code = app(sys.argv[1:], result_action="return_value", exit_on_error=False, console=PipedConsole())
    except CycloptsError:
        code = 1
    except BoresightError as error:
        _say(error)
        code = 1
    except KeyboardInterrupt:
        print("Interrupted; nothing was written.", file=sys.stderr)
        code = INTERRUPTED
    sys.exit(code if isinstance(code, int) else 0)


def _say(error: BoresightError) -> None:
    """Prints an error: one line, or a list of all that is wrong."""
    problems = getattr(error, "problems", (str(error),))
    if len(problems) == 1:
        print(f"Error: {problems[0]}", file=sys.stderr)
        return
    print(f"Error: {len(problems)} problems", file=sys.stderr)
    for problem in problems:
        print(f"  - {problem}", file=sys.stderr)
