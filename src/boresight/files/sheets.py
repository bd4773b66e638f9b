"""A table of text, row after row: a header and then cells, never all of them in memory."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import chain
from typing import BinaryIO

from boresight.errors import InputError
from boresight.files.problems import printable
from boresight.files.separators import SEPARATORS, separator_of, with_decimal_points, without_empty_ends
from boresight.files.sources import Source

MOST_COLUMNS, LONGEST_LINE = 10_000, 1_000_000
"""Cells and characters of a row; what is read of one grows with them."""

Row = tuple[int, list[str]]
"""A row's line in its file, counted from 1, and its cells."""


@dataclass(frozen=True)
class Sheet:
    """A table that can be gone through once.

    Attributes:
        name: what the user calls its file, for messages.
        rows: those that are not blank, the header first. Going through them raises an `InputError` where the file
            turns out not to be what it should.
        notes: how it is read, where that is not as it should be written; complete once the rows have been gone through.
    """

    name: str
    rows: Iterator[Row]
    notes: list[str] = field(default_factory=list)

    @property
    def form(self) -> tuple[str, ...]:
        """What was noted, as one sentence; none where the file is as it should be."""
        return (f"{self.name}: {'; '.join(dict.fromkeys(self.notes))}.",) if self.notes else ()


def csv_sheet(file: BinaryIO, name: str) -> Sheet:
    """Returns the rows of a CSV file in UTF-8; `#` begins a comment.

    Where its header has no commas, semicolons or tabs may separate the columns, and numbers have decimal commas; empty
    columns at the end are left out.

    Args:
        file: at its beginning.
        name: what the user calls it.
    """
    notes: list[str] = []
    return Sheet(name, _csv_rows(file, name, notes), notes)


def sheet_of(source: Source) -> Sheet:
    """Returns the rows of a CSV file whose content is at hand."""
    return csv_sheet(io.BytesIO(source.content), source.name)


def csv_text(rows: Iterable[Row]) -> str:
    """Returns a sheet's rows as CSV."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(cells for _, cells in rows)
    return text.getvalue()


def _csv_rows(file: BinaryIO, name: str, notes: list[str]) -> Iterator[Row]:
    text = io.TextIOWrapper(file, encoding="utf-8-sig", newline=None)
    lines = (line.partition("#")[0] for line in _bounded(text, name))
    reader = None
    try:
        head = [*_to_the_first(lines)]
        separator = separator_of(head[-1] if head else "")
        if separator != ",":
            notes.append(f"columns are separated by {SEPARATORS[separator]}")
        reader = csv.reader(chain(head, lines), delimiter=separator, strict=True)
        rows = ((reader.line_num, cells) for cells in reader)
        filled = ((line, cells) for line, cells in rows if len(cells) > 1 or (cells and cells[0].strip()))
        few = with_few_columns(filled, name)
        pointed = few if separator == "," else with_decimal_points(few, name, notes)
        yield from without_empty_ends(pointed, notes)
    except UnicodeDecodeError:
        raise InputError(f"{name}: the file is not UTF-8 text; save it as CSV in UTF-8") from None
    except OSError as error:
        raise InputError(printable(f"{name}: it cannot be read on: {error.strerror or error}")) from None
    except csv.Error as error:
        where = f"{name}, line {reader.line_num if reader else 1}: "
        raise InputError(printable(f"{where}not valid CSV: {error}; is a quotation mark left open?")) from None
    text.detach()  # or the file, which its owner looks at once more, would be closed with it


def with_few_columns(rows: Iterable[Row], name: str) -> Iterator[Row]:
    """Yields rows as long as they have no more cells than any table of measurements has."""
    for line, cells in rows:
        if len(cells) > MOST_COLUMNS:
            raise InputError(f"{name}, line {line}: {len(cells):,} columns; expected at most {MOST_COLUMNS:,}")
        yield line, cells


def _bounded(text: io.TextIOWrapper, name: str) -> Iterator[str]:
    """Yields a text's lines as long as each could be a row."""
    for number, line in enumerate(iter(lambda: text.readline(LONGEST_LINE), ""), start=1):
        if len(line) == LONGEST_LINE:
            raise InputError(
                f"{name}, line {number}: more than {LONGEST_LINE:,} characters; expected rows of numbers, a line each"
            )
        yield line


def _to_the_first(lines: Iterator[str]) -> Iterator[str]:
    """Yields lines up to the first that is not blank."""
    for line in lines:
        yield line
        if line.strip():
            return
