"""Numbers in another unit than their file says, each made undone: one length, one angle, one column, or all alike.

Before any fit, numbers that no cell can have are refused. What is here is for those that some cell could have: a link
of 60 mm among metres is 60 m, as a crane's boom is.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from boresight.arm import Arm
from boresight.calibration.campaign import Campaign, RobotFile
from boresight.calibration.written import Written
from boresight.geometry import Frame, Plane, Point
from boresight.sensing import Cell, DrawWire, LaserRanger, Pose, Position, Readings
from boresight.units import Quantity, Units

THOUSAND, DEGREES = 1000.0, 180.0 / math.pi

LARGEST = {"length": 200.0, "angle": 2.0 * math.pi + 0.02}
"""No number is meant to be larger [m, rad]."""

NOTHING = 1e-4
"""A number that changes by less [m, rad] is no slip that anything would show."""

_LENGTHS, _ANGLES = ("a", "d"), ("theta", "alpha", "beta")
_UNIT = {
    ("length", "m", 1 / THOUSAND): "millimetres",
    ("length", "mm", THOUSAND): "metres",
    ("angle", "rad", 1 / DEGREES): "degrees",
    ("angle", "deg", DEGREES): "radians",
}
_FACTORS: dict[Quantity, tuple[float, ...]] = {
    "length": (1 / THOUSAND, THOUSAND),
    "angle": (1 / DEGREES, DEGREES),
    "number": (),
}

Slip = tuple[str, str, Cell, Readings]


def unit_slips(cell: Cell, readings: Readings, campaign: Campaign) -> Iterator[Slip]:
    """Yields each number, and each group of numbers, in the other units: its name, words, cell and readings so.

    Args:
        cell: nominal, its frames about where they are.
        readings: as given.
        campaign: says which frames are unknown, and where numbers stand.
    """
    said = campaign.written
    arms = _in_urdf(campaign.robot_file, cell.arm, said) if campaign.robot_file else _in_table(cell.arm, said)
    for key, words, arm in arms:
        yield key, words, replace(cell, arm=arm), readings
    known = {name: f for name, f in {"base": cell.base, **cell.mounts}.items() if not _unknown(name, campaign)}
    for name, frame in known.items():
        for key, words, other in _in_frame(name, frame, said.campaign, said.units):
            yield key, words, _with_frame(cell, name, other), readings
    for key, words, targets in _in_targets(cell, campaign):
        yield key, words, replace(cell, targets={**cell.targets, **targets}), readings
    for key, words, changed in (*_in_joints(cell, readings, said), *_in_values(cell, readings, said)):
        yield key, words, cell, changed


def _in_table(arm: Arm, said: Written) -> Iterator[tuple[str, str, Arm]]:
    """Yields the arm with a number of its table, or all of them, in another unit."""
    for place, joint in enumerate(arm.joints):
        for number, value in joint.numbers.items():
            quantity: Quantity = "length" if number in _LENGTHS else "angle"
            for factor, words in _others(said.robot, f"{joint.name}.{number}", [value], quantity, said.robot_units):
                joints = (
                    *arm.joints[:place],
                    joint.with_numbers({**joint.numbers, number: factor * value}),
                    *arm.joints[place + 1 :],
                )
                yield f"unit of {joint.name}.{number}", words, replace(arm, joints=joints)
    for numbers, quantity, which in (
        (_LENGTHS, "length", "d and a of all joints"),
        (_ANGLES, "angle", "angles of all joints"),
    ):
        values = [value for joint in arm.joints for number, value in joint.numbers.items() if number in numbers]
        for factor, unit in _factors(values, quantity, said.robot_units):
            scaled = (
                joint.with_numbers({n: v * factor if n in numbers else v for n, v in joint.numbers.items()})
                for joint in arm.joints
            )
            words = f"{_of(said.robot)}{which} read as {unit}: so they explain the readings"
            yield f"unit of {which}", words, replace(arm, joints=tuple(scaled))
    for key, words, frame in _in_frame("root", arm.root, said.robot, said.robot_units):
        yield key, words, replace(arm, root=frame)
    for key, words, frame in _in_frame("tip", arm.tip, said.robot, said.robot_units):
        yield key, words, replace(arm, tip=frame)


def _in_urdf(file: RobotFile, arm: Arm, said: Written) -> Iterator[tuple[str, str, Arm]]:
    """Yields the arm with an origin of its URDF in another unit, which is in metres and radians."""
    for place, joint in enumerate(file.chain.joints):
        for key, words, origin in _in_frame(f"{joint.name}.origin", joint.origin, said.robot, Units()):
            joints = (*file.chain.joints[:place], joint.placed(origin), *file.chain.joints[place + 1 :])
            other = replace(file.chain, joints=joints).arm
            bent = zip(arm.joints, other.joints, strict=True)
            yield (
                key,
                words,
                replace(other, joints=tuple(replace(new, harmonics=old.harmonics, sag=old.sag) for old, new in bent)),
            )


def _in_frame(name: str, frame: Frame, file: str, units: Units) -> Iterator[tuple[str, str, Frame]]:
    """Yields a frame with one of its numbers, or three, in another unit."""
    parts: tuple[tuple[str, Quantity, Sequence[str]], ...] = (
        ("xyz", "length", "xyz"),
        ("rpy", "angle", ("roll", "pitch", "yaw")),
    )
    for part, quantity, axes in parts:
        values = getattr(frame, part)
        for chosen in ([0, 1, 2], [0], [1], [2]):
            own = [values[axis] for axis in chosen]
            if len(chosen) > 1 and sum(value != 0.0 for value in own) < 2:
                continue
            key = f"{name}.{part if len(chosen) > 1 else axes[chosen[0]]}"
            for factor, words in _others(file, key, own, quantity, units):
                scaled = tuple(factor * value if axis in chosen else value for axis, value in enumerate(values))
                yield f"unit of {key}", words, replace(frame, **{part: scaled})


def _in_targets(cell: Cell, campaign: Campaign) -> Iterator[tuple[str, str, dict[str, Plane | Point]]]:
    """Yields targets of which one is in another unit, and all of them."""
    said, metres = campaign.written, campaign.written.units.metres
    known = {n: t for n, t in cell.targets.items() if not _unknown(n, campaign)}
    for name, target in known.items():
        if isinstance(target, Plane):
            length = said.offsets.get(name, target.offset / metres) * metres / (target.offset or 1.0)
            for factor, words in _others(
                said.campaign, f"{name}.offset", [length * target.offset], "length", said.units
            ):
                yield f"unit of {name}.offset", words, {name: _farther(target, factor)}
            continue
        for chosen in ([0, 1, 2], [0], [1], [2]):
            key = f"{name}.position" if len(chosen) > 1 else f"{name}.{'xyz'[chosen[0]]}"
            own = [target.xyz[axis] for axis in chosen]
            for factor, words in _others(said.campaign, key, own, "length", said.units):
                x, y, z = (v * factor if axis in chosen else v for axis, v in enumerate(target.xyz))
                yield f"unit of {key}", words, {name: Point((x, y, z))}
    sizes = [t.offset if isinstance(t, Plane) else max(t.xyz, key=abs) for t in known.values()]
    for factor, unit in _factors(sizes, "length", said.units) if len(known) > 1 else ():
        words = f"{_of(said.campaign)}`targets` read as {unit}: so they explain the readings"
        yield "unit of targets", words, {name: _farther(target, factor) for name, target in known.items()}


def _in_joints(cell: Cell, readings: Readings, said: Written) -> Iterator[tuple[str, str, Readings]]:
    """Yields readings with a joint's column in another unit, and with all columns of angles so."""
    turning = [joint.type == "revolute" for joint in cell.arm.driven]
    groups = [([place], f"column `{name}`") for place, name in enumerate(cell.arm.joint_names)]
    if sum(turning) > 1:
        groups.append(([place for place, turns in enumerate(turning) if turns], "columns of turning joints"))
    for places, which in groups:
        quantity: Quantity = "angle" if turning[places[0]] else "length"
        for factor, words in _columns(readings.joints[:, places], quantity, which, said):
            scale = np.ones(len(turning))
            scale[places] = factor
            since = None if readings.since is None else readings.since * scale
            yield f"unit of {which}", words, replace(readings, joints=readings.joints * scale, since=since)


