"""The bytes of a file that was asked for, or a sentence on why there are none."""

from __future__ import annotations

import hashlib
import os
import stat
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from boresight.errors import InputError, did_you_mean
from boresight.files.problems import printable


@dataclass(frozen=True)
class Source:
    """A file's content.

    Attributes:
        path: where it is.
        name: what the user calls it, for messages.
        content: its bytes.
    """

    path: Path
    name: str
    content: bytes

    @cached_property
    def sha256(self) -> str:
        """The content's SHA-256, in hexadecimal digits."""
        return hashlib.sha256(self.content).hexdigest()


def read_source(
    path: Path, name: str, *, kind: str, limit_mib: int, mend: str, named_by: str = "", binary: bool = False
) -> Source:
    """Returns a file's content.

    Args:
        path: where it is.
        name: what the user calls it.
        kind: what it should be, for messages: "a YAML file".
        limit_mib: larger files are refused before a byte is read.
        mend: what to do about a file that is too large.
        named_by: the place that names the file, as the beginning of a sentence.
        binary: whether it is anything but text.

    Raises:
        InputError: it is missing, not a regular file, not readable, too large, or not text.
    """

    def refused(why: str) -> InputError:
        return InputError(printable(f"{named_by}{name}: {why}"))

    try:
        found = os.stat(path)
        # A pipe or a device is never opened: reading one could wait for ever.
        if stat.S_ISDIR(found.st_mode):
            raise refused(f"this is a folder; expected {kind}")
        if not stat.S_ISREG(found.st_mode):
            raise refused(f"this is not a regular file; expected {kind}")
        if found.st_size > limit_mib * 2**20:
            size = found.st_size / 2**20
            raise refused(f"the file has {size:,.0f} MiB; expected {kind} of at most {limit_mib} MiB: {mend}")
        with open(path, "rb") as file:
            content = file.read(limit_mib * 2**20)
    except FileNotFoundError:
        raise refused(f"there is no such file{_nearest(path)}; expected {kind}") from None
    except PermissionError:
        raise refused("reading it is not permitted; give yourself the right to read it") from None
    except (OSError, ValueError) as error:  # ValueError: a name with a NUL or a lone surrogate
        reason = error.strerror if isinstance(error, OSError) and error.strerror else "no file can be called that"
        raise refused(f"it cannot be read: {reason}; expected {kind}") from None
    if not binary and b"\0" in content:
        raise refused(f"the file is binary or UTF-16, it holds NUL bytes; expected {kind} in UTF-8 text")
    return Source(path, name, content)


def _nearest(path: Path) -> str:
    """What stands in the place of a missing file."""
    folder = path.parent
    if not folder.is_dir():
        return f" (nor a folder {folder.name})"
    try:
        # Sorted, and no more than a person could mean: a folder may hold a million files.
        names = sorted(entry.name for _, entry in zip(range(1000), os.scandir(folder), strict=False) if entry.is_file())
    except OSError:
        return ""
    return did_you_mean(path.name, names)
