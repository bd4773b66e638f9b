"""The columns of an observations file: which cell of a row is which number."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from boresight.errors import did_you_mean
from boresight.files.problems import Problems, listed, shown
from boresight.sensing import Cell, Pose, Sensor
from boresight.sensing.aims import targets_of
from boresight.units import Quantity, Units

OTHER_NAMES = {"range": "distance", "distance": "range"}
"""A second name that a sensor's column may have."""

STD_ANGLE = "std_angle"
"""The column of a pose's standard deviation about each axis."""

KEYS = ("sensor", "marker", "target", "session")
"""Columns of names."""

QUATERNION = ("qw", "qx", "qy", "qz")

NEARLY_UNIT = 0.01
"""A quaternion whose length is farther from 1 is not a rounded one."""

IGNORED = ("time", "temperature", *QUATERNION)
"""Columns that may be there and do not enter the model."""


@dataclass(frozen=True, slots=True)
class Columns:
    """Where the cells of a row are.

    Attributes:
        width: cells in a row.
        names: of the numeric columns: joints, values, standard deviations, then `repeats`.
        places: their places in the row.
        scales: the factors to metres and radians.
        joints: how many of them are joints.
        values: by sensor the numeric columns it reports, in its order.
        stds: by sensor the numeric columns of their standard deviations: none, one for all, or one each.
        std_angle: the numeric column of `std_angle`; None where there is none.
        repeats: the numeric column of `repeats`; None where there is none.
        keys: the places in the row of the columns of names that are used.
        planned: whether there are configurations alone.
    """

    width: int = 1
    names: tuple[str, ...] = ()
    places: tuple[int, ...] = ()
    scales: tuple[float, ...] = ()
    joints: int = 0
    values: dict[str, tuple[int, ...]] = field(default_factory=dict)
    stds: dict[str, tuple[int, ...]] = field(default_factory=dict)
    std_angle: int | None = None
    repeats: int | None = None
    keys: dict[str, int] = field(default_factory=dict)
    planned: bool = False

    def needed(self, sensor: str, kind: Sensor) -> list[int]:
        """Returns the numeric columns that a row of a sensor must have."""
        angle = [self.std_angle] if self.std_angle is not None and isinstance(kind, Pose) else []
        repeats = [self.repeats] if self.repeats is not None else []
        return [*range(self.joints), *self.values[sensor], *self.stds[sensor], *angle, *repeats]


def read_columns(
    header: Sequence[str], cell: Cell, units: Units, place: str, problems: Problems, *, need_values: bool = True
) -> Columns:
    """Returns the columns that a header names; they make no sense where a problem was added.

    Args:
        header: the cells of the first row.
        cell: the arm and the sensors that the file is about.
        units: of the file.
        place: the header's place, as the beginning of a sentence.
        problems: where faults are added.
        need_values: whether columns of configurations alone, without any of the sensors', are a fault.
    """
    at = {name: column for column, name in enumerate(header)}
    of = {name: _values(cell, sensor, at, place, problems) for name, sensor in cell.sensors.items()}
    known = tuple(dict.fromkeys(column for columns in of.values() for column in columns))
    planned = not need_values and bool(known) and not any(column in at for column in known)
    stds = {name: _stds(columns, at, place, problems) for name, columns in of.items()}
    _check_names(header, cell, known, () if planned else known, place, problems)
    angle = STD_ANGLE in at and any(isinstance(sensor, Pose) for sensor in cell.sensors.values())
    extra = (*((STD_ANGLE,) if angle else ()), *(("repeats",) if "repeats" in at else ()))
    spread = tuple(dict.fromkeys(column for columns in stds.values() for column in columns))
    joints = cell.arm.joint_names
    names = (*joints, *(() if planned else known), *spread, *extra)
    scale = {joint.name: units.radians if joint.type == "revolute" else units.metres for joint in cell.arm.driven}
    scale |= dict.fromkeys((*QUATERNION, "repeats"), 1.0) | {STD_ANGLE: units.radians}
    index = {name: column for column, name in enumerate(names)}
    return Columns(
        width=len(header),
        names=names,
        places=tuple(at.get(name, 0) for name in names),
        scales=tuple(scale.get(name, units.metres) for name in names),
        joints=len(joints),
        values={name: () if planned else tuple(index[c] for c in columns) for name, columns in of.items()},
        stds={name: tuple(index[c] for c in columns) for name, columns in stds.items()},
        std_angle=index.get(STD_ANGLE),
        repeats=index.get("repeats"),
        keys=_keys(cell, at, place, problems),
        planned=planned,
    )


def clashes(cell: Cell) -> list[str]:
    """Returns the joints that are called as a column of a sensor's, or of its certainty, is."""
    values = [column for sensor in cell.sensors.values() for column in sensor.columns]
    meant = {*values, *map(_other_name, values), STD_ANGLE, *_optional(cell, values)}
    return [name for name in cell.arm.joint_names if name in meant]


