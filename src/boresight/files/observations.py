"""observations.csv: every row either becomes a reading or is set aside with its reason."""

from __future__ import annotations

import csv
import io
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from operator import itemgetter
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from boresight.calibration.campaign import SetAside
from boresight.errors import InputError, did_you_mean
from boresight.files.columns import Columns, read_columns
from boresight.files.problems import Problems, listed, printable, shown
from boresight.files.sources import Source, read_source
from boresight.files.suspicions import suspicions
from boresight.sensing import Cell, Readings
from boresight.units import Units

LIMIT_MIB = 512


@dataclass(frozen=True)
class Observations:
    """What an observations file holds.

    Attributes:
        readings: the rows that can be used.
        set_aside: the rows that cannot, and why.
        warnings: what looks odd, a sentence each.
        sha256: of the file.
    """

    readings: Readings
    set_aside: tuple[SetAside, ...]
    warnings: tuple[str, ...]
    sha256: str


def read_observations(
    path: Path | str, *, cell: Cell, units: Units, name: str | None = None, named_by: str = ""
) -> Observations:
    """Returns the readings of a CSV file, in metres and radians.

    Args:
        path: where it is.
        cell: the arm, the sensor and the targets that it is about.
        units: the units it is written in.
        name: what the user calls it; the path as given by default.
        named_by: the place that names the file, as the beginning of a sentence.

    Raises:
        InputError: it cannot be read, or not one row of it is usable.
    """
    name = str(path) if name is None else name
    mend = "thin it or split it"
    source = read_source(Path(path), name, kind="a CSV file", limit_mib=LIMIT_MIB, mend=mend, named_by=named_by)
    problems = Problems()
    table = _read_table(source, cell, units, problems)
    problems.raise_if_any()
    return _judged(table, source, cell, units)


@dataclass(frozen=True)
class _Table:
    """The numbers of a file in its own units; empty cells are NaN.

    Attributes:
        columns: what they mean.
        numbers: (rows, numeric columns).
        target: (rows,) index of the target; -1 where the cell is empty.
        line: (rows,) line in the file.
        empty: names of the empty cells, by line.
    """

    columns: Columns
    numbers: Float[np.ndarray, "rows columns"]
    target: Int[np.ndarray, " rows"]
    line: Int[np.ndarray, " rows"]
    empty: dict[int, list[str]]


def _read_table(source: Source, cell: Cell, units: Units, problems: Problems) -> _Table:
    lines = _rows(source)
    line, header = next(lines, (1, []))
    if not header:
        raise InputError(f"{source.name}: the file is empty; expected a row of column names and then readings")
    columns = read_columns([name.strip() for name in header], cell, units, f"{source.name}, line {line}: ", problems)
    problems.raise_if_any()
    place_of = {name: place for place, name in enumerate(cell.targets)}
    numeric = itemgetter(*columns.places)
    # Flat arrays of machine numbers: a million rows of Python floats would not fit in the memory they deserve.
    numbers, target, line_numbers = array("d"), array("q"), array("q")
    empty: dict[int, list[str]] = {}
    for line, cells in lines:
        where = f"{source.name}, line {line}: "
        if len(cells) != columns.width:
            problems.add(f"{where}{len(cells)} cells; expected {columns.width}, as in the header")
            continue
        if columns.target is not None:
            given = cells[columns.target].strip()
            if given and given not in place_of:
                near = did_you_mean(given[:60], place_of)
                problems.add(f"{where}there is no target {shown(given)}{near}; the targets are {listed(place_of)}")
            target.append(place_of.get(given, -1))
        given_numbers = numeric(cells)
        try:
            if "_" in "".join(given_numbers):  # float() takes 1_000 for a thousand
                raise ValueError
            numbers.extend(list(map(float, given_numbers)))
        except ValueError:
            numbers.extend(_cell_by_cell(given_numbers, columns, empty.setdefault(line, []), where, problems))
        line_numbers.append(line)
    count = len(line_numbers)
    return _Table(
        columns,
        np.frombuffer(numbers, dtype=float).reshape(count, len(columns.names))
        if count
        else np.empty((0, len(columns.names))),
        np.array(target, dtype=np.int64) if columns.target is not None else np.zeros(count, dtype=np.int64),
        np.array(line_numbers, dtype=np.int64),
        empty,
    )


