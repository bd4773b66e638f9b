"""Tables that are not quite CSV: semicolons or tabs between columns, decimal commas, empty columns at the end."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from boresight.errors import InputError
from boresight.files.problems import printable, shown

SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs"}

_COMMA = re.compile(r"\s*[-+]?\d*,\d+([eE][-+]?\d+)?\s*", re.ASCII)
_POINT = re.compile(r"\s*[-+]?\d*\.\d+([eE][-+]?\d+)?\s*", re.ASCII)


def separator_of(header: str) -> str:
    """Returns what separates the columns of a header: semicolons or tabs only where it has no comma."""
    return next((each for each in SEPARATORS if each in header), ",")


def with_decimal_points(
    rows: Iterable[tuple[int, list[str]]], name: str, notes: list[str]
) -> Iterator[tuple[int, list[str]]]:
    """Yields rows of a table without commas between its columns, decimal commas written as points.

    Args:
        rows: lines and cells.
        name: what the user calls the file.
        notes: where it is said that there were decimal commas.

    Raises:
        InputError: there are decimal commas and decimal points: one of them may separate thousands.
    """
    seen: dict[str, str] = {}
    for line, cells in rows:
        for place, cell in enumerate(cells):
            if "," in cell and _COMMA.fullmatch(cell):
                seen.setdefault("comma", cell.strip())
                cells[place] = cell.replace(",", ".")
            elif "point" not in seen and _POINT.fullmatch(cell):
                seen["point"] = cell.strip()
            else:
                continue
            if len(seen) == 2:
                raise InputError(
                    printable(
                        f"{name}, line {line}: there are numbers such as {shown(seen['comma'])} and such as "
                        f"{shown(seen['point'])}; expected decimal points throughout, or decimal commas throughout"
                    )
                )
        yield line, cells
    if "comma" in seen:
        notes.append("numbers have decimal commas")


def without_empty_ends(rows: Iterable[tuple[int, list[str]]], notes: list[str]) -> Iterator[tuple[int, list[str]]]:
    """Yields rows without columns at the end that have no name and no value anywhere."""
    width, left_out = -1, False
    for line, cells in rows:
        if width < 0:
            width = max((place + 1 for place, name in enumerate(cells) if name.strip()), default=len(cells))
        if len(cells) > width and not any(cell.strip() for cell in cells[width:]):
            cells, left_out = cells[:width], True
        yield line, cells
    if left_out:
        notes.append("empty columns at the end are left out")
