"""Sessions: blocks of rows in which a sensor has an offset of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boresight.files.problems import Problems, listed, shown
from boresight.sensing import Cell, Readings

ONLY = "1"
"""What the session of drawn configurations is called, where no file names sessions."""


def with_sessions(cell: Cell, sensors: Sequence[str], names: Sequence[str]) -> Cell:
    """Returns the cell with an offset for each of the sessions of some sensors, each at 0.

    Args:
        cell: the cell, without sessions.
        sensors: the sensors that have offsets of their own.
        names: the sessions.
    """
    aims = tuple(
        replace(aim, session=name) for aim in cell.aims for name in (names if aim.sensor in sensors else (None,))
    )
    return replace(cell, listed_aims=aims, offsets={aim.offset: 0.0 for aim in aims if aim.session is not None})


def in_sessions(readings: Readings, plain: Cell, cell: Cell, name: str, problems: Problems) -> Readings:
    """Returns readings whose aims are those of a cell with sessions.

    Args:
        readings: as read without sessions.
        plain: the cell without sessions.
        cell: the same with them.
        name: of the file.
        problems: where rows of no session, or of one without an offset, are added.
    """
    place = {aim: index for index, aim in enumerate(cell.aims)}
    sessioned = {aim.sensor for aim in cell.aims if aim.session is not None}
    known = list(dict.fromkeys(aim.session for aim in cell.aims if aim.session is not None))
    sessions = [""] * len(readings) if readings.session is None else readings.session.tolist()
    own = [aim.sensor in sessioned for aim in plain.aims]
    told: dict[tuple[int, str], int | None] = {}  # a million rows are of a few sessions
    target = np.empty_like(readings.target)
    for row, pair in enumerate(zip(readings.target.tolist(), sessions, strict=True)):
        if pair not in told:
            index, session = pair
            told[pair] = place.get(replace(plain.aims[index], session=session) if own[index] else plain.aims[index])
        found = told[pair]
        if found is None:
            given = pair[1]
            fault = f"no row of {shown(given)} is calibrated with" if given else "the cell is empty"
            problems.add(f"{name}, line {readings.line[row]}: session: {fault}; expected one of {listed(known)}")
        target[row] = found or 0
    return replace(readings, target=target)


def sessions_of(readings: Readings, cell: Cell, sensors: Sequence[str]) -> list[str]:
    """Returns the names of the sessions in which some sensors were read, in their order."""
    assert readings.session is not None
    own = np.array([aim.sensor in sensors for aim in cell.aims])[readings.target]
    return list(dict.fromkeys(str(name) for name in readings.session[own] if name))
