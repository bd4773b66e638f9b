"""Files that are either written whole or not at all."""

from __future__ import annotations

import os
import secrets
from contextlib import suppress
from pathlib import Path

from boresight.errors import OutputError


def write_atomically(path: Path | str, content: str | bytes) -> None:
    """Returns nothing; the file holds the content, or on failure whatever it held before.

    Raises:
        OutputError: it cannot be written there.
    """
    path = Path(path)
    if path.is_dir():
        raise OutputError(f"{path}: this is a folder; expected the name of a file to write")
    if not path.parent.is_dir():
        raise OutputError(f"{path}: there is no folder {path.parent}; make it first")
    data = content.encode("utf-8") if isinstance(content, str) else content
    # In the same folder, since a rename is atomic only within one file system.
    temporary = path.parent / f".{secrets.token_hex(8)}.tmp"
    try:
        try:
            # Not tempfile: its files are for their owner's eyes only, and results are not.
            with open(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666), "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            os.replace(temporary, path)
        except BaseException:
            with suppress(OSError):
                temporary.unlink()
            raise
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise OutputError(f"{path}: it cannot be written: {reason}") from error
