"""campaign.yaml and the files it names, as one immutable value."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

from boresight.arm import HARMONICS, SAG, Arm
from boresight.calibration.campaign import Campaign, Freedom
from boresight.calibration.written import Written
from boresight.errors import InputError
from boresight.files.bag_observations import read_bag_observations
from boresight.files.bags.storages import is_bag
from boresight.files.chosen_robots import RobotOf
from boresight.files.columns import clashes
from boresight.files.documents import Document, read_document
from boresight.files.equipment import frame_of, read_aims, read_targets, sensor_of
from boresight.files.explaining import validated
from boresight.files.extents import extent_of
from boresight.files.observations import Observations, read_observations
from boresight.files.patterns import Matcher
from boresight.files.plausible_readings import readings_fault
from boresight.files.plausible_units import check_arm
from boresight.files.problems import Problems, listed, printable, shown
from boresight.files.schemas import DEFAULT, CampaignEntry, DataEntry, PlaneEntry, PointEntry
from boresight.files.sessions import ONLY, in_sessions, sessions_of, with_sessions
from boresight.files.short_lengths import without_short_lengths
from boresight.files.stated_priors import read_joint_noise, read_priors, with_flatness
from boresight.sensing import Cell, Readings
from boresight.units import Units

_FRAME_AXES = {"xyz": ("x", "y", "z"), "rpy": ("roll", "pitch", "yaw")}


def load_campaign(path: Path | str, *, need_readings: bool = False) -> Campaign:
    """Returns the campaign that a file describes, with everything it names, in metres and radians.

    Args:
        path: the campaign.yaml; the files it names are relative to its folder.
        need_readings: whether a campaign without observations, or with configurations alone, is an error.

    Raises:
        InputError: everything that is wrong with the files, as far as it can be told at once.
    """
    document = read_document(path)
    entry = validated(document, CampaignEntry)
    problems = Problems()
    inputs = {document.path.name: document.sha256}
    robot = RobotOf(document, entry, inputs)
    cell = cell_of(document, entry, robot, problems)
    choice = Choice.of(document, entry, cell, problems)
    priors = read_priors(document, entry, cell, problems)
    joint_noise = read_joint_noise(document, entry, cell, problems)
    data: dict[str, Observations] = {}
    for key, named in (("observations", entry.observations), ("validation", entry.validation)):
        if named is not None:
            with problems.gathered():
                need = need_readings or key == "validation"
                data[key] = _observations(document, key, named, cell, entry.units.value, need)
                inputs[named.name] = data[key].sha256
        elif key == "observations" and need_readings:
            problems.add(f"{document.at(())}there are no readings; expected observations: observations.csv")
    problems.raise_if_any()
    extent = extent_of(cell.arm, [part.readings.joints for part in data.values()])
    check_arm(cell, extent, robot.called, document.name, problems)
    for key, part in data.items():
        fault = readings_fault(cell, extent, part.readings, _unknown(entry), entry.units.value, robot.called.name)
        if fault is not None and not problems:
            problems.add(f"{getattr(entry, key).name}: {fault}")
    problems.raise_if_any()
    of_unknown_zero = _of_unknown_zero(entry, choice)
    for key in data:
        with problems.gathered():
            name = getattr(entry, key).name
            data[key] = without_short_lengths(data[key], cell, name, entry.units.value, of_unknown_zero)
    problems.raise_if_any()
    plain, readings = cell, {key: with_flatness(entry, cell, part.readings) for key, part in data.items()}
    sensors = [name for name, sensor in entry.named_sensors.items() if sensor.offset_per is not None]
    if sensors:
        cell = _with_sessions(entry, plain, sensors, readings.get("observations"), problems)
        readings = {
            key: in_sessions(part, plain, cell, getattr(entry, key).name, problems) for key, part in readings.items()
        }
        problems.raise_if_any()
    return Campaign(
        name=printable(document.path.resolve().parent.name) or cell.arm.name,
        cell=cell,
        readings=readings.get("observations"),
        validation=readings.get("validation"),
        freedoms=choice.freedoms,
        beside_default=choice.beside_default,
        priors=priors,
        joint_noise_std=joint_noise,
        fixed=choice.fixed | robot.held,
        beyond=None if entry.beyond is None else tuple(entry.beyond),
        gravity=entry.gravity if isinstance(entry.gravity, tuple) else None,
        weightless=entry.gravity == "off",
        unknown=_unknown(entry) | set(cell.offsets),
        set_aside=tuple(row for part in data.values() for row in part.set_aside),
        warnings=(*(warning for part in data.values() for warning in part.warnings), *_same_data(entry, data)),
        notes=(*choice.notes, *robot.notes, *(note for part in data.values() for note in part.notes)),
        inputs=inputs,
        robot_file=robot.file,
        written=_written(document, entry, robot),
    )


def _written(document: Document, entry: CampaignEntry, robot: RobotOf) -> Written:
    offsets = {name: target.offset for name, target in entry.targets.items() if isinstance(target, PlaneEntry)}
    observations = "" if entry.observations is None else entry.observations.name
    called = robot.called
    return Written(called.name, document.name, observations, called.units or Units(), entry.units.value, offsets)


def cell_of(document: Document, entry: CampaignEntry, robot: RobotOf, problems: Problems) -> Cell:
    """Returns the nominal cell; without an arm nothing else can be judged, so its faults are raised here."""
    units = entry.units.value
    targets = read_targets(document, entry, problems)
    sensors = {name: sensor_of(each, units) for name, each in entry.named_sensors.items()}
    mounts = {name: frame_of(each, units) for name, each in entry.named_mounts.items()}
    aims = read_aims(document, entry, sensors, mounts, targets, problems)
    arm = None
    with problems.gathered():
        arm = robot.read()
    _check_names(document, entry, arm, problems)
    problems.raise_if_any()
    assert arm is not None
    cell = Cell(
        arm,
        sensors if entry.sensors is not None else sensors["sensor"],
        frame_of(entry.base, units),
        mounts if entry.markers is not None else mounts["mount"],
        targets,
        aims if entry.sensors is not None or entry.markers is not None else (),
    )
    if clashing := clashes(cell):
        problems.add(
            f"{document.at(('robot',))}joint {listed(clashing)} is called as a column of the readings is; call it "
            "something else, as no file could tell them apart"
        )
    problems.raise_if_any()
    return _as_asked(cell, entry)


def _with_sessions(
    entry: CampaignEntry, cell: Cell, sensors: list[str], readings: Readings | None, problems: Problems
) -> Cell:
    """Returns the cell with an offset for every session of the sensors that ask for them."""
    if readings is None:
        return with_sessions(cell, sensors, [ONLY])
    if readings.session is None:
        problems.add(
            f"{entry.observations.name if entry.observations else ''}: there is no column session; expected one, as "
            f"`offset_per: session` gives {listed(sensors)} an offset for each"
        )
        problems.raise_if_any()
    return with_sessions(cell, sensors, sessions_of(readings, cell, sensors) or [ONLY])


def _check_names(document: Document, entry: CampaignEntry, arm: Arm | None, problems: Problems) -> None:
    """Adds a fault for every name that two things have, since parameters are called after them."""
    taken = dict.fromkeys(arm.joint_names if arm else (), "a joint")
    kinds = {"targets": "a target", "markers": "a marker", "sensors": "a sensor"}
    for key, kind in kinds.items():
        for name in getattr(entry, key) or ():
            if name in taken:
                problems.add(f"{document.at((key, name))}{taken[name]} is called {name} too; expected another name")
            taken[name] = kind


def _as_asked(cell: Cell, entry: CampaignEntry) -> Cell:
    """Returns the cell under the campaign's gravity, its arm with whatever the campaign names."""
    named = {p.rpartition(".")[2][:3] for p in (*entry.fixed, *(p for e in entry.estimate or () for p in e.parameters))}
    arm = cell.arm.weightless() if entry.gravity == "off" else cell.arm
    arm = arm.with_harmonics() if named & {wave[:3] for wave in HARMONICS} else arm
    arm = arm.with_sag() if SAG in named and entry.gravity != "off" else arm
    cell = replace(cell, arm=arm)
    return cell.under(entry.gravity) if isinstance(entry.gravity, tuple) else cell


