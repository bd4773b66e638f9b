"""The columns of an observations file: which cell of a row is which number."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from boresight.errors import did_you_mean
from boresight.files.problems import Problems, listed, shown
from boresight.sensing import Cell
from boresight.units import Units

OTHER_NAMES = {"range": "distance"}
"""A second name that a channel's column may have."""

IGNORED = ("time", "temperature", "session", "qw", "qx", "qy", "qz")
"""Columns that may be there and do not enter the model."""


@dataclass(frozen=True, slots=True)
class Columns:
    """Where the cells of a row are.

    Attributes:
        width: cells in a row.
        names: of the numeric columns, in the order of `places`: joints, channels, then `std` and `repeats`.
        places: their places in the row.
        scales: the factors to metres and radians.
        joints, channels, stds: how many of each.
        repeats: whether the last numeric column is `repeats`.
        target: the place of the target's name; None where every row has the same target or none.
    """

    width: int
    names: tuple[str, ...]
    places: tuple[int, ...]
    scales: tuple[float, ...]
    joints: int
    channels: int
    stds: int
    repeats: bool
    target: int | None


def read_columns(
    header: Sequence[str], cell: Cell, units: Units, place: str, problems: Problems, *, need_values: bool = True
) -> Columns:
    """Returns the columns that a header names; they make no sense where a problem was added.

    Args:
        header: the cells of the first row.
        cell: the arm and the sensor that the file is about.
        units: of the file.
        place: the header's place, as the beginning of a sentence.
        problems: where faults are added.
        need_values: whether columns of configurations alone, without any of the sensor's, are a fault.
    """
    if len(header) == 1 and (";" in header[0] or "\t" in header[0]):
        problems.add(f"{place}the columns are not separated by commas; expected j1,j2,... with decimal points")
        return Columns(1, (), (), (), 0, 0, 0, False, None)
    at = {name: column for column, name in enumerate(header)}
    channels = known = _channels(cell, at, place, problems)
    if not need_values and not any(channel in at for channel in channels):
        channels = ()
    stds = _stds(cell, channels, at, place, problems)
    _check_names(header, cell, known, channels, place, problems)
    wants_target = cell.sensor.needs_target and "target" in at
    if cell.sensor.needs_target and "target" not in at and len(cell.targets) > 1:
        problems.add(
            f"{place}there is no column target; expected one, to tell which of {listed(cell.targets)} a row is of"
        )
    repeats = ("repeats",) if "repeats" in at else ()
    names = (*cell.arm.joint_names, *channels, *stds, *repeats)
    angles = [units.radians if joint.type == "revolute" else units.metres for joint in cell.arm.joints]
    return Columns(
        width=len(header),
        names=names,
        places=tuple(at.get(name, 0) for name in names),
        scales=(*angles, *[units.metres] * (len(channels) + len(stds)), *[1.0] * len(repeats)),
        joints=len(cell.arm.joints),
        channels=len(channels),
        stds=len(stds),
        repeats=bool(repeats),
        target=at["target"] if wants_target else None,
    )


def _channels(cell: Cell, at: dict[str, int], place: str, problems: Problems) -> tuple[str, ...]:
    """The sensor's columns, by the names that this file gives them."""
    chosen = []
    for channel in cell.sensor.channels:
        other = OTHER_NAMES.get(channel, channel)
        if channel != other and channel in at and other in at:
            problems.add(f"{place}there are columns {channel} and {other}, which mean the same; expected one of them")
        chosen.append(other if channel not in at and other in at else channel)
    return tuple(chosen)


def _stds(cell: Cell, channels: Sequence[str], at: dict[str, int], place: str, problems: Problems) -> tuple[str, ...]:
    each = [f"std_{channel}" for channel in channels]
    given = [name for name in each if name in at]
    if "std" in at and given:
        problems.add(
            f"{place}there are columns std and {listed(given)}; expected either std or one for each coordinate"
        )
    elif given and given != each:
        problems.add(
            f"{place}there is no column {listed(n for n in each if n not in at)} beside {listed(given)}; expected all"
        )
    return ("std",) if "std" in at else tuple(given)


def _check_names(
    header: Sequence[str],
    cell: Cell,
    known_channels: Sequence[str],
    channels: Sequence[str],
    place: str,
    problems: Problems,
) -> None:
    joints = cell.arm.joint_names
    needed = (*joints, *channels)
    optional = ("target", "std", *(f"std_{channel}" for channel in known_channels), "repeats", *IGNORED)
    known = dict.fromkeys((*joints, *known_channels, *(OTHER_NAMES.get(name, name) for name in known_channels), *optional))
    for name in sorted(set(joints) & {*known_channels, *optional}):
        problems.add(f"{place}{name} is a joint and a column of its own meaning; call the joint something else")
    counts = Counter(header)
    for column, name in enumerate(header, start=1):
        if not name:
            problems.add(f"{place}column {column} has no name; is there a comma too many?")
        elif counts[name] > 1 and column == header.index(name) + 1:
            problems.add(f"{place}there are several columns {shown(name)}; expected one")
        elif name not in known:
            near = "" if problems.full else did_you_mean(name[:60], known)
            others = f"{listed((*joints, *known_channels))} and, if wanted, {listed(optional)}"
            problems.add(f"{place}unknown column {shown(name)}{near}; expected columns {others}")
    columns = listed(map(shown, header))
    if channels and not set(channels) & set(header) and set(joints) <= set(header):
        problems.add(
            f"{place}there are configurations but no readings, no column for {listed(channels)}; the columns are "
            f"{columns}; `boresight inspect` needs no readings, anything else does"
        )
        return
    for name in needed:
        if name not in header:
            kind = f"joint {name}" if name in joints else name
            problems.add(f"{place}there is no column for {kind}; the columns are {columns}")
