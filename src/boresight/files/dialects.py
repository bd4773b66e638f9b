"""Two dialects of observations files, FIGAROH's and Leica's export, put into the house's words.

Only words and units change: every row stays on its line, so that what is wrong with it is told of the user's file.

FIGAROH (figaroh 1.0.2, `calibration/data_loader.py`): a marker's `x1, y1, z1` [m] and `phix1, phiy1, phiz1` [rad],
roll, pitch and yaw about fixed axes (R = Rz Ry Rx, `pin.rpy.matrixToRpy`), then a column a joint [rad].
Leica: `X [mm], Y [mm], Z [mm], U(95) [mm], Q0, Q1, Q2, Q3, Temperature [C], Time Stamp` and others.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain

from boresight.arm import Joint
from boresight.errors import InputError
from boresight.files.numbers import number_of
from boresight.files.problems import Problems, listed, printable
from boresight.files.sheets import Row, Sheet
from boresight.units import Units

POSITION, QUATERNION = ("x", "y", "z"), ("qw", "qx", "qy", "qz")
_ANGLES = ("phix", "phiy", "phiz")
_MARKER = re.compile(r"(x|y|z|phix|phiy|phiz)(\d+)", re.ASCII)
_LEICA = re.compile(r"([XYZ]) ?\[(mm|m)\]")
_UNCERTAINTY = re.compile(r"U ?\(95 ?%?\) ?\[(mm|m|um|µm)\]")
_TEMPERATURE = re.compile(r"Temperature ?\[°?C\]")
_TIME = ("Time Stamp", "Timestamp", "TimeStamp")
_PLAIN = ("t", "time", "session", "target", "repeats", "temperature")
"""Columns beside FIGAROH's that are taken over as they stand."""

_METRES = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "µm": 1e-6}
_TWO_SIGMA = 0.5
"""U(95) is an expanded uncertainty with k = 2."""


@dataclass
class Translation:
    """What becomes of a dialect's columns.

    Attributes:
        dialect: its name.
        columns: our name, the columns it is made of, and the function from their cells to ours.
        left_out: names of columns that mean nothing here.
    """

    dialect: str
    columns: list[tuple[str, tuple[int, ...], Callable[..., str]]] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)

    def add(self, name: str, function: Callable[..., str], *places: int) -> None:
        """Adds one of our columns."""
        self.columns.append((name, places, function))

    @property
    def header(self) -> list[str]:
        """Our names."""
        return [name for name, _, _ in self.columns]

    def row(self, cells: Sequence[str]) -> list[str]:
        """Returns our cells of a row."""
        return [function(*(cells[place] for place in places)) for _, places, function in self.columns]


def translation_of(
    header: Sequence[str], joints: Sequence[Joint], units: Units, marker: int | None = None
) -> Translation | None:
    """Returns what becomes of a file's columns; None where it is in no known dialect.

    Args:
        header: the names in its first row.
        joints: the arm's; in a Leica export other columns than these and its own are left out.
        units: to translate to.
        marker: which of FIGAROH's markers; the only one by default.

    Raises:
        InputError: there are several markers and none was chosen, or not this one.
    """
    if sum(_LEICA.fullmatch(name) is not None for name in header) == len(POSITION):
        return _leica(header, joints, units)
    markers = {int(found[2]) for name in header if (found := _MARKER.fullmatch(name)) and found[1] in POSITION}
    ours = {"range", "distance", *POSITION, *(joint.name for joint in joints if _MARKER.fullmatch(joint.name))}
    return _figaroh(header, joints, units, markers, marker) if markers and not ours & set(header) else None


def in_house_words(
    sheet: Sheet, joints: Sequence[Joint], units: Units, marker: int | None = None
) -> tuple[Sheet, Translation | None]:
    """Returns a file's rows in the house's words, and what becomes of its columns; None where nothing does.

    Args:
        sheet: the rows; they are gone through by going through what is returned.
        joints: the arm's.
        units: to translate to.
        marker: which of FIGAROH's markers; the only one by default.

    Raises:
        InputError: the file cannot be read, there are several markers and none was chosen, or not this one.
    """
    first = next(sheet.rows, None)
    if first is None:
        return sheet, None
    try:
        translation = translation_of([name.strip() for name in first[1]], joints, units, marker)
    except InputError as error:
        raise InputError(printable(f"{sheet.name}: {error}")) from None
    if translation is None:
        return Sheet(sheet.name, chain([first], sheet.rows), sheet.notes), None
    return Sheet(sheet.name, _translated(sheet, first, translation), sheet.notes), translation


