"""Compressed data, inflated as far as it goes and never beyond a limit."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, BinaryIO, Literal

_PIECE = 2**20


def inflate(data: bytes, compression: str, limit: int) -> tuple[bytes, bool]:
    """Returns the inflated data and whether that is all of it: a stream that breaks off gives what came before.

    Args:
        data: the compressed bytes.
        compression: `zstd` or `lz4`, or "" for none.
        limit: bytes beyond which the data is a bomb, and what is left of it is not inflated.

    Raises:
        KeyError: there is no such compression.
    """
    if not compression:
        return data[:limit], len(data) <= limit
    stream, whole = _DECOMPRESSORS[compression](), bytearray()
    try:
        whole += stream.decompress(data, limit)
        while not stream.eof and not stream.needs_input and len(whole) < limit:
            piece = stream.decompress(b"", limit - len(whole))
            if not piece:
                break
            whole += piece
    except Exception:  # each library has its own error, and lz4 raises RuntimeError
        return bytes(whole) or _in_pieces(data, compression, limit), False
    return bytes(whole), bool(stream.eof)


def _in_pieces(data: bytes, compression: str, limit: int) -> bytes:
    """Returns what can be inflated before the place where the data is damaged."""
    stream, whole = _DECOMPRESSORS[compression](), bytearray()
    try:
        for start in range(0, len(data), 1024):
            if stream.eof or len(whole) >= limit:
                break
            whole += stream.decompress(data[start : start + 1024], limit - len(whole))
    except Exception:
        pass
    return bytes(whole)


Inflated = Literal["whole", "broken", "too large"]
"""How far a file was inflated."""


def inflate_file(source: BinaryIO, target: BinaryIO, limit: int) -> Inflated:
    """Returns how far a zstd file was inflated into another one.

    Args:
        source: the compressed file.
        target: where the content goes.
        limit: bytes beyond which nothing more is written.

    Raises:
        OSError: there is no room for it.
    """
    stream, written = _DECOMPRESSORS["zstd"](), 0
    while written < limit:
        fed = source.read(_PIECE) if stream.needs_input else b""
        if stream.needs_input and not fed:
            return "broken"
        try:
            piece = stream.decompress(fed, min(_PIECE * 8, limit - written))
        except Exception:  # each library has its own
            return "broken"
        target.write(piece)
        written += len(piece)
        if stream.eof:
            return "whole"
    return "too large"


def _zstd() -> Any:
    try:
        from compression.zstd import ZstdDecompressor
    except ImportError:
        from backports.zstd import ZstdDecompressor
    return ZstdDecompressor()


def _lz4() -> Any:
    from lz4.frame import LZ4FrameDecompressor

    return LZ4FrameDecompressor()


_DECOMPRESSORS: dict[str, Callable[[], Any]] = {"zstd": _zstd, "lz4": _lz4}
"""By the names that MCAP has for them."""
