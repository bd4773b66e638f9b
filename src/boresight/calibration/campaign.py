"""One calibration's worth of input: a cell, its readings, and what may be wrong about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from boresight.sensing import Cell, Readings


@dataclass(frozen=True, slots=True)
class Freedom:
    """How far a parameter may be from its nominal value.

    Attributes:
        parameter: its name.
        within: half-width of the search about the nominal value [m, rad or 1]; None searches everywhere.
        prior_std: standard deviation of what is believed beforehand; None believes nothing.
    """

    parameter: str
    within: float | None
    prior_std: float | None


@dataclass(frozen=True, slots=True)
class SetAside:
    """A row of an observations file that cannot be used.

    Attributes:
        file: the file's name.
        line: the row's line in it.
        reason: why, in words.
    """

    file: str
    line: int
    reason: str


@dataclass(frozen=True)
class Campaign:
    """The input of one calibration.

    Attributes:
        name: for titles.
        cell: the nominal cell; frames that are unknown stand at the identity.
        readings: the rows to calibrate with; None, or without values, where a campaign is only planned.
        validation: rows held out; None to judge by cross-validation.
        freedoms: what to estimate; None frees what the data can see.
        fixed: parameters held at nominal, whatever `freedoms` says.
        unknown: the parameters of `base` and `mount` that nobody has measured.
        set_aside: rows that were not used, and why.
        warnings: what looked odd in the files, a sentence each.
        notes: choices made in reading them that a person should know.
        inputs: SHA-256 by file name.
    """

    name: str
    cell: Cell
    readings: Readings | None = None
    validation: Readings | None = None
    freedoms: tuple[Freedom, ...] | None = None
    fixed: frozenset[str] = frozenset()
    unknown: frozenset[str] = frozenset()
    set_aside: tuple[SetAside, ...] = ()
    warnings: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    inputs: Mapping[str, str] = field(default_factory=dict)
