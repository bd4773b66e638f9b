"""Observations out of a ROS bag: topics chosen, joints and readings paired, still phases made rows."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from jaxtyping import Float

from boresight.arm import Joint
from boresight.errors import InputError, did_you_mean
from boresight.files.bags import Bag, read_bag
from boresight.files.clocks import Clock, clock_of
from boresight.files.columns import NEARLY_UNIT, QUATERNION, STD_ANGLE
from boresight.files.problems import listed, printable, shown
from boresight.files.schemas import LARGEST, SMALLEST
from boresight.files.topics import CHANNELS, Choice, Topics, topics_of
from boresight.recordings import Rows, Rules, Signal, Trajectory, rows_of

_FINEST = 1e-6
"""Rounding to less than this [m] is that of floating point, and says nothing of the sensor."""


@dataclass(frozen=True)
class Recorded:
    """The rows of a bag, and how they came to be.

    Attributes:
        bag: what was read.
        joint_names: the columns of joints.
        channels: the columns of values.
        rows: the rows; times from `start` on.
        start: the first message's time [s], as its clock has it.
        used: the topics used, by what for.
        counts: messages used: `joint_states` and `readings`.
        empty: how many readings hold no value, by reason.
        remarks: choices that were made, a sentence each.
    """

    bag: Bag
    joint_names: tuple[str, ...]
    channels: tuple[str, ...]
    rows: Rows
    start: float
    used: dict[str, str]
    counts: dict[str, int]
    empty: dict[str, int]
    remarks: tuple[str, ...]

    @property
    def lengths(self) -> slice:
        """Which channels are lengths; those of a quaternion follow them."""
        return slice(0, len(self.channels) - len(QUATERNION) if QUATERNION[0] in self.channels else None)

    @property
    def scatters(self) -> bool:
        """Whether lengths of a phase differ, or are rounded to steps, so that a standard deviation can be told."""
        std, scatter = self.rows.std[:, self.lengths], self.rows.scatter[self.lengths]
        return bool((std >= SMALLEST).all() and ((scatter > 0.0).any() or (std >= _FINEST).all()))

    @property
    def angle_scatter(self) -> float | None:
        """Standard deviation of one reading about each axis in the median phase [rad]; None where there is no pose."""
        turns = self.rows.scatter[len(self.channels[self.lengths]) :]
        return float(_by_axis(turns[None, :])[0]) if len(turns) else None

    @property
    def std_angle(self) -> Float[np.ndarray, " rows"] | None:
        """Standard deviation of each row's orientation about each axis [rad]; None where nothing tells it."""
        if not self.angle_scatter:
            return None
        angles = _by_axis(self.rows.std[:, len(self.channels[self.lengths]) :])
        return angles if (angles >= SMALLEST).all() else None

    @property
    def columns(self) -> dict[str, list[str]]:
        """Values and standard deviations of the rows as text, by column."""
        values = self.rows.values.copy()
        turns = values[:, len(self.channels[self.lengths]) :]
        if turns.size:
            turns /= np.linalg.norm(turns, axis=1, keepdims=True)
        found = {name: [f"{value:.10g}" for value in values[:, k]] for k, name in enumerate(self.channels)}
        lengths = self.channels[self.lengths]
        for k, name in enumerate(lengths if self.scatters else ()):
            found["std" if len(lengths) == 1 else f"std_{name}"] = [f"{value:.4g}" for value in self.rows.std[:, k]]
        if self.std_angle is not None:
            found[STD_ANGLE] = [f"{value:.4g}" for value in self.std_angle]
        return found


def sliding_joints(joints: Sequence[Joint]) -> tuple[str, ...]:
    """Returns the names of the joints that slide: their readings never start again after a turn."""
    return tuple(joint.name for joint in joints if joint.type != "revolute")


