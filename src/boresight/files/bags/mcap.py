"""MCAP read from front to back, so that a file without its end loses no more than its end.

Format: mcap.dev/spec. A file is its magic, then records of one byte of kind, eight of length, and content; a
chunk holds compressed records. Indexes at the end are used only to find the way back after damage.
"""

from __future__ import annotations

import os
import struct
from binascii import crc32
from bisect import bisect_right
from collections.abc import Iterator
from contextlib import suppress
from typing import BinaryIO

from boresight.errors import InputError
from boresight.files.bags.inflating import inflate
from boresight.files.bags.tape import LARGEST_MESSAGE, Tape
from boresight.files.signatures import MCAP

LARGEST_CHUNK = 256 * 2**20
"""Chunks are about 1 MiB; one beyond this [bytes] is damaged, or a bomb."""

_FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _CHUNK, _CHUNK_INDEX, _DATA_END = 0x02, 0x03, 0x04, 0x05, 0x06, 0x08, 0x0F
_HEAD, _MESSAGE_HEAD, _CHUNK_HEAD = struct.Struct("<BQ"), struct.Struct("<HIQQ"), struct.Struct("<QQQII")
_LARGEST_DEFINITION = 16 * 2**20
_FOOTER_LENGTH = 20
_MOST_CHUNKS = 1_000_000


class Damage(Exception):
    """Bytes that make no sense."""


def read_mcap(file: BinaryIO, name: str, tape: Tape) -> None:
    """Returns nothing; the tape gets what the file holds, and a sentence on what is lost.

    Args:
        file: open at its beginning.
        name: of the file, for the sentence.
        tape: where messages go.

    Raises:
        InputError: this is not an MCAP file.
    """
    size = os.fstat(file.fileno()).st_size
    if file.read(len(MCAP)) != MCAP:
        raise InputError(f"{name}: the file does not begin as an MCAP file does")
    scan, place = _Scan(tape, name), len(MCAP)
    chunks = _summary(file, size, scan)
    while place < size and not scan.done:
        try:
            place = scan.record(file, place, size)
        except Damage as damage:
            after = bisect_right(chunks, place)
            place = chunks[after] if after < len(chunks) else size
            scan.lost(f"{damage}" if place == size else f"{damage}, and reading went on at the next chunk")
            scan.done = place == size
    if not scan.done:
        scan.lost("it has no end mark, the recording broke off")


