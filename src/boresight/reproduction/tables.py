"""A table whose numbers are kept as numbers, and rounded only where they are shown."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass

from boresight.reproduction.spread import Spread, percent, plain

Cell = str | int | float | Spread


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table.

    Attributes:
        heading: as it is shown, with its unit.
        key: as the CSV calls it, with its unit.
        digits: of a number that matter.
        decimals: behind the point instead, where a column is read downwards.
        share: whether its numbers are shares, shown in per cent.
        in_csv: whether the CSV has it; times are left out there, so that the same seed gives the same bytes.
    """

    heading: str
    key: str
    digits: int = 3
    decimals: int | None = None
    share: bool = False
    in_csv: bool = True

    def text(self, cell: Cell) -> str:
        """Returns a cell as it is shown."""
        if isinstance(cell, Spread):
            return f"{self._number(cell.median)} ({self._number(cell.low)} to {self._number(cell.high)})"
        if isinstance(cell, float):
            return percent(cell) if self.share else self._number(cell)
        return f"{cell:,}" if isinstance(cell, int) else cell

    def _number(self, value: float) -> str:
        if self.decimals is None:
            return plain(value, self.digits)
        return f"{round(value, self.decimals) + 0.0:,.{self.decimals}f}".replace("-", "−")


@dataclass(frozen=True)
class Table:
    """Rows under named columns.

    Attributes:
        name: of its CSV file.
        title: above it.
        columns: what a row holds.
        rows: one cell a column.
        note: beneath it.
    """

    name: str
    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""

    @property
    def texts(self) -> list[list[str]]:
        """Every row as it is shown."""
        return [[c.text(cell) for c, cell in zip(self.columns, row, strict=True)] for row in self.rows]

    @property
    def wordy(self) -> list[bool]:
        """Of each column, whether it holds words."""
        return [all(isinstance(row[i], str) for row in self.rows) for i in range(len(self.columns))]

    def as_csv(self) -> str:
        """Returns the numbers to nine digits; a spread takes three columns."""
        kept = [i for i, column in enumerate(self.columns) if column.in_csv]
        spreads = {i for i in kept if any(isinstance(row[i], Spread) for row in self.rows)}
        header = [name for i in kept for name in _names(self.columns[i].key, i in spreads)]
        rows = [[text for i in kept for text in _digits(row[i], i in spreads)] for row in self.rows]
        return csv_text(header, rows)


def csv_text(header: list[str], rows: list[list[str]]) -> str:
    """Returns rows under a header as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()


def _names(key: str, spread: bool) -> list[str]:
    return [f"{key}_median", f"{key}_p05", f"{key}_p95"] if spread else [key]


def _digits(cell: Cell, spread: bool) -> list[str]:
    if isinstance(cell, Spread):
        return [f"{value:.9g}" for value in (cell.median, cell.low, cell.high)]
    text = f"{cell:.9g}" if isinstance(cell, float) else str(cell)
    return [text, "", ""] if spread else [text]
