"""Folders of results: checked before anyone waits for them, and filled from a folder that is staged beside them."""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from boresight.errors import OutputError


def check_folder(folder: Path, what: str, ours: Iterable[str], is_ours: Callable[[Path], bool], called: str) -> None:
    """Checks that a folder can be written, and that nothing foreign would be overwritten.

    Args:
        folder: where to write; it need not exist.
        what: is written there, for messages: "result".
        ours: names of the files and folders that would be replaced.
        is_ours: whether the folder holds what we wrote earlier.
        called: what that is called, for messages: "Boresight result".

    Raises:
        OutputError: it cannot, or the folder holds files of these names that are not ours.
    """
    if folder.exists() and not folder.is_dir():
        raise OutputError(f"{folder}: is a file; name a folder for the {what} with -o")
    existing = next(parent for parent in (folder, *folder.absolute().parents) if parent.exists())
    if not existing.is_dir() or not os.access(existing, os.W_OK | os.X_OK):
        raise OutputError(f"{folder}: cannot be written; name another folder for the {what} with -o")
    taken = [name for name in ours if (folder / name).exists()]
    if taken and not is_ours(folder):
        raise OutputError(
            f"{folder}: holds {', '.join(taken)} but no {called}; nothing is overwritten: name another folder with -o"
        )


@contextlib.contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """Yields a temporary folder on the same file system, and removes it."""
    staging = Path(tempfile.mkdtemp(prefix=".boresight-", dir=folder))
    try:
        yield staging
    finally:
        shutil.rmtree(staging, ignore_errors=True)
