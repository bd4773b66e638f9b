"""campaign.yaml and the files it names, as one immutable value."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

from boresight.arm import HARMONICS, SAG, Arm
from boresight.calibration.campaign import Campaign, Freedom, RobotFile
from boresight.errors import InputError, did_you_mean
from boresight.files.bag_observations import read_bag_observations
from boresight.files.bags.storages import is_bag
from boresight.files.composing import KeyPath
from boresight.files.documents import Document, read_document
from boresight.files.explaining import validated
from boresight.files.observations import Observations, read_observations
from boresight.files.patterns import Matcher
from boresight.files.problems import Problems, listed, shown
from boresight.files.robots import arm_of, is_urdf
from boresight.files.schemas import CampaignEntry, DataEntry, FrameEntry
from boresight.files.urdf import read_urdf
from boresight.geometry import Frame, Plane
from boresight.sensing import Cell, LaserRanger, Position, Sensor
from boresight.units import Units

SENSORS: dict[str, type[LaserRanger] | type[Position]] = {kind.type: kind for kind in (LaserRanger, Position)}
"""The kinds of sensor a campaign can name."""

_FRAME_AXES = {"xyz": ("x", "y", "z"), "rpy": ("roll", "pitch", "yaw")}


def load_campaign(path: Path | str, *, need_readings: bool = False) -> Campaign:
    """Returns the campaign that a file describes, with everything it names, in metres and radians.

    Args:
        path: the campaign.yaml; the files it names are relative to its folder.
        need_readings: whether a campaign without observations is an error.

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
    data: dict[str, Observations] = {}
    for key, named in (("observations", entry.observations), ("validation", entry.validation)):
        if named is not None:
            with problems.gathered():
                data[key] = _observations(document, key, named, cell, entry.units.value)
                inputs[named.name] = data[key].sha256
        elif key == "observations" and need_readings:
            problems.add(f"{document.at(())}there are no readings; expected observations: observations.csv")
    problems.raise_if_any()
    return Campaign(
        name=document.path.resolve().parent.name or cell.arm.name,
        cell=cell,
        readings=data["observations"].readings if "observations" in data else None,
        validation=data["validation"].readings if "validation" in data else None,
        freedoms=choice.freedoms,
        fixed=choice.fixed | robot.held,
        beyond=None if entry.beyond is None else tuple(entry.beyond),
        gravity=entry.gravity if isinstance(entry.gravity, tuple) else None,
        weightless=entry.gravity == "off",
        unknown=_unknown("base", entry.base) | _unknown("mount", entry.mount),
        set_aside=tuple(row for part in data.values() for row in part.set_aside),
        warnings=(*(warning for part in data.values() for warning in part.warnings), *_same_data(entry, data)),
        notes=(*choice.notes, *robot.notes, *(note for part in data.values() for note in part.notes)),
        inputs=inputs,
        robot_file=robot.file,
    )


def cell_of(document: Document, entry: CampaignEntry, robot: RobotOf, problems: Problems) -> Cell:
    """Returns the nominal cell; without an arm nothing else can be judged, so its faults are raised here."""
    units = entry.units.value
    targets: dict[str, Plane] = {}
    for name, plane in entry.targets.items():
        try:
            targets[name] = Plane.of(plane.normal, plane.offset * units.metres)
        except ValueError:
            given = f"{document.at(('targets', name, 'normal'))}got {shown(list(plane.normal))}"
            problems.add(f"{given}; expected a direction, which is not zero and not beyond all measure")
    # A cast, since a frozen value has no attributes to set and the protocol, as mypy reads it, has.
    sensor = cast(Sensor, SENSORS[entry.sensor.type](entry.sensor.noise_std * units.metres, entry.sensor.repeats))
    if sensor.needs_target and not entry.targets:
        example = "targets: {deck: {type: plane, normal: [0, 0, 1], offset: -0.15}}"
        problems.add(
            f"{document.at(('sensor',))}a {sensor.type} points at a target and there is none; expected {example}"
        )
    arm = None
    with problems.gathered():
        arm = robot.read()
    for name in sorted(set(arm.joint_names) & set(targets)) if arm else ():
        problems.add(f"{document.at(('targets', name))}a joint is called {name} too; expected another name")
    problems.raise_if_any()
    assert arm is not None
    return _as_asked(Cell(arm, sensor, _frame(entry.base, units), _frame(entry.mount, units), targets), entry)