def _observations(
    document: Document, key: str, named: DataEntry, cell: Cell, units: Units, need_values: bool
) -> Observations:
    path, place = document.path.parent / named.name, document.at((key,))
    if named.bag is not None or is_bag(path):
        return read_bag_observations(path, cell=cell, entry=named, named_by=place)
    if named.of_bags:
        raise InputError(
            f"{place}{listed(named.of_bags)} beside {shown(named.name)}, which is no ROS bag; these keys choose and "
            "cut what a bag holds: leave them out, or name a bag"
        )
    return read_observations(path, cell=cell, units=units, name=named.name, named_by=place, need_values=need_values)


def _of_unknown_zero(entry: CampaignEntry, choice: Choice) -> frozenset[str]:
    """Returns the sensors whose zero is estimated."""
    estimated = {f.parameter.removesuffix(".bias") for f in choice.freedoms or () if f.parameter.endswith(".bias")}
    return frozenset(estimated | {name for name, each in entry.named_sensors.items() if each.offset_per is not None})


def _unknown(entry: CampaignEntry) -> frozenset[str]:
    """Returns the parameters that a campaign calls unknown."""
    owners = {"base": entry.base, **entry.named_mounts}
    unknown = {
        f"{owner}.{axis}"
        for owner, frame in owners.items()
        for part, axes in _FRAME_AXES.items()
        if getattr(frame, part) is None
        for axis in axes
    }
    points = (name for name, target in entry.targets.items() if isinstance(target, PointEntry) and not target.position)
    return frozenset(unknown | {f"{name}.{axis}" for name in points for axis in "xyz"})