def read_recorded(
    path: Path,
    name: str,
    choice: Choice,
    joint_names: Sequence[str] | None = None,
    kind: str | None = None,
    *,
    all_joints: bool = True,
    sliding: Collection[str] = (),
) -> Recorded:
    """Returns the rows of a bag, in metres and radians.

    Args:
        path: of the bag.
        name: what the user calls it.
        choice: which topics, and what counts as still.
        joint_names: the arm's joints; those of the bag, in its order, by default.
        kind: `range`, `position` or `pose`; whichever the bag holds by default.
        all_joints: whether every one of `joint_names` must be there, or those that are there are used.
        sliding: joints that slide; the others may start again after a full turn.

    Raises:
        InputError: it cannot be read, a topic is missing or not to be told from others, or no row can be made.
    """
    bag = read_bag(path, name, transforms=choice.transforms)
    topics = topics_of(bag, choice, kind)
    clock = clock_of([bag.messages[topic] for topic in topics.joints], bag.messages[topics.readings], topics.readings)
    joints = _joint_signals(bag, topics.joints, clock)
    named = joint_names if joint_names is None or all_joints else [n for n in joint_names if n in joints] or joint_names
    names = _arm(bag, joints, named)
    readings, reasons = _readings(bag, topics, clock, choice.time_offset)
    start = min(min(joints[n].time[0] for n in names), readings.time[0])
    trajectory = Trajectory.of(names, {n: _from(joints[n], start) for n in names}, choice.rules.longest_gap, sliding)
    rows = rows_of(
        trajectory, _from(readings, start), choice.rules, _targets(bag, topics.targets, choice, clock, start)
    )
    if not len(rows):
        raise InputError(printable(_no_rows(name, rows, trajectory, choice.rules)))
    others = sorted(set(joints) - set(names))
    ignored = (f"Joints that the arm does not have are ignored: {listed(map(printable, others))}.",) if others else ()
    wraps = sorted(trajectory.wrapped)
    turned = (f"Readings that start again after a full turn were made continuous: {listed(wraps)}.",) if wraps else ()
    return Recorded(
        bag,
        names,
        CHANNELS[topics.kind],
        rows,
        start,
        topics.used,
        {
            "joint_states": sum(len(bag.messages[topic]) for topic in topics.joints),
            "readings": len(bag.messages[topics.readings]),
        },
        reasons,
        tuple(printable(remark) for remark in (*clock.remarks, *ignored, *turned)),
    )


def rows_csv(recorded: Recorded) -> str:
    """Returns the text of an observations.csv, in metres and radians."""
    rows, text = recorded.rows, io.StringIO()
    text.write(f"# {printable(Path(recorded.bag.name).name)}, from {began(recorded.start)} on\n")
    writer = csv.writer(text, lineterminator="\n")
    columns = recorded.columns
    named = ["target"] if rows.target is not None else []
    joints = [name.replace("#", "") for name in recorded.joint_names]  # it would begin a comment
    writer.writerow([*joints, *columns, "repeats", "time", *named])
    for k in range(len(rows)):
        numbers = [*(f"{value:.10g}" for value in rows.joints[k]), *(column[k] for column in columns.values())]
        target = [rows.target[k]] if rows.target is not None else []
        writer.writerow([*numbers, int(rows.repeats[k]), f"{rows.time[k]:.3f}", *target])
    return text.getvalue()


def began(start: float) -> str:
    """Returns when a recording began, in words; a clock that is not of this world is told in seconds."""
    if not 1e8 < start < 1e10:
        return f"{start:.3f} s of its clock"
    return datetime.fromtimestamp(start, UTC).isoformat(sep=" ", timespec="milliseconds").replace("+00:00", " UTC")


def _joint_signals(bag: Bag, topics: Sequence[str], clock: Clock) -> dict[str, Signal]:
    """Returns the samples of every joint of some topics, whoever published it."""
    times: dict[str, list[np.ndarray]] = {}
    values: dict[str, list[np.ndarray]] = {}
    for topic in topics:
        messages = bag.messages[topic]
        time = clock.time(messages)
        together: dict[tuple[str, ...], list[int]] = {}
        for k, (names, _) in enumerate(messages.values):
            together.setdefault(names, []).append(k)
        for names, places in together.items():
            positions = np.array([messages.values[k][1] for k in places])
            for column, joint in enumerate(names):
                times.setdefault(joint, []).append(time[places])
                values.setdefault(joint, []).append(positions[:, column])
    signals = {}
    for joint in times:
        when, position = np.concatenate(times[joint]), np.concatenate(values[joint])
        read = np.abs(position) < LARGEST  # neither NaN nor infinite
        if read.any():
            signals[joint] = Signal.of(when[read], position[read][:, None])
    return signals


def _arm(bag: Bag, joints: dict[str, Signal], wanted: Sequence[str] | None) -> tuple[str, ...]:
    if wanted is None and joints:
        return tuple(joints)
    missing = [name for name in wanted or () if name not in joints]
    if not missing and joints:
        return tuple(wanted or ())
    there = f"the joint states tell of {listed(map(shown, joints))}"
    near = did_you_mean(missing[0][:100], joints) if missing else ""
    raise InputError(printable(f"{bag.name}: there is no joint {listed(missing)}{near}; {there}"))