def _as_asked(cell: Cell, entry: CampaignEntry) -> Cell:
    """Returns the cell under the campaign's gravity, its arm with whatever the campaign names."""
    named = {p.rpartition(".")[2][:3] for p in (*entry.fixed, *(p for e in entry.estimate or () for p in e.parameters))}
    arm = cell.arm.weightless() if entry.gravity == "off" else cell.arm
    arm = arm.with_harmonics() if named & {wave[:3] for wave in HARMONICS} else arm
    arm = arm.with_sag() if SAG in named and entry.gravity != "off" else arm
    cell = replace(cell, arm=arm)
    return cell.under(entry.gravity) if isinstance(entry.gravity, tuple) else cell


class RobotOf:
    """The robot that a campaign names: its arm, and, of a URDF, the file and what it cannot hold."""

    def __init__(
        self, document: Document, entry: CampaignEntry, inputs: dict[str, str], at: KeyPath = ("robot",)
    ) -> None:
        self._document, self._choice, self._inputs, self._at = document, entry.robot, inputs, at
        self.file: RobotFile | None = None
        self.held: frozenset[str] = frozenset()
        self.notes: tuple[str, ...] = ()

    def read(self) -> Arm:
        """Returns the arm; raises an `InputError` where there is none."""
        name, place = self._choice.urdf or self._choice.file, self._document.at(self._at)
        if name is None:
            return _of_catalogue(self._choice.catalogue or "", place)
        path = self._document.path.parent / name
        if self._choice.urdf is None and not is_urdf(name):
            robot = read_document(path, name, place)
            self._inputs[name] = robot.sha256
            return arm_of(robot)
        self.file = read_urdf(path, name, place, self._choice.base, self._choice.tip)
        self._inputs[name] = hashlib.sha256(self.file.content).hexdigest()
        chain = self.file.chain
        if not chain.ends_with_a_fixed_joint:
            last = chain.joints[-1].name
            self.held = frozenset(f"{last}.{number}" for number in ("a", "alpha", "beta"))
            self.notes = (
                f"{last}.a, .alpha and .beta are held: {chain.tip} is the link that {last} moves, and the URDF has no "
                "joint behind it to hold their corrections. Errors of the sensor's place are mount's.",
            )
        return chain.arm


def _observations(document: Document, key: str, named: DataEntry, cell: Cell, units: Units) -> Observations:
    path, place = document.path.parent / named.name, document.at((key,))
    if named.bag is not None or is_bag(path):
        return read_bag_observations(path, cell=cell, entry=named, named_by=place)
    return read_observations(path, cell=cell, units=units, name=named.name, named_by=place)


def _of_catalogue(wanted: str, place: str) -> Arm:
    from boresight.arm import catalogue  # a table of arms that most campaigns do without

    known = catalogue.names()
    if wanted not in known:
        near = did_you_mean(wanted[:60], known)
        raise InputError(f"{place}the catalogue has no arm {shown(wanted)}{near}; expected one of {listed(known)}")
    return catalogue.load(wanted)


def _frame(entry: FrameEntry, units: Units) -> Frame:
    x, y, z = (value * units.metres for value in entry.xyz or (0.0, 0.0, 0.0))
    roll, pitch, yaw = (value * units.radians for value in entry.rpy or (0.0, 0.0, 0.0))
    return Frame((x, y, z), (roll, pitch, yaw))


def _unknown(owner: str, entry: FrameEntry) -> frozenset[str]:
    parts = [part for part in _FRAME_AXES if getattr(entry, part) is None]
    return frozenset(f"{owner}.{axis}" for part in parts for axis in _FRAME_AXES[part])


def _same_data(entry: CampaignEntry, data: dict[str, Observations]) -> list[str]:
    if len(data) < 2 or data["observations"].sha256 != data["validation"].sha256:
        return []
    assert entry.validation is not None
    return [f"{entry.validation.name}: the readings to validate with are those to calibrate with; they prove nothing"]


@dataclass(frozen=True, slots=True)
class Choice:
    """What is estimated and what is not, with patterns written out."""

    freedoms: tuple[Freedom, ...] | None
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
        for i, item in enumerate(entry.estimate or ()):
            prior = item.within / math.sqrt(3.0) if item.prior_std is None else item.prior_std
            for k, pattern in enumerate(item.parameters):
                for name in reached(pattern, ("estimate", i, "parameters", k)):
                    scale = units.scale(quantity[name])
                    freedoms[name] = Freedom(name, item.within * scale, prior * scale)
        ordered = tuple(freedoms[name] for name in matcher.names if name in freedoms and name not in fixed)
        return cls(None if entry.estimate is None else ordered, frozenset(fixed), tuple(notes))