def _in_values(cell: Cell, readings: Readings, said: Written) -> Iterator[tuple[str, str, Readings]]:
    """Yields readings with a column of a sensor's in another unit, and with all of a sensor's so."""
    for name, sensor in cell.sensors.items():
        rows = np.flatnonzero([cell.aims[place].sensor == name for place in readings.target])
        if not isinstance(sensor, LaserRanger | DrawWire | Position | Pose) or not len(rows):
            continue
        lengths = sensor.columns[: 3 if isinstance(sensor, Position | Pose) else 1]
        groups = [([place], f"column `{column}`") for place, column in enumerate(lengths)]
        if len(lengths) > 1:
            groups.append(([*range(len(lengths))], f"columns {', '.join(lengths)}"))
        for places, which in groups:
            of = f"{which} of {name}" if len(cell.sensors) > 1 else which
            for factor, words in _columns(readings.values[np.ix_(rows, np.array(places))], "length", of, said):
                values = readings.values.copy()
                values[np.ix_(rows, np.array(places))] *= factor
                yield f"unit of {of}", words, replace(readings, values=values)


def _columns(numbers: np.ndarray, quantity: Quantity, which: str, said: Written) -> Iterator[tuple[float, str]]:
    verb = "read" if which.startswith("columns") else "reads"
    # Readings go round more than once: of them no size is too large.
    for factor, unit in _factors([float(np.median(np.abs(numbers)))], quantity, said.units):
        yield factor, f"{_of(said.observations)}{which} {verb} as {unit}: times {factor:.4g}, explains the readings"


