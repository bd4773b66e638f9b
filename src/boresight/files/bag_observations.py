"""A campaign's observations straight out of a ROS bag."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from boresight.errors import InputError
from boresight.files.observations import Observations, observations_of
from boresight.files.problems import listed, printable
from boresight.files.recorded import Recorded, read_recorded, rows_csv, sliding_joints
from boresight.files.schemas import DataEntry
from boresight.files.sheets import sheet_of
from boresight.files.sources import Source
from boresight.files.topics import CHANNELS, Choice
from boresight.recordings import Rules
from boresight.sensing import Cell, Pose
from boresight.units import Units, in_millimetres

_KINDS = {("range",): "range", ("distance",): "range"} | {CHANNELS[kind]: kind for kind in ("position", "pose")}
"""What is read in a bag, by the columns of the sensor it is for."""

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
    kind = _kind(cell, named_by)
    try:
        recorded = read_recorded(
            path, entry.name, choice_of(entry), cell.arm.joint_names, kind, sliding=sliding_joints(cell.arm.driven)
        )
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


def _kind(cell: Cell, named_by: str) -> str:
    """Returns what is read in a bag for a cell.

    Raises:
        InputError: there are several sensors or markers, or the sensor reports nothing.
    """
    several = {key: list(each) for key, each in (("sensor", cell.sensors), ("marker", cell.mounts)) if len(each) > 1}
    if several:
        told = " and ".join(f"{len(names)} {key}s ({listed(names)})" for key, names in several.items())
        raise InputError(
            printable(
                f"{named_by}a bag gives the rows of one sensor on one marker, and the campaign has {told}; make a CSV "
                "file of each with `boresight import`, naming its topic, and join them into one with the names in a "
                f"column {' and a column '.join(several)}"
            )
        )
    (sensor,) = cell.sensors.values()
    if sensor.columns not in _KINDS:
        raise InputError(
            f"{named_by}a bag holds no readings of a {sensor.type}; write the joints of each reading into a CSV file"
        )
    return _KINDS[sensor.columns]


def choice_of(entry: DataEntry) -> Choice:
    """Returns what a campaign says of a bag."""
    return Choice(
        entry.joints,
        entry.range,
        entry.position,
        entry.pose,
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
    """Warnings where the readings scatter otherwise than the campaign says."""
    sensor = next(iter(cell.sensors.values()))
    angle, warnings = recorded.angle_scatter, []
    if angle and isinstance(sensor, Pose) and not 1.0 / _LOUD <= angle / sensor.noise_angle_std <= _LOUD:
        warnings.append(
            f"{recorded.bag.name}: one reading's orientation scatters by {angle:.3g} rad (median), where "
            f"noise_angle_std says {sensor.noise_angle_std:.3g} rad; the rows have what was seen"
        )
    return [*_scatter_of_lengths(recorded, sensor.noise_std), *warnings]


def _scatter_of_lengths(recorded: Recorded, stated: float) -> list[str]:
    seen = float(np.median(recorded.rows.scatter[recorded.lengths]))
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
