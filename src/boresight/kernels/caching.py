"""Compiled functions on disk: checked when they are loaded, made anew where they are damaged, never a reason to fail.

Numba's own cache trusts its files. A file that lost its end (a full disk, a power cut) then ends every later run, and a
place that cannot be written to ends the first one.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import stat
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from numba.core import config
from numba.core.caching import FunctionCache, IndexDataCacheFile

DIGEST = hashlib.sha256
SIZE = DIGEST().digest_size


class CheckedFiles(IndexDataCacheFile):
    """The files of one function: a digest behind each, and what does not match it is not there."""

    def save(self, key: Any, data: Any) -> None:
        """Writes a compiled version; without room for it, it stays in memory."""
        with contextlib.suppress(OSError):
            super().save(key, data)

    def load(self, key: Any) -> Any:
        """Returns a compiled version, None where there is none that is whole."""
        try:
            return super().load(key)
        except Exception:  # whatever a damaged pickle raises
            return None

    def _load_index(self) -> dict[Any, str]:
        try:
            found = super()._load_index()
        except Exception:
            return {}
        return found if isinstance(found, dict) else {}

    def _load_data(self, name: str) -> Any:
        import pickle

        content = Path(self._data_path(name)).read_bytes()
        data, digest = content[:-SIZE], content[-SIZE:]
        if DIGEST(data).digest() != digest:
            raise OSError(f"{name} is damaged")
        return pickle.loads(data)

    def _save_data(self, name: str, data: Any) -> None:
        content = self._dump(data)
        with self._open_for_write(self._data_path(name)) as file:
            file.write(content + DIGEST(content).digest())


class CheckedCache(FunctionCache):
    """Numba's cache of one function, on `CheckedFiles`."""

    def __init__(self, function: Callable[..., Any]) -> None:
        """Raises a RuntimeError where there is no place that can be written to."""
        super().__init__(function)
        self._cache_file = CheckedFiles(
            cache_path=self._cache_path,
            filename_base=self._impl.filename_base,
            source_stamp=self._impl.locator.get_source_stamp(),
        )


def cache_of(function: Callable[..., Any]) -> CheckedCache | None:
    """Returns the cache of a function, in the temporary folder if nowhere else; None where there is no place at all."""
    with contextlib.suppress(RuntimeError, OSError):
        return CheckedCache(function)
    private = _private_folder()
    if private is None:
        return None
    config.CACHE_DIR = str(private)  # type: ignore[attr-defined]
    with contextlib.suppress(RuntimeError, OSError):
        return CheckedCache(function)
    return None


def _private_folder() -> Path | None:
    """Returns a folder of the temporary one that this user alone can write to: what is loaded from it is run."""
    if not hasattr(os, "getuid"):
        return None
    folder = Path(tempfile.gettempdir()) / f"boresight-cache-{os.getuid()}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return None
    own = stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & 0o077
    return folder if own and os.access(folder, os.W_OK) else None
