"""Readings of a length too short to have a direction: they are set aside, since no derivative of theirs exists."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import replace

import numpy as np

from boresight.calibration.campaign import SetAside
from boresight.errors import InputError
from boresight.files.observations import Observations
from boresight.files.problems import printable
from boresight.sensing import Cell, Distances, DrawWire
from boresight.units import Units

SHORTEST = 3.0
"""Standard deviations of a reading below which its length may be none at all."""

_CONTACT = "A ball that sits in a socket, or a tip on a point, is `type: point_contact`, which reads nothing"


def without_short_lengths(
    found: Observations, cell: Cell, name: str, units: Units, of_unknown_zero: Set[str]
) -> Observations:
    """Returns observations without the lengths of wires, and distances, that are not above their own noise.

    Args:
        found: what a file holds.
        cell: the sensors it is about.
        name: what the user calls the file.
        units: it is written in.
        of_unknown_zero: sensors whose zero is estimated, so that a reading of 0 is a length like others.

    Raises:
        InputError: nothing is left.
    """
    readings = found.readings
    kinds = [
        isinstance(sensor := cell.sensors[aim.sensor], Distances)
        or (isinstance(sensor, DrawWire) and aim.sensor not in of_unknown_zero)
        for aim in cell.aims
    ]
    lengths, std = readings.values[:, 0], readings.std[:, 0]
    short = np.array(kinds, dtype=bool)[readings.target] & (lengths <= SHORTEST * std)
    if not short.any():
        return found
    set_aside = tuple(
        SetAside(name, int(readings.line[row]), _reason(lengths[row], std[row], units)) for row in np.flatnonzero(short)
    )
    if short.all():
        first = f"the first, on line {set_aside[0].line}: {set_aside[0].reason}"
        raise InputError(printable(f"{name}: none of its rows can be used; {first}. {_CONTACT}"))
    return replace(
        found,
        readings=readings.chosen(~short),
        set_aside=(*found.set_aside, *set_aside),
    )


def _reason(length: float, std: float, units: Units) -> str:
    return (
        f"a distance of {length / units.metres:.6g} is not above {SHORTEST:g} standard deviations of "
        f"{std / units.metres:.3g} {units.length}, so it has no direction"
    )
