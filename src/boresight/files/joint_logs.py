"""A tracker's measurements paired with joint readings from another file: row by row, or by time."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np
from jaxtyping import Float

from boresight.errors import InputError
from boresight.files.numbers import number_of
from boresight.files.problems import Problems, listed, printable, shown
from boresight.files.sheets import Sheet
from boresight.recordings import Signal, Trajectory

_FORMATS = ("%m/%d/%Y %H:%M:%S", "%m/%d/%Y %I:%M:%S %p", "%d.%m.%Y %H:%M:%S", "%Y/%m/%d %H:%M:%S")


@dataclass(frozen=True)
class Paired:
    """Measurements with joints.

    Attributes:
        sheet: the rows of an observations.csv.
        left_out: measurements at times at which the joints are not known, by line of their file.
        by_time: whether they were paired by time, not row by row.
    """

    sheet: Sheet
    left_out: tuple[int, ...]
    by_time: bool


def paired(
    measured: Sheet, joints: Sheet, wanted: Sequence[str] | None = None, sliding: Collection[str] = ()
) -> Paired:
    """Returns measurements with the joints of another file beside them, which is in radians and metres.

    Where both files have a column `time`, the joints are interpolated at the times of the measurements; otherwise
    row k of one belongs to row k of the other.

    Args:
        measured: in the house's words.
        joints: a column a joint, and `time` perhaps.
        wanted: the joints to use; all of the file's by default.
        sliding: joints that slide; the others may start again after a full turn.

    Raises:
        InputError: they do not belong together.
    """
    header, rows, lines = _table(measured)
    joint_header, joint_rows, joint_lines = _table(joints)
    names = tuple(wanted or (name for name in joint_header if name != "time"))
    missing = [name for name in names if name not in joint_header]
    if missing or not names:
        given = f"{joints.name}: there is no column for joint {listed(missing)}"
        raise InputError(printable(f"{given}; the columns are {listed(map(shown, joint_header))}"))
    places = [joint_header.index(name) for name in names]
    positions = _numbers(joint_rows, joint_lines, places, joints.name)
    by_time = "time" in header and "time" in joint_header
    if by_time:
        when = _times(rows, lines, header.index("time"), measured.name)
        log = _times(joint_rows, joint_lines, joint_header.index("time"), joints.name)
        signals = {name: Signal.of(log, positions[:, [k]]) for k, name in enumerate(names)}
        found = Trajectory.of(names, signals, sliding=sliding).at(when)
    elif len(rows) != len(joint_rows):
        raise InputError(
            f"{joints.name}: {len(joint_rows)} rows for {len(rows)} measurements of {measured.name}; expected a row "
            "each, or a column time in both files"
        )
    else:
        found = positions
    known = np.isfinite(found).all(axis=1)
    if not known.any():
        raise InputError(f"{joints.name}: the joints are not known at any of the times of {measured.name}")
    kept = [row for row, good in zip(rows, known, strict=True) if good]
    together = [
        [*(f"{number:.10g}" for number in position), *row] for row, position in zip(kept, found[known], strict=True)
    ]
    left_out = tuple(line for line, good in zip(lines, known, strict=True) if not good)
    return Paired(Sheet(measured.name, enumerate([[*names, *header], *together], 1)), left_out, by_time)


def _table(sheet: Sheet) -> tuple[list[str], list[list[str]], list[int]]:
    """Returns the header, the rows of its length and their lines."""
    found = list(sheet.rows)
    if len(found) < 2:
        raise InputError(f"{sheet.name}: there are no rows in it; expected column names and then rows")
    header, problems = [name.strip() for name in found[0][1]], Problems()
    for line, cells in found[1:]:
        if len(cells) != len(header):
            problems.add(f"{sheet.name}, line {line}: {len(cells)} cells; expected {len(header)}, as in the header")
    problems.raise_if_any()
    return header, [cells for _, cells in found[1:]], [line for line, _ in found[1:]]


def _numbers(
    rows: list[list[str]], lines: list[int], places: list[int], name: str
) -> Float[np.ndarray, "rows columns"]:
    numbers, problems = np.full((len(rows), len(places)), np.nan), Problems()
    for k, (cells, line) in enumerate(zip(rows, lines, strict=True)):
        for column, place in enumerate(places):
            try:
                numbers[k, column] = number_of(cells[place])
            except ValueError:
                problems.add(f"{name}, line {line}: got {shown(cells[place])}; expected a number")
    problems.raise_if_any()
    return numbers


def _times(rows: list[list[str]], lines: list[int], place: int, name: str) -> Float[np.ndarray, " rows"]:
    """Returns times [s], of numbers as they stand or of dates, which are taken for UTC where they do not say."""
    times, problems = np.full(len(rows), np.nan), Problems()
    for k, (cells, line) in enumerate(zip(rows, lines, strict=True)):
        time = _time(cells[place].strip())
        if time is None:
            problems.add(
                f"{name}, line {line}: got the time {shown(cells[place])}; expected seconds or 2024-05-01 12:30:00.25"
            )
        else:
            times[k] = time
    problems.raise_if_any()
    return times


def _time(cell: str) -> float | None:
    try:
        return number_of(cell) if abs(number_of(cell)) < 1e12 else None
    except ValueError:
        pass
    for read in (datetime.fromisoformat, *(lambda text, f=f: datetime.strptime(text, f) for f in _FORMATS)):
        try:
            found = read(cell)
        except ValueError:
            continue
        return (found if found.tzinfo else found.replace(tzinfo=UTC)).timestamp()
    return None
