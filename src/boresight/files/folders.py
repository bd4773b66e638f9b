"""Folders of results: checked before anyone waits for them, and filled from a folder that is staged beside them."""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from boresight.errors import OutputError
from boresight.files.writing import PREFIX, uninterrupted


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
    """Yields a temporary folder on the same file system, and removes it; those that killed runs left too."""
    _remove_left_behind(folder)
    staging = Path(tempfile.mkdtemp(prefix=PREFIX, dir=folder))
    try:
        with _held(staging):
            yield staging
    finally:
        shutil.rmtree(staging, ignore_errors=True)


def swap_in(staging: Path, folder: Path, names: Iterable[str], gone: Iterable[str] = ()) -> None:
    """Moves staged files into their folder, without a Ctrl-C in between.

    Args:
        staging: where they lie.
        folder: where they belong.
        names: of the files, in their order.
        gone: names of files that do not belong there any more.
    """
    with uninterrupted(folder):
        for name in gone:
            (folder / name).unlink(missing_ok=True)
        for name in names:
            os.replace(staging / name, folder / name)


def _remove_left_behind(folder: Path) -> None:
    """Removes staged folders that no running process holds."""
    for other in folder.glob(f"{PREFIX}*"):
        if not other.is_dir() or other.is_symlink():
            continue
        with contextlib.suppress(OSError, BlockingIOError), _held(other):
            shutil.rmtree(other, ignore_errors=True)


@contextlib.contextmanager
def _held(folder: Path) -> Iterator[None]:
    """Holds a lock on a folder that dies with the process; raises a BlockingIOError where another process holds it."""
    try:
        import fcntl
    except ImportError:  # on Windows, where what another process works in cannot be removed
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield
    finally:
        os.close(handle)