def known_columns(cell: Cell) -> dict[str, Quantity | None]:
    """Returns the names that columns of a cell's observations may have, and what each measures."""
    values = dict.fromkeys(column for sensor in cell.sensors.values() for column in sensor.columns)
    names: dict[str, Quantity | None] = {
        joint.name: "angle" if joint.type == "revolute" else "length" for joint in cell.arm.driven
    }
    names |= {name: None if name in QUATERNION else "length" for name in (*values, *map(_other_name, values))}
    return {**names, **_optional(cell, values)}


def _optional(cell: Cell, values: Iterable[str]) -> dict[str, Quantity | None]:
    """Returns the columns that may stand beside those of joints and values, and what each measures."""
    has_pose = any(isinstance(sensor, Pose) for sensor in cell.sensors.values())
    lengths = ("std", *(f"std_{column}" for column in values if column not in QUATERNION))
    angles: dict[str, Quantity | None] = {STD_ANGLE: "angle"} if has_pose else {}
    return {
        **dict.fromkeys(KEYS),
        **dict.fromkeys(lengths, "length"),
        **angles,
        **dict.fromkeys(("repeats", *IGNORED)),
    }


def _other_name(column: str) -> str:
    return OTHER_NAMES.get(column, column)


def _keys(cell: Cell, at: dict[str, int], place: str, problems: Problems) -> dict[str, int]:
    """The columns of names that are needed or help, and faults for those that are needed and not there."""
    choices = {
        "sensor": tuple(cell.sensors),
        "marker": max((_markers(cell, name) for name in cell.sensors), key=len),
        "target": max((targets_of(sensor, cell.targets) for sensor in cell.sensors.values()), key=len),
    }
    for key, known in choices.items():
        if len(known) > 1 and key not in at:
            names = listed(name for name in known if name)
            problems.add(f"{place}there is no column {key}; expected one, to tell which of {names} a row is of")
    used = {"sensor": True, "marker": isinstance(cell.mount, dict), "target": choices["target"] != (None,)}
    return {key: at[key] for key in KEYS if key in at and used.get(key, True)}


def _markers(cell: Cell, sensor: str) -> tuple[str, ...]:
    """The mounts on which a sensor can be, or at which it can look."""
    return tuple(dict.fromkeys(aim.mount for aim in cell.aims if aim.sensor == sensor))


def _values(cell: Cell, sensor: Sensor, at: dict[str, int], place: str, problems: Problems) -> tuple[str, ...]:
    """The sensor's columns, by the names that this file gives them."""
    chosen, taken = [], {column for each in cell.sensors.values() if each is not sensor for column in each.columns}
    for column in sensor.columns:
        other = _other_name(column)
        if column != other and column in at and other in at and other not in taken:
            problems.add(f"{place}there are columns {column} and {other}, which mean the same; expected one of them")
        chosen.append(other if column not in at and other in at else column)
    return tuple(chosen)


def _stds(columns: Sequence[str], at: dict[str, int], place: str, problems: Problems) -> tuple[str, ...]:
    each = [f"std_{column}" for column in columns if column not in QUATERNION]
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
    known_values: Sequence[str],
    values: Sequence[str],
    place: str,
    problems: Problems,
) -> None:
    joints = cell.arm.joint_names
    optional = _optional(cell, known_values)
    other_names = map(_other_name, known_values)
    # A pose's uncertainty may stand beside its quaternion where only its position is used.
    known = dict.fromkeys((*joints, *known_values, *other_names, *optional, STD_ANGLE))
    counts, first = Counter(header), {name: column for column, name in reversed([*enumerate(header, start=1)])}
    unknown = [name for name in dict.fromkeys(header) if name and name not in known]
    for column, name in enumerate(header, start=1):
        if not name:
            problems.add(f"{place}column {column} has no name; is there a comma too many?")
        elif counts[name] > 1 and name in known and column == first[name]:
            problems.add(f"{place}there are several columns {shown(name)}; expected one")
    columns = listed(map(shown, header))
    if not unknown and values and not set(values) & set(header) and set(joints) <= set(header):
        problems.add(
            f"{place}there are configurations but no readings, no column for {listed(values)}; the columns are "
            f"{columns}; `boresight inspect` needs no readings, anything else does"
        )
        return
    missing = [f"joint {name}" if name in joints else name for name in (*joints, *values) if name not in header]
    none = f"no column for {listed(missing)}"
    if unknown:
        near = did_you_mean(unknown[0][:60], known)
        plural = "s" if len(unknown) > 1 else ""
        others = f"{listed((*joints, *known_values))} and, if wanted, {listed(optional)}"
        problems.add(
            f"{place}unknown column{plural} {listed(map(shown, unknown))}{near}{f' and {none}' if missing else ''}; "
            f"expected columns {others}"
        )
    elif missing:
        problems.add(f"{place}there is {none}; the columns are {columns}")
