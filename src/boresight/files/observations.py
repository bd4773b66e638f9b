"""observations.csv, or Parquet: every row either becomes a reading or is set aside with its reason."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int

from boresight.calibration.campaign import SetAside
from boresight.errors import InputError
from boresight.files.columns import NEARLY_UNIT, QUATERNION, Columns, known_columns
from boresight.files.dialects import described, in_house_words
from boresight.files.headers import with_known_names
from boresight.files.parquet import is_parquet, parquet_sheet
from boresight.files.problems import Problems, printable
from boresight.files.schemas import LARGEST, SMALLEST
from boresight.files.sheets import Sheet, csv_sheet
from boresight.files.sources import open_source
from boresight.files.suspicions import suspicions
from boresight.files.tables import Table, read_table
from boresight.geometry import quaternion_matrix
from boresight.sensing import Cell, Distances, LaserRanger, Pose, Readings, Sensor
from boresight.sensing.pairs import of_distances, pairs_of
from boresight.units import Units

LIMIT_MIB = 512

_ALONE = "no position of its block is left to which its distance could be told"


@dataclass(frozen=True)
class Observations:
    """What an observations file holds.

    Attributes:
        readings: the rows that can be used.
        set_aside: the rows that cannot, and why.
        warnings: what looks odd, a sentence each.
        sha256: of the file; "" where it was none.
        notes: choices that were made in reading it, a sentence each.
    """

    readings: Readings
    set_aside: tuple[SetAside, ...]
    warnings: tuple[str, ...]
    sha256: str = ""
    notes: tuple[str, ...] = ()


def read_observations(
    path: Path | str,
    *,
    cell: Cell,
    units: Units,
    name: str | None = None,
    named_by: str = "",
    need_values: bool = True,
) -> Observations:
    """Returns the readings of a CSV or Parquet file, in metres and radians.

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
    kind, mend = "a CSV or Parquet file", "thin it or split it"
    with open_source(
        Path(path), name, kind=kind, limit_mib=LIMIT_MIB, mend=mend, named_by=named_by, read=("a Parquet file",)
    ) as source:
        if is_parquet(source.complaint.path, source.file):
            sheet = parquet_sheet(source, limit_mib=LIMIT_MIB)
        elif source.is_text:
            sheet = csv_sheet(source.file, name)
        else:
            raise source.complaint.not_text()
        ours, translation = in_house_words(sheet, cell.arm.joints, units)
        named = with_known_names(ours, known_columns(cell), cell.arm.joint_names, units)
        found = observations_of(named, cell, units, need_values=need_values)
    notes = (*([f"{name}: {described(translation)}"] if translation else []), *named.form)
    return replace(found, sha256=source.sha256, notes=tuple(map(printable, notes)))


def observations_of(sheet: Sheet, cell: Cell, units: Units, *, need_values: bool = True) -> Observations:
    """Returns the readings of a file's rows, in metres and radians.

    Args:
        sheet: the rows, in the house's words.
        cell: the arm, the sensors and the targets that it is about.
        units: the units it is written in.
        need_values: whether configurations alone are an error.

    Raises:
        InputError: not one row of it is usable, or something in it makes no sense.
    """
    problems = Problems()
    table = read_table(sheet, cell, units, problems, need_values=need_values)
    problems.raise_if_any()
    return _judged(table, sheet.name, cell, units)


