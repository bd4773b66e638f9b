"""Which files a bag consists of, and how each is read."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path
from tempfile import TemporaryDirectory, gettempdir
from typing import Any, BinaryIO

from boresight.errors import InputError
from boresight.files.bags.database import read_database
from boresight.files.bags.inflating import inflate_file
from boresight.files.bags.mcap import read_mcap
from boresight.files.bags.tape import Tape
from boresight.files.documents import read_document
from boresight.files.problems import printable
from boresight.files.signatures import LENGTH, MCAP, ROS1, SQLITE, ZSTD, signature_of

SUFFIXES = (".mcap", ".db3", ".mcap.zstd", ".db3.zstd")
LARGEST_INFLATED, LARGEST_RATIO, ALWAYS = 64 * 2**30, 200, 256 * 2**20
"""Bytes that a compressed file may unpack to at most, times its own size where that is more than a few; recordings of
sensors shrink to a half or a tenth."""

_METADATA = "metadata.yaml"


def is_bag(path: Path) -> bool:
    """Whether a path is a bag rather than a CSV file: a folder, or a file with a bag's ending or first bytes."""
    if path.is_dir() or path.name.lower().endswith(SUFFIXES):
        return True
    try:
        # A pipe or a device is never opened: reading one could wait for ever.
        if not path.is_file():
            return False
        with open(path, "rb") as file:
            return file.read(len(SQLITE)).startswith((MCAP, SQLITE, ROS1))
    except (OSError, ValueError):  # whoever reads it says why it cannot be read
        return False


def files_of(path: Path, name: str, tape: Tape) -> list[Path]:
    """Returns the files of a bag in the order of recording; a loss is noted for those that are missing.

    Raises:
        InputError: there is no bag.
    """
    if path.name == _METADATA:
        path = path.parent
    if path.is_file():
        return [path]
    if not path.is_dir():
        raise InputError(f"{name}: there is no such file or folder; expected a rosbag2 folder or an .mcap file")
    found = sorted((p for p in path.iterdir() if p.name.lower().endswith(SUFFIXES) and p.is_file()), key=_by_number)
    if not found and (old := sorted(p for p in path.iterdir() if p.suffix.lower() == ".bag" and p.is_file())):
        return old  # of ROS 1, which reading them tells
    if not found:
        raise InputError(
            f"{name}: there is no {' or '.join(SUFFIXES[:2])} file in this folder; expected a rosbag2 folder"
        )
    there = {file.name for file in found}
    for missing in [file for file in _listed(path, name, tape) if file not in there]:
        tape.lose(f"{name}: {_METADATA} lists {missing}, which is not there")
    return found


def read_storage(path: Path, name: str, tape: Tape) -> None:
    """Returns nothing; the tape gets what one file of a bag holds. Its first bytes tell its kind."""
    with open(path, "rb") as file:
        beginning = file.read(LENGTH)
        file.seek(0)
        if beginning.startswith(MCAP):
            return read_mcap(file, name, tape)
        if beginning.startswith(SQLITE):
            return read_database(path, name, tape)
        if beginning.startswith(ZSTD):
            return _read_compressed(file, path, name, tape)
    wanted = f"expected a ROS 2 bag, whose files end in {' or '.join(SUFFIXES[:2])}"
    found = signature_of(beginning, name)
    if found is not None:
        raise InputError(printable(f"{name}: this is {found.kind}; {wanted}: {found.mend}"))
    kind = "is empty" if not beginning else "is neither MCAP nor SQLite"
    raise InputError(f"{name}: the file {kind}; {wanted}")


def _read_compressed(file: BinaryIO, path: Path, name: str, tape: Tape) -> None:
    """Gives the tape what a compressed file holds, unpacked in the temporary folder.

    Raises:
        InputError: there is no room for it, or it unpacks to far more than a recording does.
    """
    size = path.stat().st_size
    limit = min(LARGEST_INFLATED, max(ALWAYS, LARGEST_RATIO * size))
    with TemporaryDirectory() as folder:
        inflated = Path(folder) / path.stem
        try:
            with open(inflated, "wb") as target:
                found = inflate_file(file, target, limit)
        except OSError as error:
            raise InputError(
                f"{name}: it cannot be unpacked in {gettempdir()}: {error.strerror or error}; make room there, or name "
                "another folder in TMPDIR"
            ) from None
        if found == "too large":
            raise InputError(
                f"{name}: it unpacks to more than {limit / 2**20:,.0f} MiB, {limit / max(size, 1):,.0f} times its size "
                "and more than recordings do; if it is right, unpack it by hand: zstd -d"
            )
        if found == "broken":
            tape.lose(f"{name}: the compressed file breaks off or is damaged; what came before was read")
        with open(inflated, "rb") as again:
            if again.read(4) == ZSTD:
                raise InputError(f"{name}: the file is compressed twice")
        read_storage(inflated, name, tape)


def digest(files: list[Path]) -> str:
    """Returns the SHA-256 of a bag: of its file, or of its files' digests one after the other."""
    each = []
    for path in files:
        with open(path, "rb") as file:
            each.append(hashlib.file_digest(file, "sha256").hexdigest())
    return each[0] if len(each) == 1 else hashlib.sha256("".join(each).encode()).hexdigest()


def _by_number(path: Path) -> list[Any]:
    """Sorts run_10.mcap behind run_9.mcap."""
    return [(0, int(part), "") if part.isdigit() else (1, 0, part) for part in re.split(r"(\d+)", path.name)]


def _listed(folder: Path, name: str, tape: Tape) -> list[str]:
    """Returns the names of the files that a bag's metadata lists; none where it cannot be read."""
    path = folder / _METADATA
    if not path.exists():
        tape.lose(f"{name}: there is no {_METADATA}, as where a recording was killed; the files were read without it")
        return []
    try:
        data = read_document(path, f"{name}/{_METADATA}").data
        listed = data["rosbag2_bagfile_information"]["relative_file_paths"]
        return [Path(str(file)).name for file in listed]
    except (InputError, KeyError, TypeError):
        tape.lose(f"{name}: {_METADATA} makes no sense; the files were read without it")
        return []