def _same_data(entry: CampaignEntry, data: dict[str, Observations]) -> list[str]:
    if len(data) < 2 or data["observations"].sha256 != data["validation"].sha256:
        return []
    assert entry.validation is not None
    return [f"{entry.validation.name}: the readings to validate with are those to calibrate with; they prove nothing"]


@dataclass(frozen=True, slots=True)
class Choice:
    """What is estimated and what is not, with patterns written out."""

    freedoms: tuple[Freedom, ...] | None
    beside_default: bool
    fixed: frozenset[str]
    notes: tuple[str, ...]

    @classmethod
    def of(cls, document: Document, entry: CampaignEntry, cell: Cell, problems: Problems) -> Choice:
        """Returns the choice that `estimate` and `fixed` state."""
        matcher, units = Matcher(cell), entry.units.value
        quantity = {parameter.name: parameter.quantity for parameter in cell.parameters}
        notes: dict[str, None] = {}

        def reached(pattern: str, where: tuple[str | int, ...]) -> tuple[str, ...]:
            match = matcher.match(pattern)
            if not match.parameters:
                problems.add(f"{document.at(where)}{matcher.nothing(pattern)}")
            for asked, other in match.stand_ins.items():
                notes[
                    f"{asked} follows from the rest of that normal, whose y is about 0, so {other} stands in for it."
                ] = None
            return match.parameters

        fixed = {name for i, pattern in enumerate(entry.fixed) for name in reached(pattern, ("fixed", i))}
        freedoms: dict[str, Freedom] = {}
        beside_default = False
        for i, item in enumerate(entry.estimate or ()):
            if item.parameters == DEFAULT["parameters"]:
                beside_default = True
                continue
            prior = item.within / math.sqrt(3.0) if item.prior_std is None else item.prior_std
            for k, pattern in enumerate(item.parameters):
                for name in reached(pattern, ("estimate", i, "parameters", k)):
                    scale = units.scale(quantity[name])
                    freedoms[name] = Freedom(name, item.within * scale, prior * scale)
        ordered = tuple(freedoms[name] for name in matcher.names if name in freedoms and name not in fixed)
        return cls(None if entry.estimate is None else ordered, beside_default, frozenset(fixed), tuple(notes))