class _Scan:
    """The schemas and channels seen so far, and the way through records."""

    def __init__(self, tape: Tape, name: str) -> None:
        self.tape = tape
        self.name = name
        self.schemas: dict[int, str] = {}
        self.channels: dict[int, str] = {}
        self.done = False

    def lost(self, what: str) -> None:
        """Notes what cannot be read, and how much could be until there."""
        self.tape.lose(f"{self.name}: {what}; {self.tape.total:,} messages were read up to there")

    def record(self, file: BinaryIO, place: int, size: int) -> int:
        """Returns the place after the record at a place, its content taken in."""
        file.seek(place)
        head = file.read(_HEAD.size)
        if len(head) < _HEAD.size:
            raise Damage("it ends in the middle of a record")
        kind, length = _HEAD.unpack(head)
        end = place + _HEAD.size + length
        if kind in (_FOOTER, _DATA_END):
            self.done = True
            return size
        if kind == 0:
            raise Damage(f"there is no record at byte {place}")
        if kind == _CHUNK:
            try:
                self.chunk(file.read(min(length, LARGEST_CHUNK)), place)
            except Damage as damage:
                if end <= size:
                    self.lost(str(damage))
        if end > size:
            raise Damage(f"it ends in the middle of a {'chunk' if kind == _CHUNK else 'record'}")
        if kind in (_SCHEMA, _CHANNEL, _MESSAGE) and length <= _LARGEST_DEFINITION:
            self.content(kind, memoryview(file.read(length)))
        return end

    def chunk(self, content: bytes, place: int) -> None:
        """Takes in the records of a chunk, or of as much of it as there is."""
        try:
            _, _, inflated, crc, letters = _CHUNK_HEAD.unpack_from(content)
            start = _CHUNK_HEAD.size + letters + 8
            compression = bytes(content[_CHUNK_HEAD.size : start - 8]).decode()
            (length,) = struct.unpack_from("<Q", content, start - 8)
            if inflated > LARGEST_CHUNK:
                raise Damage(f"the chunk at byte {place} claims {inflated / 2**20:,.0f} MiB")
            data, whole = inflate(content[start : start + length], compression, inflated)
        except (struct.error, UnicodeDecodeError):
            raise Damage(f"the chunk at byte {place} has no beginning that makes sense") from None
        except KeyError:
            raise Damage(f"the chunk at byte {place} is compressed in an unknown way") from None
        complete = whole and len(data) == inflated
        if complete and crc and crc32(data) != crc:
            raise Damage(f"the chunk at byte {place} does not have the checksum it states, so none of it is used")
        for kind, record in _records(memoryview(data)):
            self.content(kind, record)
        if not complete:
            raise Damage(f"the chunk at byte {place} is damaged")

    def content(self, kind: int, record: memoryview) -> None:
        """Takes in one record."""
        try:
            if kind == _SCHEMA:
                self.schemas[int.from_bytes(record[:2], "little")], _ = _text(record, 2)
            elif kind == _CHANNEL:
                channel, schema = struct.unpack_from("<HH", record)
                topic, rest = _text(record, 4)
                encoding, _ = _text(record, rest)
                self.channels[channel] = topic
                self.tape.announce(topic, self.schemas.get(schema, ""), encoding)
            elif kind == _MESSAGE:
                channel, _, received, _ = _MESSAGE_HEAD.unpack_from(record)
                self.message(self.channels.get(channel, ""), received, record[_MESSAGE_HEAD.size :])
        except (struct.error, UnicodeDecodeError):
            raise Damage("a record makes no sense") from None

    def message(self, topic: str, received: int, data: memoryview) -> None:
        """Keeps or counts one message."""
        if self.tape.wants(topic) and len(data) <= LARGEST_MESSAGE:
            self.tape.keep(topic, received, bytes(data))
        else:
            self.tape.count(topic)


def _records(data: memoryview) -> Iterator[tuple[int, memoryview]]:
    """Yields (kind, content) of every record that is there in full."""
    place = 0
    while place + _HEAD.size <= len(data):
        kind, length = _HEAD.unpack_from(data, place)
        place += _HEAD.size
        if kind == 0 or place + length > len(data):
            return
        yield kind, data[place : place + length]
        place += length


def _text(record: memoryview, place: int) -> tuple[str, int]:
    """Returns the text at a place of a record, and the place after it."""
    (length,) = struct.unpack_from("<I", record, place)
    end = place + 4 + length
    if end > len(record):
        raise struct.error
    return bytes(record[place + 4 : end]).decode(), end


def _summary(file: BinaryIO, size: int, scan: _Scan) -> list[int]:
    """Returns where chunks begin by the index at the file's end, in order; none where the end is missing.

    Channels are repeated there, which helps where the chunk that named them first is damaged.
    """
    footer = size - len(MCAP) - _FOOTER_LENGTH
    file.seek(max(0, footer))
    end = file.read()
    if footer <= 0 or end[-len(MCAP) :] != MCAP:
        return []
    (at,) = struct.unpack_from("<Q", end)
    places: set[int] = set()
    while 0 < at < footer and len(places) < _MOST_CHUNKS:
        file.seek(at)
        head = file.read(_HEAD.size)
        kind, length = _HEAD.unpack(head) if len(head) == _HEAD.size else (0, 0)
        if kind == 0 or at + length > size:
            break
        if kind in (_SCHEMA, _CHANNEL) and length <= _LARGEST_DEFINITION:
            with suppress(Damage):
                scan.content(kind, memoryview(file.read(length)))
        elif kind == _CHUNK_INDEX and length >= 24:
            places.add(struct.unpack_from("<Q", file.read(24), 16)[0])
        at += _HEAD.size + length
    return sorted(place for place in places if place < size)
