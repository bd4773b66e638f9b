"""Where every joint was, at any time that its messages tell of."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from boresight.recordings.rules import USUAL_GAP
from boresight.recordings.signal import Signal
from boresight.recordings.wrapping import TURN, put_back, turns_of


@dataclass(frozen=True)
class Trajectory:
    """Joint readings over time; each joint has its own samples, since several nodes may publish parts of an arm.

    Attributes:
        names: of the joints, in order.
        signals: (samples, 1) readings [rad or m] of each.
        longest_gap: [s] of each, across which nothing is known.
        wrapped: (samples,) readings [rad] as they were reported, of joints that start again after a full turn, by name;
            their signals are continuous.
    """

    names: tuple[str, ...]
    signals: tuple[Signal, ...]
    longest_gap: tuple[float, ...]
    wrapped: Mapping[str, Float[np.ndarray, " samples"]] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        names: Sequence[str],
        signals: Mapping[str, Signal],
        longest_gap: float | None = None,
        sliding: Collection[str] = (),
    ) -> Trajectory:
        """Returns the trajectory of some joints.

        Args:
            names: the joints, in order.
            signals: the samples of each, by name.
            longest_gap: [s]; None takes three times a joint's usual distance of samples, at least 0.2 s.
            sliding: joints that are known to slide, whose readings never wrap.
        """
        chosen, wrapped = [], {}
        for name in names:
            signal = signals[name]
            turns = np.zeros(len(signal)) if name in sliding else turns_of(signal.values[:, 0])
            if turns.any():
                wrapped[name] = signal.values[:, 0]
                signal = Signal(signal.time, signal.values + TURN * turns[:, None])
            chosen.append(signal)
        usual = [3.0 * float(np.median(np.diff(s.time))) if len(s) > 1 else 0.0 for s in chosen]
        gaps = [longest_gap if longest_gap is not None else max(USUAL_GAP, gap) for gap in usual]
        return cls(tuple(names), tuple(chosen), tuple(gaps), wrapped)

    @property
    def span(self) -> tuple[float, float]:
        """From when to when [s] every joint is known."""
        return max(s.time[0] for s in self.signals), min(s.time[-1] for s in self.signals)

    def at(self, time: Float[np.ndarray, " times"]) -> Float[np.ndarray, "times joints"]:
        """Returns the joints' readings at some times, linear between samples; NaN outside and across gaps."""
        found = np.stack(
            [_interpolated(s, gap, time) for s, gap in zip(self.signals, self.longest_gap, strict=True)], axis=1
        )
        return self._as_reported(found)

    def during(self, start: float, end: float, when: float) -> Float[np.ndarray, " joints"]:
        """Returns the joints' readings at a time within a phase, by a straight line through the phase's samples.

        All samples of the phase are averaged, not the two beside that time, and a joint that creeps is followed.

        Args:
            start: of the phase [s].
            end: of the phase [s].
            when: the time [s], as a rule the mean time of what was measured meanwhile.
        """
        return self._as_reported(np.array([[_line(s, s.between(start, end), when) for s in self.signals]]))[0]

    def _as_reported(self, found: Float[np.ndarray, "times joints"]) -> Float[np.ndarray, "times joints"]:
        """Returns readings, those of wrapped joints within the turn in which they were reported."""
        for name, readings in self.wrapped.items():
            place = self.names.index(name)
            found[:, place] = put_back(found[:, place], readings)
        return found


def _interpolated(signal: Signal, gap: float, time: Float[np.ndarray, " times"]) -> Float[np.ndarray, " times"]:
    after = np.clip(np.searchsorted(signal.time, time), 1, max(1, len(signal) - 1))
    if len(signal) < 2:
        return np.full(len(time), np.nan)
    known = (time >= signal.time[0]) & (time <= signal.time[-1])
    known &= signal.time[after] - signal.time[after - 1] <= gap
    return np.where(known, np.interp(time, signal.time, signal.values[:, 0]), np.nan)


def _line(signal: Signal, samples: slice, when: float) -> float:
    time, values = signal.time[samples], signal.values[samples, 0]
    if not len(time):  # a joint that is reported less often than the arm stands still
        return float(np.interp(when, signal.time, signal.values[:, 0]))
    middle = time.mean()
    spread = np.sum((time - middle) ** 2)
    slope = np.sum((time - middle) * values) / spread if len(time) > 2 and spread > 0.0 else 0.0
    # Beyond the samples a line knows nothing: the time is brought back to them.
    return float(values.mean() + slope * (np.clip(when, time[0], time[-1]) - middle))
