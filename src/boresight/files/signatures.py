"""What a file is, told by its first bytes: for saying so where it is not what was expected."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from pathlib import PurePath

LENGTH = 4096
"""Bytes of a file's beginning that tell what it is."""

MCAP, SQLITE, ZSTD, PARQUET = b"\x89MCAP0\r\n", b"SQLite format 3\0", b"\x28\xb5\x2f\xfd", b"PAR1"
ROS1 = b"#ROSBAG V"

_UNPACK = "unpack it first"
_SAVE = "export what it holds as CSV in UTF-8"
_CONVERT = "rosbags-convert --src {bag} --dst {stem}"
_ANOTHER = "name another file"

_BEGINNINGS: tuple[tuple[bytes, str, str], ...] = (
    (b"version https://git-lfs.github.com/spec/", "a Git LFS pointer, not the file itself", "fetch it: git lfs pull"),
    (b"/annex/objects/", "a git-annex pointer, not the file itself", "fetch it: git annex get {file}"),
    (ROS1 + b"2.0", "a ROS 1 bag", f"{{as_bag}}make a ROS 2 bag of it and name that: {_CONVERT}"),
    (ROS1, "a ROS 1 bag of an old version", "let ROS 1 bring it up to date first: rosbag fix {file} {stem}-2.bag"),
    (MCAP, "an MCAP file", _ANOTHER),
    (SQLITE, "a SQLite database", _ANOTHER),
    (b"PK\x05\x06", "an empty ZIP archive", _ANOTHER),
    (b"\x1f\x8b", "a gzip file", f"{_UNPACK}: gunzip -k {{file}}"),
    (b"\xfd7zXZ\0", "an xz file", f"{_UNPACK}: unxz -k {{file}}"),
    (b"\x04\x22\x4d\x18", "an LZ4 file", f"{_UNPACK}: unlz4 {{file}}"),
    (ZSTD, "a Zstandard file", f"{_UNPACK}: unzstd {{file}}"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive", f"{_UNPACK}: 7z x {{file}}"),
    (b"Rar!\x1a\x07", "a RAR archive", _UNPACK),
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "an old Office document (xls, doc)", _SAVE),
    (b"%PDF-", "a PDF document", _SAVE),
    (b"{\\rtf", "a rich text document", _SAVE),
    (b"\x89HDF\r\n\x1a\n", "an HDF5 file", _SAVE),
    (b"MATLAB 5.0 MAT-file", "a MATLAB file", _SAVE),
    (b"\x93NUMPY", "a NumPy array", _SAVE),
    (b"ARROW1\0\0", "an Arrow file", f"{_SAVE} or as Parquet"),
    (b"\x89PNG\r\n\x1a\n", "a PNG picture", _ANOTHER),
    (b"\xff\xd8\xff", "a JPEG picture", _ANOTHER),
    (b"GIF89a", "a GIF picture", _ANOTHER),
    (b"\x7fELF", "a program", _ANOTHER),
)

_UTF16, _UTF32 = (b"\xff\xfe", b"\xfe\xff"), (b"\xff\xfe\0\0", b"\0\0\xfe\xff")
_HTML = (b"<!doctype html", b"<html")


@dataclass(frozen=True, slots=True)
class Signature:
    """What a file is.

    Attributes:
        kind: with its article: "a gzip file".
        mend: what to do about it, an imperative.
    """

    kind: str
    mend: str


def signature_of(beginning: bytes, name: str) -> Signature | None:
    """Returns what a file is by its first bytes; None for plain text and for what is not known.

    Args:
        beginning: its first bytes, `LENGTH` of them where there are as many.
        name: what the user calls it, for the commands that deal with it.
    """
    if is_parquet(beginning):
        return Signature("a Parquet file", _SAVE)
    if beginning.startswith(b"BZh") and beginning[4:10] == b"1AY&SY":
        return Signature("a bzip2 file", _completed(f"{_UNPACK}: bunzip2 -k {{file}}", name))
    for start, kind, mend in _BEGINNINGS:
        # A comment of a CSV file may begin as a ROS 1 bag does, but holds no NUL bytes.
        if beginning.startswith(start) and (start[:1] != b"#" or b"\0" in beginning):
            return Signature(kind, _completed(mend, name))
    if beginning.startswith(b"PK\x03\x04"):
        return _zip(beginning)
    if beginning[257:262] == b"ustar":
        return Signature("a tar archive", _completed(f"{_UNPACK}: tar xf {{file}}", name))
    if beginning.startswith(_UTF16 + _UTF32):
        wide = "UTF-32" if beginning.startswith(_UTF32) else "UTF-16"
        return Signature(f"text in {wide}", "save it as UTF-8")
    if beginning.lstrip(b"\xef\xbb\xbf \t\r\n").lower().startswith(_HTML):
        return Signature("a web page (HTML)", "download the file itself, not the page that shows it")
    return None


def is_parquet(beginning: bytes) -> bool:
    """Returns whether a file is Parquet by its first bytes; a CSV file's first column may be called PAR1."""
    after = beginning[len(PARQUET) : len(PARQUET) + 1]
    return beginning.startswith(PARQUET) and b"" < after < b" " and after not in b"\t\r\n"


def _completed(mend: str, name: str) -> str:
    stem = PurePath(name).with_suffix("") if PurePath(name).name else PurePath(name)
    bag = name if name.endswith(".bag") else f"{stem}.bag"
    renamed = "" if bag == name else f"call it {shlex.quote(bag)}, since rosbags goes by the ending, and "
    return mend.format(file=shlex.quote(name), stem=shlex.quote(str(stem)), bag=shlex.quote(bag), as_bag=renamed)


def _zip(beginning: bytes) -> Signature:
    """Returns what a ZIP archive is by its first member: spreadsheets and NumPy's archives are such too."""
    length = int.from_bytes(beginning[26:28], "little")
    first, content = beginning[30 : 30 + length], beginning[30 + length :]
    if b"xl/" in beginning or b"spreadsheetml" in beginning:
        return Signature("an Excel workbook", "save its sheet as CSV in UTF-8")
    if first == b"mimetype" and content.startswith(b"application/vnd.oasis.opendocument"):
        return Signature("an OpenDocument file", "save its sheet as CSV in UTF-8")
    if first == b"[Content_Types].xml":
        return Signature("an Office document (xlsx, docx)", "save its sheet as CSV in UTF-8")
    if first.endswith(b".npy"):
        return Signature("a NumPy archive", _SAVE)
    return Signature("a ZIP archive", _UNPACK)
