"""The scale of an arm that touches points nobody has measured: no reading sees it, so one length keeps its value.

Contacts say where the tip was, but of points at unknown places they say it in no unit: an arm and points half as large
fit as well, and better, since errors of the joints then leave half as much. Least squares would shrink the arm until
priors stop it. One length is held instead, and all others are found in proportion to it.
"""

from __future__ import annotations

import numpy as np

from boresight.sensing import Cell, PointContact, Readings
from boresight.sensing.linear import seen_by

WEAK = 0.3
"""A scale is seen where the readings' pull towards smaller arms stays below this share of its standard deviation."""

_SHORTEST_M = 1e-3


def scale_held(cell: Cell, readings: Readings, names: tuple[str, ...]) -> str | None:
    """Returns the length that is held since readings do not see the arm's scale; None where they see it.

    Args:
        cell: with unknown points where they were found.
        readings: joints and aims are looked at; values need not be measured.
        names: the parameters that would be free.
    """
    contacts = [isinstance(cell.sensors[aim.sensor], PointContact) for aim in cell.aims]
    rows = np.array(contacts, dtype=bool)[readings.target]
    lengths = _lengths(cell, names)
    if not rows.any() or not lengths:
        return None
    longest = max(lengths, key=lambda name: lengths[name])
    place = names.index(longest)
    columns = seen_by(cell, readings, names)
    own, others = columns[:, place], np.delete(columns, place, axis=1)
    sizes = np.linalg.norm(others, axis=0)
    others = others / np.where(sizes > 0.0, sizes, 1.0)
    left = float(np.linalg.norm(own - others @ np.linalg.lstsq(others, own, rcond=1e-10)[0]))
    std = 1.0 / max(left, 1e-300) / lengths[longest]
    return longest if std * float(np.sum(readings.channels[rows])) > WEAK else None


def _lengths(cell: Cell, names: tuple[str, ...]) -> dict[str, float]:
    """Returns the sizes [m] of the arm's lengths among parameters."""
    values = cell.values
    joints = {joint.name for joint in cell.arm.joints}
    found = {}
    for name in names:
        owner, _, number = name.rpartition(".")
        if owner in joints and number in ("d", "a") and abs(values[name]) > _SHORTEST_M:
            found[name] = abs(values[name])
    return found
