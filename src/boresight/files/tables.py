"""The cells of an observations file as numbers, with the faults that no number can be made of."""

from __future__ import annotations

import sys
from array import array
from collections.abc import Sequence
from dataclasses import dataclass
from operator import itemgetter

import numpy as np
from jaxtyping import Float, Int

from boresight.errors import InputError
from boresight.files.aiming import AimsByName
from boresight.files.columns import KEYS, Columns, read_columns
from boresight.files.numbers import number_of
from boresight.files.problems import Problems, printable, shown
from boresight.files.schemas import LARGEST
from boresight.files.sheets import Sheet
from boresight.sensing import Cell
from boresight.units import Units


@dataclass(frozen=True)
class Table:
    """The numbers of a file in its own units; empty cells are NaN.

    Attributes:
        columns: what they mean.
        numbers: (rows, numeric columns).
        target: (rows,) index of the aim; -1 where a name that it needs is empty.
        session: (rows,) name of the session, "" where there is none; None without such a column.
        line: (rows,) line in the file.
        empty: names of the empty cells, by line.
    """

    columns: Columns
    numbers: Float[np.ndarray, "rows columns"]
    target: Int[np.ndarray, " rows"]
    session: np.ndarray | None
    line: Int[np.ndarray, " rows"]
    empty: dict[int, list[str]]

    def reason(self, row: int, needed: Sequence[int]) -> str:
        """Returns why a row, which needs some of the numeric columns, cannot be used."""
        columns, numbers = self.columns, self.numbers[row]
        empty = self.empty.get(int(self.line[row]), [])
        reasons = [
            f"{columns.names[column]} is empty"
            if columns.names[column] in empty
            else f"{columns.names[column]} is {numbers[column]:g}"
            for column in needed
            if not abs(numbers[column]) <= LARGEST
        ]
        reasons += [f"{name} is empty" for name in KEYS if name in empty]
        if not reasons:
            value = needed[columns.joints]
            reasons = [f"{columns.names[value]} is {numbers[value]:g}, and a range is above 0"]
        return "; ".join(reasons)


def read_table(sheet: Sheet, cell: Cell, units: Units, problems: Problems, *, need_values: bool = True) -> Table:
    """Returns the numbers of an observations file; they make no sense where a problem was added.

    Args:
        sheet: the rows of the file.
        cell: the arm, the sensors and the targets that it is about.
        units: the units it is written in.
        problems: where faults are added.
        need_values: whether configurations alone are a fault.
    """
    line, header = next(sheet.rows, (1, []))
    if not header:
        raise InputError(f"{sheet.name}: the file is empty; expected a row of column names and then readings")
    names = [name.strip() for name in header]
    columns = read_columns(names, cell, units, f"{sheet.name}, line {line}: ", problems, need_values=need_values)
    problems.raise_if_any()
    aims = AimsByName(cell, tuple(key for key in columns.keys if key != "session"))
    keys = [columns.keys[key] for key in aims.keys]
    session_at = columns.keys.get("session")
    numeric = itemgetter(*columns.places)
    # Flat arrays of machine numbers: a million rows of Python floats would not fit in the memory they deserve.
    numbers, target, line_numbers = array("d"), array("q"), array("q")
    sessions: list[str] = []
    empty: dict[int, list[str]] = {}
    for line, cells in sheet.rows:
        if len(cells) != columns.width:
            problems.add(f"{sheet.name}, line {line}: {len(cells)} cells; expected {columns.width}, as in the header")
            continue
        given = tuple([cells[key].strip() for key in keys])
        aim = aims.place(given, f"{sheet.name}, line {line}: ", problems)
        if aim < 0:
            empty.setdefault(line, []).extend(aims.empty(given))
        target.append(aim)
        if session_at is not None:
            session = cells[session_at].strip()
            sessions.append(sys.intern(session if session.isprintable() else printable(session)))
        given_numbers = numeric(cells)
        try:
            together = "".join(given_numbers)
            if "_" in together or not together.isascii():  # float() takes 1_000, and digits of any script
                raise ValueError
            numbers.extend(list(map(float, given_numbers)))
        except ValueError:
            where = f"{sheet.name}, line {line}: "
            numbers.extend(_cell_by_cell(given_numbers, columns, empty.setdefault(line, []), where, problems))
        line_numbers.append(line)
    count = len(line_numbers)
    return Table(
        columns,
        np.frombuffer(numbers, dtype=float).reshape(count, len(columns.names)),
        np.frombuffer(target, dtype=np.int64),
        np.array(sessions, dtype=object) if session_at is not None else None,
        np.frombuffer(line_numbers, dtype=np.int64),
        empty,
    )


def _cell_by_cell(
    cells: Sequence[str], columns: Columns, empty: list[str], where: str, problems: Problems
) -> list[float]:
    """Returns a row's numbers where some cell is not one, and notes which."""
    numbers = []
    for name, text in zip(columns.names, cells, strict=True):
        number = float("nan")
        if not text.strip():
            empty.append(name)
        else:
            try:
                number = number_of(text)
            except ValueError:
                problems.add(
                    f"{where}{name}: got {shown(text)}; expected a number, or an empty cell where there is none"
                )
        numbers.append(number)
    return numbers
