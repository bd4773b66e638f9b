"""Slips that explain readings which no placement does."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from boresight.calibration.placement.candidates import Candidate, compared, rough_candidate
from boresight.calibration.slips import slips
from boresight.sensing import Cell, Readings

NEARER = 0.7
"""A slip is compared with the geometry free where its placement leaves at most this share, with nominal geometry."""

BETTER = 0.1
"""It explains the readings where it leaves this share with the geometry free."""


def slip_that_explains(
    cell: Cell, readings: Readings, names: tuple[str, ...], best: Candidate, stated_std: Mapping[str, float]
) -> tuple[str, float] | None:
    """Returns what the best slip is, in words, and what it leaves over the stated noise; None where none explains.

    Args:
        cell: nominal, its unknown numbers at neutral values.
        readings: measured values.
        names: the unknown parameters.
        best: the best placement of the readings as they are.
        stated_std: of frames that are roughly known, as `find_frames` has it.
    """
    as_given = rough_candidate(cell, readings, names, stated_std)
    explained = []
    for _, words, other, changed in slips(best.cell, readings):
        found = rough_candidate(replace(other, base=cell.base, mount=cell.mount), changed, names, stated_std)
        if found is None or as_given is None or found[1] > NEARER * as_given[1]:
            continue
        ratio = compared([found[0]], changed, names)[0].ratio
        if ratio <= BETTER * best.ratio:
            explained.append((ratio, words))
    if not explained:
        return None
    ratio, words = min(explained)
    return words, ratio
