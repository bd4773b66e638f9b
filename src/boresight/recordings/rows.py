"""Rows of observations out of a recording: one for each time the arm stood still."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from boresight.recordings.averages import averages, step_of, usual
from boresight.recordings.rules import Rules
from boresight.recordings.signal import Signal
from boresight.recordings.stillness import still_phases
from boresight.recordings.trajectory import Trajectory


@dataclass(frozen=True, slots=True)
class Skipped:
    """A still phase of which no row could be made: from when to when [s], and why."""

    start: float
    end: float
    reason: str


@dataclass(frozen=True)
class Rows:
    """Still phases as rows, in order of time.

    Attributes:
        joints: (rows, joints) mean readings [rad or m], at the mean time of what the sensor read.
        values: (rows, channels) mean of what the sensor read [m].
        std: (rows, channels) standard deviation of these means [m].
        repeats: (rows,) readings in each.
        time: (rows,) mean time of these [s].
        target: what the sensor pointed at, row by row; None where nothing tells.
        skipped: still phases without a row.
        outlying: readings left out as gross errors of their phase.
        missing: readings within still phases that hold no value.
        scatter: (channels,) standard deviation of one reading in the median phase [m].
        likeness: factor on `std` since neighbouring readings are alike.
    """

    joints: Float[np.ndarray, "rows joints"]
    values: Float[np.ndarray, "rows channels"]
    std: Float[np.ndarray, "rows channels"]
    repeats: Int[np.ndarray, " rows"]
    time: Float[np.ndarray, " rows"]
    target: tuple[str, ...] | None
    skipped: tuple[Skipped, ...]
    outlying: int
    missing: int
    scatter: Float[np.ndarray, " channels"]
    likeness: float

    def __len__(self) -> int:
        """Number of rows."""
        return len(self.joints)


def rows_of(
    trajectory: Trajectory, readings: Signal, rules: Rules, targets: Sequence[tuple[float, str]] | None = None
) -> Rows:
    """Returns a row for every still phase in which the sensor read something.

    Args:
        trajectory: the arm's joints.
        readings: what the sensor read; NaN where it saw nothing. On the joints' clock.
        rules: what counts as still.
        targets: (time, name): from then on the sensor pointed at that; in order.
    """
    phases = still_phases(trajectory, rules)
    pieces = _by_target(phases, targets) if targets is not None else [(*phase, "") for phase in phases]
    quantum = step_of(readings.values[np.isfinite(readings.values).all(axis=1)])
    kept, skipped, missing = [], [], 0
    for start, end, target in pieces:
        samples = readings.between(start, end)
        values, time = readings.values[samples], readings.time[samples]
        there = np.isfinite(values).all(axis=1)
        missing += int(np.sum(~there))
        if end - start < rules.still_time:
            reason = "the target changes too soon after it begins or before it ends"
        elif targets is not None and not target:
            reason = "no target has been named before it"
        elif not len(values):
            reason = "the sensor reported nothing"
        elif not there.any():
            reason = f"none of its {len(values)} readings holds a value"
        else:
            kept.append(_Piece(start, end, target, time[there], values[there]))
            continue
        skipped.append(Skipped(float(start), float(end), reason))
    return _rows(kept, tuple(skipped), missing, quantum, trajectory, targets is not None)


@dataclass(frozen=True)
class _Piece:
    """A still phase of one target, and what the sensor read meanwhile."""

    start: float
    end: float
    target: str
    time: np.ndarray
    values: np.ndarray


def _rows(
    pieces: list[_Piece],
    skipped: tuple[Skipped, ...],
    missing: int,
    quantum: Float[np.ndarray, " channels"],
    trajectory: Trajectory,
    named: bool,
) -> Rows:
    if not pieces:
        none, empty, joints = np.empty(0), np.empty((0, len(quantum))), np.empty((0, len(trajectory.names)))
        return Rows(joints, empty, empty, none.astype(int), none, None, skipped, 0, missing, quantum, 1.0)
    good = usual([piece.values for piece in pieces], quantum)
    mean = averages([piece.values[usable] for piece, usable in zip(pieces, good, strict=True)], quantum)
    time = np.array([piece.time[usable].mean() for piece, usable in zip(pieces, good, strict=True)])
    return Rows(
        np.stack([trajectory.during(p.start, p.end, when) for p, when in zip(pieces, time.tolist(), strict=True)]),
        mean.means,
        mean.std,
        np.array([int(np.sum(usable)) for usable in good]),
        time,
        tuple(piece.target for piece in pieces) if named else None,
        skipped,
        int(sum(np.sum(~usable) for usable in good)),
        missing,
        mean.scatter,
        mean.likeness,
    )


def _by_target(
    phases: Float[np.ndarray, "phases 2"], targets: Sequence[tuple[float, str]]
) -> list[tuple[float, float, str]]:
    """Returns (start, end, target) of the pieces that phases fall into where the target changes in them."""
    times = np.array([time for time, _ in targets])
    pieces = []
    for start, end in phases:
        first, last = np.searchsorted(times, [start, end], side="right")
        name = targets[first - 1][1] if first else ""
        for time, following in targets[first:last]:
            if following != name:
                pieces.append((float(start), time, name))
                start, name = time, following
        pieces.append((float(start), float(end), name))
    return pieces