def _judged(table: Table, name: str, cell: Cell, units: Units) -> Observations:
    """Returns the rows that can be used as readings, and the others with their reasons."""
    columns, numbers = table.columns, table.numbers
    if not len(numbers):
        raise InputError(f"{name}: there is a header but no row of readings under it")
    _check_certainty(table, name)
    own = np.array([list(cell.sensors).index(aim.sensor) for aim in cell.aims])[table.target]
    usable, needed = table.target >= 0, [columns.needed(name, sensor) for name, sensor in cell.sensors.items()]
    problems = Problems()
    for place, (sensor_name, sensor) in enumerate(cell.sensors.items()):
        rows = np.flatnonzero(own == place)
        usable[rows] &= (np.abs(numbers[rows][:, needed[place]]) <= LARGEST).all(axis=1)
        if isinstance(sensor, LaserRanger):
            usable[rows] &= ~(numbers[rows][:, list(columns.values[sensor_name])] <= 0.0).any(axis=1)
        _check_strangers(table, rows[usable[rows]], needed[place], sensor_name, name, problems)
        if isinstance(sensor, Pose) and not columns.planned:
            _check_quaternions(table, rows[usable[rows]], columns.values[sensor_name][3:], name, problems)
    problems.raise_if_any()
    alone = _without_partner(table, cell, usable)
    set_aside = tuple(
        SetAside(name, int(table.line[row]), _ALONE if alone[row] else table.reason(int(row), needed[own[row]]))
        for row in np.flatnonzero(~usable | alone)
    )
    usable &= ~alone
    if not usable.any():
        first = set_aside[0]
        why = f"the first, on line {first.line}: {first.reason}"
        raise InputError(printable(f"{name}: none of its {len(numbers)} rows can be used; {why}"))
    # One multiplication a number, so that a file in metres and radians is read to the bit.
    kept = numbers[usable] * np.array(columns.scales)
    session = None if table.session is None else table.session[usable]
    readings = _readings(kept, columns, cell, own[usable], table.target[usable], table.line[usable], session)
    return Observations(readings, set_aside, suspicions(readings, cell, units, name))


def _readings(
    kept: Float[np.ndarray, "rows columns"],
    columns: Columns,
    cell: Cell,
    own: Int[np.ndarray, "rows"],
    target: Int[np.ndarray, "rows"],
    line: Int[np.ndarray, "rows"],
    session: np.ndarray | None,
) -> Readings:
    """Returns numbers [m, rad or 1] as readings, each row as its sensor's."""
    values, std = np.zeros((len(kept), cell.channels)), np.full((len(kept), cell.channels), np.inf)
    reference = None
    for place, (name, sensor) in enumerate(cell.sensors.items()):
        rows, channels = np.flatnonzero(own == place), len(sensor.channels)
        std[rows, :channels] = _std(kept[rows], columns, name, sensor)
        given = kept[rows][:, list(columns.values[name])]
        if columns.planned:
            values[rows, :channels] = np.nan
        elif isinstance(sensor, Pose):
            values[rows, :3] = given[:, :3]
            if reference is None:
                reference = np.tile(np.eye(3), (len(kept), 1, 1))
            reference[rows] = quaternion_matrix(given[:, 3:])
        elif not isinstance(sensor, Distances):
            values[rows, : given.shape[1]] = given
    readings = Readings(kept[:, : columns.joints], values, std, target, line, reference, session)
    return _with_distances(readings, kept, columns, cell)


def _without_partner(table: Table, cell: Cell, usable: Bool[np.ndarray, "rows"]) -> Bool[np.ndarray, "rows"]:
    """Returns which usable rows are the last of an odd number of positions whose distances count."""
    rows = np.flatnonzero(usable)
    session = None if table.session is None else table.session[rows]
    first, second = pairs_of(cell, table.target[rows], session)
    alone = np.zeros(len(usable), dtype=bool)
    alone[rows[np.setdiff1d(of_distances(cell, table.target[rows]), np.concatenate([first, second]))]] = True
    return alone


