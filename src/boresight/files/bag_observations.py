"""A campaign's observations straight out of a ROS bag."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from boresight.errors import InputError
from boresight.files.observations import Observations, observations_of
from boresight.files.problems import printable
from boresight.files.recorded import Recorded, read_recorded, rows_csv
from boresight.files.schemas import DataEntry
from boresight.files.sheets import sheet_of
from boresight.files.sources import Source
from boresight.files.topics import Choice
from boresight.recordings import Rules
from boresight.sensing import Cell
from boresight.units import Units, in_millimetres

_KINDS = {"laser_ranger": "range", "position": "position"}
_TOLD = 3
_ALIKE = 1.2
_LOUD = 3.0
"""Readings that scatter this many times as much, or as little, as the campaign says are worth a word."""


def read_bag_observations(path: Path, *, cell: Cell, entry: DataEntry, named_by: str = "") -> Observations:
    """Returns the readings of a bag, in metres and radians; their lines are those of the CSV that `import` writes.

    Args:
        path: of the bag.
        cell: the arm, the sensor and the targets that it is about.
        entry: what the campaign says of it.
        named_by: the place that names it, as the beginning of a sentence.

    Raises:
        InputError: it cannot be read, or not one row can be made of it.
    """
    types = [sensor.type for sensor in cell.sensors.values()]
    kind = _KINDS.get(types[0]) if len(types) == 1 and len(cell.mounts) == 1 else None
    if kind is None:
        raise InputError(
            f"{named_by}a bag holds readings of one {' or '.join(_KINDS)} on one mount, not of {', '.join(types)}"
            f"{' on several markers' if len(cell.mounts) > 1 else ''}; import it to a CSV file first"
        )
    try:
        recorded = read_recorded(path, entry.name, choice_of(entry), cell.arm.joint_names, kind)
    except InputError as error:
        raise InputError([f"{named_by}{problem}" for problem in error.problems]) from None
    rows = sheet_of(Source(path, entry.name, rows_csv(recorded).encode()))
    found = observations_of(rows, cell, Units())
    warnings = (*recorded.bag.losses, *_scatter(recorded, cell), *found.warnings)
    notes = [f"{entry.name}: {remark}" for remark in remarks_of(recorded)]
    notes += [
        f"{entry.name}: Its lines, where any are named, are those of the file that `boresight import` makes of it."
    ]
    return replace(found, warnings=warnings, sha256=recorded.bag.sha256, notes=tuple(notes))


def choice_of(entry: DataEntry) -> Choice:
    """Returns what a campaign says of a bag."""
    return Choice(
        entry.joints,
        entry.range,
        entry.position,
        entry.target,
        entry.targets,
        entry.time_offset,
        Rules(entry.still_speed, entry.still_time, entry.settle),
    )


def remarks_of(recorded: Recorded) -> tuple[str, ...]:
    """Returns how the rows of a bag came to be, a sentence each."""
    rows, empty = recorded.rows, [f"{count} ({reason})" for reason, count in recorded.empty.items()]
    repeats = int(np.median(rows.repeats))
    phases = f"{len(rows)} of {len(rows) + len(rows.skipped)} still phases gave a row each"
    remarks = [f"{phases}, of {repeats} readings in the median."]
    remarks += [f"No row from {s.start:.2f} s to {s.end:.2f} s: {s.reason}." for s in rows.skipped[:_TOLD]]
    remarks += [f"No row of {len(rows.skipped) - _TOLD} more phases."] if len(rows.skipped) > _TOLD else []
    remarks += [f"Readings without a value: {', '.join(empty)}."] if empty else []
    remarks += [f"{rows.outlying} readings were left out as gross errors of their phase."] if rows.outlying else []
    if rows.likeness > _ALIKE:
        remarks += [f"Neighbouring readings are alike, which makes the means {rows.likeness:.1f} times less certain."]
    return tuple(printable(remark) for remark in (*remarks, *recorded.remarks))


def _scatter(recorded: Recorded, cell: Cell) -> list[str]:
    """A warning where the readings scatter otherwise than the campaign says."""
    seen, stated = float(np.median(recorded.rows.scatter)), next(iter(cell.sensors.values())).noise_std
    if not recorded.scatters:
        return [
            f"{recorded.bag.name}: the readings of a phase do not differ, so the campaign's noise_std counts for them"
        ]
    if stated / _LOUD <= seen <= stated * _LOUD:
        return []
    return [
        f"{recorded.bag.name}: one reading scatters by {in_millimetres(seen)} (median), where noise_std says "
        f"{in_millimetres(stated)}; the rows have the standard deviations that were seen"
    ]