def _readings(bag: Bag, topics: Topics, clock: Clock, offset: float) -> tuple[Signal, dict[str, int]]:
    """Returns what the sensor read, NaN where that is no value, and how often it was none for which reason.

    Out of range is infinite by REP 117, and below the lowest or above the highest range is as good as that.
    """
    messages = bag.messages[topics.readings]
    numbers = np.array(messages.values, dtype=np.float64)
    time = clock.time(messages) + offset
    if topics.kind != "range":
        numbers, reasons = _places(numbers[:, : len(CHANNELS[topics.kind])])
        ordered = Signal.of(time, numbers)
        return Signal(ordered.time, _on_one_side(ordered.values)), reasons
    value, low, high = numbers.T
    limited = high > low
    reason = np.select(
        [np.isnan(value), value == np.inf, value == -np.inf, limited & ((value < low) | (value > high)), value <= 0.0],
        ["not a number", "+Inf: nothing in range", "-Inf: too near", "beyond the ranger's own limits", "not above 0"],
        "",
    )
    counts = Counter(reason[reason != ""].tolist())
    return Signal.of(time, np.where(reason == "", value, np.nan)[:, None]), dict(sorted(counts.items()))


def _places(
    numbers: Float[np.ndarray, "messages channels"],
) -> tuple[Float[np.ndarray, "messages channels"], dict[str, int]]:
    """Returns positions or poses, NaN where they have no value, and how many those are for which reason."""
    bad = ~(np.abs(numbers) <= LARGEST).all(axis=1)
    size = np.linalg.norm(np.where(bad[:, None], 1.0, numbers)[:, 3:], axis=1)
    turned = ~bad & (np.abs(size - 1.0) > NEARLY_UNIT) if numbers.shape[1] > 3 else np.zeros(len(bad), dtype=bool)
    reasons = {"no value": int(bad.sum()), "no unit quaternion": int(turned.sum())}
    return np.where((bad | turned)[:, None], np.nan, numbers), {why: count for why, count in reasons.items() if count}


def _on_one_side(values: Float[np.ndarray, "samples channels"]) -> Float[np.ndarray, "samples channels"]:
    """Returns poses with the sign of each quaternion that is nearer to the one before: q and -q are one orientation."""
    found, known = values.copy(), np.flatnonzero(np.isfinite(values).all(axis=1))
    turns = values[known, 3:]
    if turns.size:
        flips = np.where(np.sum(turns[1:] * turns[:-1], axis=1) < 0.0, -1.0, 1.0)
        found[known[1:], 3:] *= np.cumprod(flips)[:, None]
    return found


def _by_axis(std: Float[np.ndarray, "rows 4"]) -> Float[np.ndarray, " rows"]:
    """Returns the standard deviation about each axis [rad] of quaternions with these of their numbers.

    A small turn by (a, b, c) moves a quaternion by half of it, within the three directions square to it.
    """
    return 2.0 * np.sqrt(np.sum(std**2, axis=1) / 3.0)


def _targets(bag: Bag, words: str | None, choice: Choice, clock: Clock, start: float) -> list[tuple[float, str]] | None:
    """Returns from when on the sensor pointed at what; None where nothing tells."""
    if words is None:
        return [(-np.inf, choice.target)] if choice.target is not None else None
    messages = bag.messages[words]
    told = sorted(zip((clock.time(messages) - start).tolist(), messages.values, strict=True))
    return ([(-np.inf, choice.target)] if choice.target else []) + [
        (t, " ".join(word.replace("#", "").split())) for t, word in told
    ]


def _from(signal: Signal, start: float) -> Signal:
    return Signal(signal.time - start, signal.values)


def _no_rows(name: str, rows: Rows, trajectory: Trajectory, rules: Rules) -> str:
    if rows.skipped:
        first = rows.skipped[0]
        return (
            f"{name}: none of {len(rows.skipped)} still phases gives a row; the first, from {first.start:.2f} s to "
            f"{first.end:.2f} s: {first.reason}"
        )
    start, end = trajectory.span
    return (
        f"{name}: the arm never stood still for {rules.still_time:g} s with every joint known (joint states from "
        f"{start:.2f} s to {end:.2f} s); expected pauses of about a second, or a higher still_speed than "
        f"{rules.still_speed:g} rad/s"
    )