def _rows(source: Source) -> Iterator[tuple[int, list[str]]]:
    """Yields (line, cells) of every row that is not blank; `#` begins a comment."""
    text = io.TextIOWrapper(io.BytesIO(source.content), encoding="utf-8-sig", newline=None)
    reader = csv.reader((line.partition("#")[0] for line in text), strict=True)
    try:
        for cells in reader:
            if len(cells) > 1 or (cells and cells[0].strip()):
                yield reader.line_num, cells
    except UnicodeDecodeError:
        raise InputError(f"{source.name}: the file is not UTF-8 text; save it as CSV in UTF-8") from None
    except csv.Error as error:
        where = f"{source.name}, line {reader.line_num}: "
        raise InputError(printable(f"{where}not valid CSV: {error}; is a quotation mark left open?")) from None


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
                number = float(text if "_" not in text else "")
            except ValueError:
                problems.add(
                    f"{where}{name}: got {shown(text)}; expected a number, or an empty cell where there is none"
                )
        numbers.append(number)
    return numbers


def _judged(table: _Table, source: Source, cell: Cell, units: Units) -> Observations:
    """Returns the rows that can be used as readings, and the others with their reasons."""
    columns, numbers = table.columns, table.numbers
    if not len(numbers):
        raise InputError(f"{source.name}: there is a header but no row of readings under it")
    _check_certainty(table, source.name)
    values = numbers[:, columns.joints : columns.joints + columns.channels]
    usable = np.isfinite(numbers).all(axis=1) & (table.target >= 0)
    if cell.sensor.type == "laser_ranger":
        usable &= ~(values <= 0.0).any(axis=1)
    set_aside = tuple(
        SetAside(source.name, int(table.line[row]), _reason(table, int(row))) for row in np.flatnonzero(~usable)
    )
    if not usable.any():
        first = set_aside[0]
        why = f"the first, on line {first.line}: {first.reason}"
        raise InputError(printable(f"{source.name}: none of its {len(numbers)} rows can be used; {why}"))
    # One multiplication a number, so that a file in metres and radians is read to the bit.
    kept = numbers[usable] * np.array(columns.scales)
    joints, values = kept[:, : columns.joints], kept[:, columns.joints : columns.joints + columns.channels]
    std = _std(kept, columns, cell)
    readings = Readings(joints, values, std, table.target[usable], table.line[usable])
    return Observations(readings, set_aside, suspicions(readings, cell, units, source.name), source.sha256)


def _std(kept: Float[np.ndarray, "rows columns"], columns: Columns, cell: Cell) -> Float[np.ndarray, "rows channels"]:
    """The standard deviation [m] of each value: the row's own, or one reading's over the root of the repeats."""
    start = columns.joints + columns.channels
    if columns.stds:
        return np.array(np.broadcast_to(kept[:, start : start + columns.stds], (len(kept), columns.channels)))
    repeats = kept[:, -1:] if columns.repeats else np.full((len(kept), 1), float(cell.sensor.repeats))
    return np.repeat(cell.sensor.noise_std / np.sqrt(repeats), columns.channels, axis=1)


def _check_certainty(table: _Table, name: str) -> None:
    """Raises an `InputError` for stated uncertainties that no measurement can have."""
    problems = Problems()
    columns = table.columns
    start = columns.joints + columns.channels
    for column in range(start, start + columns.stds):
        for row in np.flatnonzero(table.numbers[:, column] <= 0.0):
            problems.add(
                f"{name}, line {table.line[row]}: {columns.names[column]}: got {table.numbers[row, column]:g}; "
                f"expected a standard deviation above 0; leave the cell empty to set the row aside"
            )
    if columns.repeats:
        repeats = table.numbers[:, -1]
        for row in np.flatnonzero(np.isfinite(repeats) & ((repeats < 1.0) | (repeats != np.floor(repeats)))):
            problems.add(
                f"{name}, line {table.line[row]}: repeats: got {repeats[row]:g}; expected a whole number from 1"
            )
    problems.raise_if_any()


def _reason(table: _Table, row: int) -> str:
    """Why a row is set aside."""
    columns, numbers = table.columns, table.numbers[row]
    empty = table.empty.get(int(table.line[row]), [])
    reasons = [
        f"{name} is empty" if name in empty else f"{name} is {number:g}"
        for name, number in zip(columns.names, numbers, strict=True)
        if not np.isfinite(number)
    ]
    reasons += ["target is empty"] if table.target[row] < 0 else []
    if not reasons:
        value = numbers[columns.joints]
        reasons = [f"{columns.names[columns.joints]} is {value:g}, and a range is above 0"]
    return "; ".join(reasons)