def _others(
    file: str, key: str, values: Sequence[float], quantity: Quantity, units: Units
) -> Iterator[tuple[float, str]]:
    """Yields the factors that numbers [m or rad] may be wrong by, with the sentence that says so."""
    for factor, unit in _factors(values, quantity, units):
        now, then = (_shown([f * value / units.scale(quantity) for value in values]) for f in (1.0, factor))
        yield factor, f"{_of(file)}`{key}` = {now} reads as {unit}: {then} explains the readings"


def _factors(values: Sequence[float], quantity: Quantity, units: Units) -> Iterator[tuple[float, str]]:
    """Yields factors from numbers [m or rad] as read to what may be meant, and the unit that they are then in."""
    largest = max(map(abs, values), default=0.0)
    unit = units.length if quantity == "length" else units.angle
    for factor in _FACTORS[quantity]:
        if abs(factor - 1.0) * largest > NOTHING and factor * largest < LARGEST[quantity]:
            twice = f"a number {max(factor, 1.0 / factor):.4g} times too {'small' if factor > 1.0 else 'large'}"
            yield factor, _UNIT.get((quantity, unit, factor), twice)


def _shown(values: Sequence[float]) -> str:
    said = [f"{value:.6g}" for value in values]
    return said[0] if len(said) == 1 else f"[{', '.join(said)}]"


def _of(file: str) -> str:
    return f"{file}: " if file else ""


def _farther(target: Plane | Point, factor: float) -> Plane | Point:
    if isinstance(target, Plane):
        return replace(target, offset=factor * target.offset)
    x, y, z = (factor * value for value in target.xyz)
    return Point((x, y, z))


def _with_frame(cell: Cell, name: str, frame: Frame) -> Cell:
    if name == "base":
        return replace(cell, base=frame)
    return replace(cell, mount={**cell.mount, name: frame} if isinstance(cell.mount, dict) else frame)


def _unknown(owner: str, campaign: Campaign) -> bool:
    return any(name.rpartition(".")[0] == owner for name in campaign.sought)
