"""The command line: its arguments, its errors in a sentence each, its exit code."""

from __future__ import annotations

import os
import sys

from cyclopts import CycloptsError

from boresight import __version__
from boresight.cli import conversions  # noqa: F401  its commands are the app's
from boresight.cli.app import app
from boresight.cli.codes import INTERRUPTED
from boresight.cli.consoles import PipedConsole, prepare_output
from boresight.errors import BoresightError

TRACEBACK = "BORESIGHT_TRACEBACK"
"""The environment variable that shows where a defect lies."""


def main() -> None:
    """Runs the command line and exits with its code."""
    prepare_output()
    if writing := sys.modules.get("boresight.files.writing"):
        writing.begin()
    try:
        # cyclopts itself would exit with 2, which here means a rejected result.
        code = app(sys.argv[1:], result_action="return_value", exit_on_error=False, console=PipedConsole())
    except CycloptsError:
        code = 1
    except BoresightError as error:
        _say(error)
        code = 1
    except KeyboardInterrupt:
        print(_interrupted(), file=sys.stderr)
        code = INTERRUPTED
    except OSError as error:  # of a folder that one may not enter, or a name that no file can have
        _say(BoresightError(f"{error.filename or 'a file'}: {error.strerror or error}"))
        code = 1
    except Exception as error:  # a defect, of which the user has no use for the traceback
        if os.environ.get(TRACEBACK):
            raise
        _say(BoresightError(_defect(error)))
        code = 1
    sys.exit(code if isinstance(code, int) else 0)


def _interrupted() -> str:
    from boresight.files.writing import written

    paths = list(dict.fromkeys(map(str, written())))
    return f"Interrupted, after {paths[-1]} was written." if paths else "Interrupted; nothing was written."


def _defect(error: Exception) -> str:
    """Returns the sentence that says that Boresight, and not its input, is at fault."""
    from boresight.files.problems import printable  # which brings all that reads files with it

    what = printable(f"{type(error).__name__}: {error}")[:300]
    return (
        f"this is a defect of Boresight {__version__}, not of your files ({what}); please report it with the command, "
        f"the files, and what is printed with {TRACEBACK}=1 set"
    )


def _say(error: BoresightError) -> None:
    """Prints an error: one line, or a list of all that is wrong."""
    from boresight.files.problems import printable

    problems = [printable(problem) for problem in getattr(error, "problems", (str(error),))]
    if len(problems) == 1:
        print(f"Error: {problems[0]}", file=sys.stderr)
        return
    print(f"Error: {len(problems)} problems", file=sys.stderr)
    for problem in problems:
        print(f"  - {problem}", file=sys.stderr)
