"""Files that are either written whole or not at all."""

from __future__ import annotations

import os
import secrets
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from boresight.errors import OutputError

PREFIX = ".boresight-"
"""How temporary files and folders are called."""

LONG_AGO_S = 3600.0
"""No file takes longer to write."""


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
    _remove_left_behind(path.parent)
    temporary = path.parent / f"{PREFIX}{secrets.token_hex(8)}.tmp"
    try:
        try:
            # Not tempfile: its files are for their owner's eyes only, and results are not.
            with open(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666), "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            with uninterrupted(path):
                os.replace(temporary, path)
        except BaseException:
            with suppress(OSError):
                temporary.unlink()
            raise
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise OutputError(f"{path}: it cannot be written: {reason}") from error


@contextmanager
def uninterrupted(what: Path) -> Iterator[None]:
    """Holds Ctrl-C back until what is being renamed is whole; from then on `written` tells of it.

    Args:
        what: the file or folder that is written.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        _WRITTEN.append(what)
        return
    came: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: came.append(number))
    try:
        yield
        _WRITTEN.append(what)
    finally:
        signal.signal(signal.SIGINT, signal.SIG_DFL if before is None else before)
        if came:
            signal.raise_signal(signal.SIGINT)


def written() -> tuple[Path, ...]:
    """Returns the files and folders that this process has written."""
    return tuple(_WRITTEN)


def begin() -> None:
    """Forgets what was written before: a command begins."""
    _WRITTEN.clear()


_WRITTEN: list[Path] = []


def _remove_left_behind(folder: Path) -> None:
    """Removes temporary files that killed processes left more than an hour ago."""
    for other in folder.glob(f"{PREFIX}*.tmp"):
        with suppress(OSError):
            if other.is_file() and time.time() - other.stat().st_mtime > LONG_AGO_S:
                other.unlink()
