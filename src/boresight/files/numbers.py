"""Numbers as files write them: ASCII digits alone, where Python takes 1_000 and digits of any script."""

from __future__ import annotations


def number_of(text: str) -> float:
    """Returns the number that a cell holds.

    Raises:
        ValueError: it holds none.
    """
    if "_" in text or not text.isascii():
        raise ValueError
    return float(text)