def _with_distances(
    readings: Readings, kept: Float[np.ndarray, "rows columns"], columns: Columns, cell: Cell
) -> Readings:
    """Returns readings with positions whose distances count joined in pairs, the first row standing for both."""
    positions = of_distances(cell, readings.target)
    if not len(positions):
        return readings
    first, second = pairs_of(cell, readings.target, readings.session)
    since, values, std = readings.joints.copy(), readings.values.copy(), readings.std.copy()
    since[first] = readings.joints[second]
    std[first, 0] = np.hypot(readings.std[first, 0], readings.std[second, 0]) / np.sqrt(2.0)
    for row, other in zip(first, second, strict=True):
        xyz = list(columns.values[cell.aims[readings.target[row]].sensor])
        values[row, 0] = np.nan if columns.planned else np.linalg.norm(kept[row, xyz] - kept[other, xyz])
    return replace(readings, values=values, std=std, since=since).chosen(np.setdiff1d(np.arange(len(readings)), second))


def _std(
    kept: Float[np.ndarray, "rows columns"], columns: Columns, name: str, sensor: Sensor
) -> Float[np.ndarray, "rows channels"]:
    """The standard deviation [m] of each value: the row's own, or one reading's over the root of the repeats."""
    lengths = sum(lever is None for lever in sensor.levers)
    if isinstance(sensor, Distances) and columns.stds[name]:  # the largest of its coordinates' for each end
        return np.sqrt(2.0) * kept[:, list(columns.stds[name])].max(axis=1, keepdims=True)
    repeats = np.full(len(kept), float(sensor.repeats)) if columns.repeats is None else kept[:, columns.repeats]
    std = np.repeat((sensor.noise_std / np.sqrt(repeats))[:, None], len(sensor.channels), axis=1)
    if columns.stds[name]:
        std[:, :lengths] = kept[:, list(columns.stds[name])]
    if columns.std_angle is not None and isinstance(sensor, Pose):
        std[:, lengths:] = sensor.lever * kept[:, [columns.std_angle]]
    return std


def _check_strangers(
    table: Table, rows: Int[np.ndarray, "some"], needed: list[int], sensor: str, name: str, problems: Problems
) -> None:
    """Adds a fault for every number that a row has and its sensor does not report: it would not be used."""
    read = {column for values in table.columns.values.values() for column in values}
    strangers = sorted(read - set(needed))
    for row, place in zip(*np.nonzero(~np.isnan(table.numbers[rows][:, strangers])), strict=True):
        problems.add(
            f"{name}, line {table.line[rows[row]]}: {table.columns.names[strangers[place]]}: "
            f"sensor {sensor} does not read it; expected an empty cell"
        )


def _check_quaternions(
    table: Table, rows: Int[np.ndarray, "some"], columns: tuple[int, ...], name: str, problems: Problems
) -> None:
    lengths = np.linalg.norm(table.numbers[rows][:, list(columns)], axis=1)
    for row in np.flatnonzero(np.abs(lengths - 1.0) > NEARLY_UNIT):
        problems.add(
            f"{name}, line {table.line[rows[row]]}: the quaternion {', '.join(QUATERNION)} has length "
            f"{lengths[row]:.6g}; expected 1: w first, then x, y and z"
        )


def _check_certainty(table: Table, name: str) -> None:
    """Raises an `InputError` for stated uncertainties that no measurement can have."""
    problems = Problems()
    columns = table.columns
    stds = {column for stds in columns.stds.values() for column in stds}
    for column in sorted(stds | ({columns.std_angle} if columns.std_angle is not None else set())):
        for row in np.flatnonzero(table.numbers[:, column] < SMALLEST):
            problems.add(
                f"{name}, line {table.line[row]}: {columns.names[column]}: got {table.numbers[row, column]:g}; "
                f"expected a standard deviation above 0; leave the cell empty to set the row aside"
            )
    if columns.repeats is not None:
        repeats = table.numbers[:, columns.repeats]
        for row in np.flatnonzero(np.isfinite(repeats) & ((repeats < 1.0) | (repeats != np.floor(repeats)))):
            problems.add(
                f"{name}, line {table.line[row]}: repeats: got {repeats[row]:g}; expected a whole number from 1"
            )
    problems.raise_if_any()
