"""observations.csv: every row either becomes a reading or is set aside with its reason."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from boresight.calibration.campaign import SetAside
from boresight.errors import InputError
from boresight.files.columns import Columns
from boresight.files.problems import Problems, printable
from boresight.files.schemas import LARGEST, SMALLEST
from boresight.files.sources import Source, read_source
from boresight.files.suspicions import suspicions
from boresight.files.tables import Table, read_table
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
    path: Path | str,
    *,
    cell: Cell,
    units: Units,
    name: str | None = None,
    named_by: str = "",
    need_values: bool = True,
) -> Observations:
    """Returns the readings of a CSV file, in metres and radians.

    Args:
        path: where it is.
        cell: the arm, the sensor and the targets that it is about.
        units: the units it is written in.
        name: what the user calls it; the path as given by default.
        named_by: the place that names the file, as the beginning of a sentence.
        need_values: whether configurations alone, without any column of the sensor's, are an error; their values
            are NaN where they are not.

    Raises:
        InputError: it cannot be read, or not one row of it is usable.
    """
    name = str(path) if name is None else name
    mend = "thin it or split it"
    source = read_source(Path(path), name, kind="a CSV file", limit_mib=LIMIT_MIB, mend=mend, named_by=named_by)
    problems = Problems()
    table = read_table(source, cell, units, problems, need_values=need_values)
    problems.raise_if_any()
    return _judged(table, source, cell, units)


def _judged(table: Table, source: Source, cell: Cell, units: Units) -> Observations:
    """Returns the rows that can be used as readings, and the others with their reasons."""
    columns, numbers = table.columns, table.numbers
    if not len(numbers):
        raise InputError(f"{source.name}: there is a header but no row of readings under it")
    _check_certainty(table, source.name)
    values = numbers[:, columns.joints : columns.joints + columns.channels]
    usable = (np.abs(numbers) <= LARGEST).all(axis=1) & (table.target >= 0)
    if cell.sensor.type == "laser_ranger":
        usable &= ~(values <= 0.0).any(axis=1)
    set_aside = tuple(
        SetAside(source.name, int(table.line[row]), table.reason(int(row))) for row in np.flatnonzero(~usable)
    )
    if not usable.any():
        first = set_aside[0]
        why = f"the first, on line {first.line}: {first.reason}"
        raise InputError(printable(f"{source.name}: none of its {len(numbers)} rows can be used; {why}"))
    # One multiplication a number, so that a file in metres and radians is read to the bit.
    kept = numbers[usable] * np.array(columns.scales)
    joints, values = kept[:, : columns.joints], kept[:, columns.joints : columns.joints + columns.channels]
    if not columns.channels:
        values = np.full((len(kept), len(cell.sensor.channels)), np.nan)
    std = _std(kept, columns, cell)
    readings = Readings(joints, values, std, table.target[usable], table.line[usable])
    return Observations(readings, set_aside, suspicions(readings, cell, units, source.name), source.sha256)


def _std(kept: Float[np.ndarray, "rows columns"], columns: Columns, cell: Cell) -> Float[np.ndarray, "rows channels"]:
    """The standard deviation [m] of each value: the row's own, or one reading's over the root of the repeats."""
    start, channels = columns.joints + columns.channels, len(cell.sensor.channels)
    if columns.stds:
        return np.array(np.broadcast_to(kept[:, start : start + columns.stds], (len(kept), channels)))
    repeats = kept[:, -1:] if columns.repeats else np.full((len(kept), 1), float(cell.sensor.repeats))
    return np.repeat(cell.sensor.noise_std / np.sqrt(repeats), channels, axis=1)


def _check_certainty(table: Table, name: str) -> None:
    """Raises an `InputError` for stated uncertainties that no measurement can have."""
    problems = Problems()
    columns = table.columns
    start = columns.joints + columns.channels
    for column in range(start, start + columns.stds):
        for row in np.flatnonzero(table.numbers[:, column] < SMALLEST):
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
