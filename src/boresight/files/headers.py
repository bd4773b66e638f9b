"""Column names as people write them, read as the names that are known where there is no doubt.

`Range`, `range [mm]`, `range_mm` and `RANGE (mm)` are the column range, the last three in millimetres; `q1` to `q6` are
the joints of an arm of six in their order, where the file has none of their own names.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

from boresight.files.numbers import number_of
from boresight.files.problems import printable
from boresight.files.sheets import Sheet
from boresight.units import Quantity, Units

_IN_BRACKETS = re.compile(r"(.*?)[ _]*[\[(]\s*([^\[\]()]*?)\s*[\])]")
_AFTER_UNDERSCORE = re.compile(r"(.*)_(mm|m|deg|rad)")
_NUMBERED = re.compile(r"(?i)(q|j|a|joint|axis|theta)[ _-]?0*(\d+)", re.ASCII)
_UNITS: dict[str, Units] = {
    **dict.fromkeys(("m", "metre", "metres", "meter", "meters"), Units(length="m")),
    **dict.fromkeys(("mm", "millimetre", "millimetres", "millimeter", "millimeters"), Units(length="mm")),
    **dict.fromkeys(("rad", "radian", "radians"), Units(angle="rad")),
    **dict.fromkeys(("deg", "degree", "degrees", "°"), Units(angle="deg")),
}
_QUANTITY: dict[str, Quantity] = {word: "angle" if word[0] in "rd°" else "length" for word in _UNITS}
_TIMES = ("t", "timestamp", "time_stamp", "time stamp", "stamp", "time [s]", "time_s")
_MANY = 8


@dataclass(frozen=True, slots=True)
class Column:
    """How a column is read.

    Attributes:
        name: the known name; the given one where none is meant.
        factor: from the unit in its name to the file's; 1 where its name has none.
        unit: as its name has it, "" where it has none.
    """

    name: str
    factor: float = 1.0
    unit: str = ""


def read_header(
    header: Sequence[str], known: Mapping[str, Quantity | None], joints: Sequence[str], units: Units
) -> list[Column]:
    """Returns how each column of a header is read.

    Args:
        header: the names in the file.
        known: the names that a column may have, and what it measures; None for what has no unit.
        joints: the arm's joints, which are among the known names.
        units: of the file.
    """
    found = [_column(name, known, units) for name in header]
    counts = {name: sum(column.name == name for column in found) for name in known}
    for place, column in enumerate(found):
        if column.name != header[place] and counts.get(column.name, 0) > 1:
            found[place] = Column(header[place])  # another column has that name, perhaps by right
    if not set(joints) & {column.name for column in found}:
        for place, (name, factor, unit) in _numbered(header, known, joints, units).items():
            found[place] = Column(name, factor, unit)
    return found


def with_known_names(sheet: Sheet, known: Mapping[str, Quantity | None], joints: Sequence[str], units: Units) -> Sheet:
    """Returns a file's rows under the known names, numbers in the file's units, with a note where that changed it."""
    first = next(sheet.rows, None)
    if first is None:
        return sheet
    line, cells = first
    header = [name.strip() for name in cells]
    columns = read_header(header, known, joints, units)
    changed = [(name, column) for name, column in zip(header, columns, strict=True) if name != column.name]
    if not changed:
        return Sheet(sheet.name, chain([first], sheet.rows), sheet.notes)
    sheet.notes.append(_described(changed))
    factors = {place: column.factor for place, column in enumerate(columns) if column.factor != 1.0}
    renamed = (line, [column.name for column in columns])
    return Sheet(sheet.name, chain([renamed], _scaled(sheet, factors) if factors else sheet.rows), sheet.notes)


def _column(name: str, known: Mapping[str, Quantity | None], units: Units) -> Column:
    if name in known:
        return Column(name)
    meant = _known(name, known)
    if meant is not None:
        return Column(meant)
    if "time" in known and name.casefold() in _TIMES:
        return Column("time")
    base, unit = _without_unit(name)
    meant = None if unit is None else _known(base, known)
    if unit is None or meant is None or known[meant] != _QUANTITY[unit]:
        return Column(name)
    return Column(meant, _factor(unit, units), unit)


def _known(name: str, known: Mapping[str, Quantity | None]) -> str | None:
    """Returns the only known name that differs in case at most."""
    alike = [each for each in known if each.casefold() == name.casefold()]
    return name if name in known else alike[0] if len(alike) == 1 else None


def _without_unit(name: str) -> tuple[str, str | None]:
    """Returns a name and the unit that stood behind it."""
    for pattern in (_IN_BRACKETS, _AFTER_UNDERSCORE):
        match = pattern.fullmatch(name)
        if match is not None and match[2].casefold() in _UNITS and match[1].strip():
            return match[1].strip(), match[2].casefold()
    return name, None


def _factor(unit: str, units: Units) -> float:
    quantity = _QUANTITY[unit]
    return _UNITS[unit].scale(quantity) / units.scale(quantity)


def _numbered(
    header: Sequence[str], known: Mapping[str, Quantity | None], joints: Sequence[str], units: Units
) -> dict[int, tuple[str, float, str]]:
    """Returns the places of columns that number the joints, one for each from 0 or 1 on, with what each is read as."""
    series: dict[str, dict[int, tuple[int, str | None]]] = {}
    for place, name in enumerate(header):
        base, unit = _without_unit(name)
        match = _NUMBERED.fullmatch(base)
        if match is not None:
            series.setdefault(match[1].casefold(), {})[int(match[2])] = (place, unit)
    count = len(joints)
    whole = [each for each in series.values() if sorted(each) in (list(range(count)), list(range(1, count + 1)))]
    if len(whole) != 1:
        return {}
    found = {}
    for joint, (place, unit) in zip(joints, (whole[0][number] for number in sorted(whole[0])), strict=True):
        if unit is not None and _QUANTITY[unit] != known[joint]:
            return {}
        found[place] = (joint, 1.0 if unit is None else _factor(unit, units), unit or "")
    return found


def _scaled(sheet: Sheet, factors: Mapping[int, float]) -> Iterator[tuple[int, list[str]]]:
    for line, cells in sheet.rows:
        for place, factor in factors.items():
            if place < len(cells):
                cells[place] = _times(cells[place], factor)
        yield line, cells


def _times(cell: str, factor: float) -> str:
    try:
        return repr(number_of(cell) * factor)
    except ValueError:
        return cell  # for the reader, who says what is wrong with it


def _described(changed: Sequence[tuple[str, Column]]) -> str:
    said = [f"{name} as {column.name}{f' in {column.unit}' if column.unit else ''}" for name, column in changed[:_MANY]]
    more = f" and {len(changed) - _MANY} more" if len(changed) > _MANY else ""
    return printable(f"columns are read as the names that are known: {', '.join(said)}{more}")
