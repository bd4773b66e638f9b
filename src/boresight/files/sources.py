"""The bytes of a file that was asked for, or a sentence on why there are none."""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import BinaryIO

from boresight.errors import InputError, did_you_mean
from boresight.files.problems import printable
from boresight.files.signatures import LENGTH, signature_of

_MIB = 2**20


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


@dataclass(frozen=True)
class Complaint:
    """Who is complained about, and what was expected instead.

    Attributes:
        path: where the file is.
        name: the place that names it, if any, and what the user calls it.
        kind: what it should be: "a YAML file".
    """

    path: Path
    name: str
    kind: str

    def refused(self, why: str) -> InputError:
        """Returns the error that says why the file is of no use."""
        return InputError(printable(f"{self.name}: {why}"))

    def not_text(self) -> InputError:
        """Returns the error for a file with NUL bytes."""
        return self.refused(f"the file is binary or UTF-16, it holds NUL bytes; expected {self.kind} in UTF-8 text")

    def check_signature(self, beginning: bytes, read: Collection[str] = ()) -> None:
        """Checks that a file is not of a kind that its first bytes tell, such as a ZIP archive or a Git LFS pointer.

        Args:
            beginning: its first bytes.
            read: kinds that are read nevertheless, as `signature_of` calls them.

        Raises:
            InputError: it is of another kind.
        """
        found = signature_of(beginning[:LENGTH], self.path.name)
        if found is not None and found.kind not in read:
            raise self.refused(f"this is {found.kind}; expected {self.kind}: {found.mend}")

    @contextmanager
    def of_reading(self) -> Iterator[None]:
        """Returns a context in which what the system refuses is told in words.

        Raises:
            InputError: the file is missing, or the system does not let it be read.
        """
        try:
            yield
        except FileNotFoundError:
            raise self.refused(f"there is no such file{_nearest(self.path)}; expected {self.kind}") from None
        except PermissionError:
            raise self.refused("reading it is not permitted; give yourself the right to read it") from None
        except OSError as error:
            raise self.refused(f"it cannot be read: {error.strerror or error}; expected {self.kind}") from None

    def opened(self, limit_mib: int, mend: str) -> BinaryIO:
        """Returns the file, open for reading.

        Args:
            limit_mib: larger files are refused before a byte is read.
            mend: what to do about a file that is too large.

        Raises:
            InputError: it is missing, not a regular file, not readable, or too large.
        """
        with self.of_reading():
            try:
                found = os.stat(self.path)
            except ValueError:  # a name with a NUL or a lone surrogate
                raise self.refused(f"it cannot be read: no file can be called that; expected {self.kind}") from None
            # A pipe or a device is never opened: reading one could wait for ever.
            if stat.S_ISDIR(found.st_mode):
                raise self.refused(f"this is a folder; expected {self.kind}")
            if not stat.S_ISREG(found.st_mode):
                raise self.refused(f"this is not a regular file; expected {self.kind}")
            if found.st_size > limit_mib * _MIB:
                size = found.st_size / _MIB
                raise self.refused(
                    f"the file has {size:,.0f} MiB; expected {self.kind} of at most {limit_mib} MiB: {mend}"
                )
            return open(self.path, "rb")


@dataclass(frozen=True)
class OpenSource:
    """A file that is open for reading, for those that are too large to be held.

    Attributes:
        name: what the user calls it, for messages.
        file: at its beginning.
        sha256: of its content, in hexadecimal digits.
        is_text: whether it holds no NUL bytes.
        complaint: how to complain about it.
    """

    name: str
    file: BinaryIO
    sha256: str
    is_text: bool
    complaint: Complaint


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
    complaint = Complaint(path, f"{named_by}{name}", kind)
    with complaint.opened(limit_mib, mend) as file, complaint.of_reading():
        content = file.read(limit_mib * _MIB)
    complaint.check_signature(content)
    if not binary and b"\0" in content:
        raise complaint.not_text()
    return Source(path, name, content)


@contextmanager
def open_source(
    path: Path,
    name: str,
    *,
    kind: str,
    limit_mib: int,
    mend: str,
    named_by: str = "",
    read: Collection[str] = (),
) -> Iterator[OpenSource]:
    """Returns a context with a file whose digest is known, and which is the same file when the context ends.

    Args:
        path: where it is.
        name: what the user calls it.
        kind: what it should be, for messages: "a CSV file".
        limit_mib: larger files are refused before a byte is read.
        mend: what to do about a file that is too large.
        named_by: the place that names the file, as the beginning of a sentence.
        read: kinds of file that are read beside text, as `signature_of` calls them.

    Raises:
        InputError: it is missing, not a regular file, not readable, too large, of another kind, or was written to
            meanwhile.
    """
    complaint = Complaint(path, f"{named_by}{name}", kind)
    with complaint.opened(limit_mib, mend) as file:
        before, digest, is_text = os.fstat(file.fileno()), hashlib.sha256(), True
        with complaint.of_reading():
            complaint.check_signature(file.read(LENGTH), read)
            file.seek(0)
            while block := file.read(_MIB):
                digest.update(block)
                is_text = is_text and b"\0" not in block
            file.seek(0)
        yield OpenSource(name, file, digest.hexdigest(), is_text, complaint)
        after = os.fstat(file.fileno())
        if (before.st_size, before.st_mtime_ns) != (after.st_size, after.st_mtime_ns):
            raise complaint.refused("it was written to while it was read; try again when it is complete")


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
