"""`boresight export`."""

from __future__ import annotations

import sys
from pathlib import Path

from boresight.arm.conventions import Convention
from boresight.cli.consoles import silence_output
from boresight.errors import InputError, OutputError
from boresight.files.problems import printable
from boresight.files.writing import write_atomically
from boresight.report.export import Format, export
from boresight.report.stored import load_result


def run_export(
    result: Path,
    to: Format,
    output: Path | None,
    *,
    convention: Convention | None,
    even_if_rejected: bool,
    overwrite: bool,
) -> int:
    """Returns the exit code of an export, written to a file or to standard output."""
    if convention is not None and to != "dh":
        raise InputError(f"--convention: it is for --to dh, and this is --to {to}")
    if output is not None and output.exists() and not overwrite:
        raise OutputError(f"{output}: is there already; nothing is overwritten without --overwrite")
    stored = load_result(result)
    if not stored.accepted and not even_if_rejected:
        raise InputError(
            f"{stored.folder}: this result was rejected. {' '.join(stored.reasons)} "
            "To export it all the same, add --even-if-rejected"
        )
    exported = export(stored, to, convention, table=output is not None and output.suffix.lower() == ".csv")
    warning = () if stored.accepted else (f"Warning: {stored.folder} was rejected; do not use this arm for work.",)
    for note in (*warning, *exported.notes):
        print(printable(note), file=sys.stderr)
    if output is not None:
        write_atomically(output, exported.content)
        print(printable(f"Wrote {output}"), file=sys.stderr)
    else:
        _print(exported.content)
    return 0


def _print(content: str | bytes) -> None:
    """Prints a file's content to the byte: a URDF's line ends are its own."""
    try:
        sys.stdout.flush()
        sys.stdout.buffer.write(content.encode("utf-8") if isinstance(content, str) else content)
        sys.stdout.buffer.flush()
    except BrokenPipeError:
        silence_output()