def _translated(sheet: Sheet, header: Row, translation: Translation) -> Iterator[Row]:
    """Yields rows in the house's words; those of another length are told when all others have been seen."""
    line, names = header
    yield line, translation.header
    problems = Problems()
    for line, cells in sheet.rows:
        if len(cells) == len(names):
            yield line, translation.row(cells)
        else:
            problems.add(f"{sheet.name}, line {line}: {len(cells)} cells; expected {len(names)}, as in the header")
    problems.raise_if_any()


def _figaroh(
    header: Sequence[str], joints: Sequence[Joint], units: Units, markers: set[int], marker: int | None
) -> Translation:
    known = ", ".join(map(str, sorted(markers)))
    if marker is None and len(markers) > 1:
        raise InputError(
            f"the file holds the markers {known}; choose one: boresight import FILE --marker {min(markers)}"
        )
    chosen = min(markers) if marker is None else marker
    if chosen not in markers:
        raise InputError(f"there is no marker {chosen}; the file holds {known}")
    found, at = Translation("FIGAROH"), {name: place for place, name in enumerate(header)}
    turning = {joint.name: joint.type == "revolute" for joint in joints}
    whole = bool(turning) and set(turning) <= set(header)
    angles = [at.get(f"{angle}{chosen}") for angle in _ANGLES]
    for name, place in at.items():
        match = _MARKER.fullmatch(name)
        if match is None and name == "session_id":
            found.add("session", str.strip, place)
        elif match is None and name.casefold() in _PLAIN:
            found.add("time" if name == "t" else name.casefold(), str.strip, place)
        elif match is None and whole and name not in turning:
            found.left_out.append(name)
        elif match is None:
            found.add(name, _scaled(1.0 / (units.radians if turning.get(name, True) else units.metres)), place)
        elif match[1] in POSITION and int(match[2]) == chosen:
            found.add(match[1], _scaled(1.0 / units.metres), place)
        elif int(match[2]) != chosen or None in angles:
            found.left_out.append(name)
    places = [place for place in angles if place is not None]
    for part, name in enumerate(QUATERNION if len(places) == len(angles) else ()):
        found.add(name, _quaternion(part), *places)
    return found


def _leica(header: Sequence[str], joints: Sequence[Joint], units: Units) -> Translation:
    found = Translation("Leica")
    names = {joint.name for joint in joints}
    plain = {f"Q{part}": name for part, name in enumerate(QUATERNION)} | dict.fromkeys(_TIME, "time")
    for place, name in enumerate(header):
        if coordinate := _LEICA.fullmatch(name):
            found.add(coordinate[1].lower(), _scaled(_METRES[coordinate[2]] / units.metres), place)
        elif uncertainty := _UNCERTAINTY.fullmatch(name):
            found.add("std", _scaled(_TWO_SIGMA * _METRES[uncertainty[1]] / units.metres), place)
        elif name in plain or name in names or _TEMPERATURE.fullmatch(name):
            found.add(plain.get(name, name if name in names else "temperature"), str.strip, place)
        else:
            found.left_out.append(name)
    return found


def _scaled(factor: float) -> Callable[[str], str]:
    def scaled(cell: str) -> str:
        try:
            return cell.strip() if factor == 1.0 else repr(number_of(cell) * factor)
        except ValueError:
            return cell  # for the reader, who says what is wrong with it

    return scaled


def _quaternion(part: int) -> Callable[[str, str, str], str]:
    """Returns the function from roll, pitch and yaw [rad] about fixed axes to one number of their quaternion."""

    def number(*cells: str) -> str:
        try:
            halves = [number_of(cell) / 2.0 for cell in cells]
        except ValueError:
            return ""
        (cr, cp, cy), (sr, sp, sy) = ([f(half) for half in halves] for f in (math.cos, math.sin))
        w, x = cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy
        y, z = cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy
        return repr((w, x, y, z)[part])

    return number


def described(translation: Translation) -> str:
    """Returns what was done to a file, in words."""
    left = f"; columns without a meaning here: {listed(translation.left_out)}" if translation.left_out else ""
    return f"The file is {translation.dialect}'s{left}."
