"""Joint states read by the layout of the one before: the same joints with other numbers, hundreds of times a second."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

JointState = tuple[tuple[str, ...], Float[np.ndarray, " joints"]]

_LITTLE_ENDIAN = b"\0\1"
_STAMP, _COUNT = struct.Struct("<iI"), struct.Struct("<I")
_BEGINNING = 4
"""Bytes before the content: CDR aligns from there."""


@dataclass
class JointStateReader:
    """Reads serialised joint states; a message laid out as the last one needs no decoder.

    Attributes:
        decode: the general decoder, of a message to (stamp [ns], joint state).
    """

    decode: Callable[[bytes], tuple[int, Any]]
    _names: tuple[str, ...] = ()
    _between: bytes = b""
    _start: int = 0

    def __call__(self, data: bytes) -> tuple[int, JointState]:
        """Returns (stamp [ns], (names, positions)) of a message."""
        end = self._start + 8 * len(self._names)
        known = self._names and data[:2] == _LITTLE_ENDIAN and len(data) >= end
        if known and data[_BEGINNING + _STAMP.size : self._start] == self._between:
            sec, nanosec = _STAMP.unpack_from(data, _BEGINNING)
            return sec * 10**9 + nanosec, (
                self._names,
                np.frombuffer(data, "<f8", len(self._names), self._start).copy(),
            )
        stamp, (names, positions) = self.decode(data)
        if data[:2] == _LITTLE_ENDIAN and names:
            start = _positions_start(data)
            if data[start : start + 8 * len(names)] == positions.tobytes():
                self._names, self._start = names, start
                self._between = data[_BEGINNING + _STAMP.size : start]
        return stamp, (names, positions)


def _positions_start(data: bytes) -> int:
    """Returns where the positions of a message that could be decoded begin: behind the frame's name and the joints'."""
    place = _after_text(data, _BEGINNING + _STAMP.size)
    place = _aligned(place, 4)
    (count,) = _COUNT.unpack_from(data, place)
    place += _COUNT.size
    for _ in range(count):
        place = _after_text(data, _aligned(place, 4))
    return _aligned(_aligned(place, 4) + _COUNT.size, 8)


def _after_text(data: bytes, place: int) -> int:
    return place + _COUNT.size + int(_COUNT.unpack_from(data, place)[0])


def _aligned(place: int, size: int) -> int:
    return _BEGINNING + (place - _BEGINNING + size - 1) // size * size
