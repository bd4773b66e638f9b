"""What counts as standing still, and how far apart joint messages may be."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Rules:
    """The rules by which rows are made of a recording.

    Attributes:
        still_speed: a joint that moves slower than this [rad/s or m/s] stands still, unless its own noise looks
            faster. In half a second 0.001 rad/s turns a joint by no more than the mean of a phase can follow.
        still_time: a phase is at least this long [s], what is trimmed not counted.
        settle: this much [s] is trimmed from a phase's beginning: arms ring on after they stop.
        longest_gap: joint messages further apart [s] are not interpolated across; None takes 0.2 s, or three
            times the usual distance where that is longer.
    """

    still_speed: float = 1e-3
    still_time: float = 0.5
    settle: float = 0.3
    longest_gap: float | None = None


USUAL_GAP = 0.2
"""Seconds between joint messages that no working controller leaves."""
