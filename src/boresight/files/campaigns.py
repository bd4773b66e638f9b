"""campaign.yaml and the files it names, as one immutable value."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import cast

from boresight.arm import Arm
from boresight.calibration.campaign import Campaign, Freedom
from boresight.errors import InputError, did_you_mean
from boresight.files.documents import Document, read_document
from boresight.files.explaining import validated
from boresight.files.observations import Observations, read_observations
from boresight.files.patterns import Matcher
from boresight.files.problems import Problems, listed, shown
from boresight.files.robots import arm_of, refuse_urdf
from boresight.files.schemas import CampaignEntry, FrameEntry
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
        need_readings: whether a campaign without observations, or with configurations alone, is an error.

    Raises:
        InputError: everything that is wrong with the files, as far as it can be told at once.
    """
    document = read_document(path)
    entry = validated(document, CampaignEntry)
    problems = Problems()
    inputs = {document.path.name: document.sha256}
    cell = _cell(document, entry, inputs, problems)
    choice = _Choice.of(document, entry, cell, problems)
    data: dict[str, Observations] = {}
    for key, name in (("observations", entry.observations), ("validation", entry.validation)):
        if name is not None:
            with problems.gathered():
                place, units = document.at((key,)), entry.units.value
                data[key] = read_observations(
                    document.path.parent / name,
                    cell=cell,
                    units=units,
                    name=name,
                    named_by=place,
                    need_values=need_readings or key == "validation",
                )
                inputs[name] = data[key].sha256
        elif key == "observations" and need_readings:
            problems.add(f"{document.at(())}there are no readings; expected observations: observations.csv")
    problems.raise_if_any()
    return Campaign(
        name=document.path.resolve().parent.name or cell.arm.name,
        cell=cell,
        readings=data["observations"].readings if "observations" in data else None,
        validation=data["validation"].readings if "validation" in data else None,
        freedoms=choice.freedoms,
        fixed=choice.fixed,
        unknown=_unknown("base", entry.base) | _unknown("mount", entry.mount),
        set_aside=tuple(row for part in data.values() for row in part.set_aside),
        warnings=(*(warning for part in data.values() for warning in part.warnings), *_same_data(entry, data)),
        notes=choice.notes,
        inputs=inputs,
    )


def _cell(document: Document, entry: CampaignEntry, inputs: dict[str, str], problems: Problems) -> Cell:
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
        arm = _arm(document, entry, inputs)
    for name in sorted(set(arm.joint_names) & set(targets)) if arm else ():
        problems.add(f"{document.at(('targets', name))}a joint is called {name} too; expected another name")
    problems.raise_if_any()
    assert arm is not None
    return Cell(arm, sensor, _frame(entry.base, units), _frame(entry.mount, units), targets)


def _arm(document: Document, entry: CampaignEntry, inputs: dict[str, str]) -> Arm:
    name, place = entry.robot.file, document.at(("robot",))
    if name is not None:
        refuse_urdf(name, place)
        robot = read_document(document.path.parent / name, name, place)
        inputs[name] = robot.sha256
        return arm_of(robot)
    from boresight.arm import catalogue  # a table of arms that most campaigns do without

    known, wanted = catalogue.names(), entry.robot.catalogue or ""
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
    return [f"{entry.validation}: the readings to validate with are those to calibrate with; they prove nothing"]


@dataclass(frozen=True, slots=True)
class _Choice:
    """What is estimated and what is not, with patterns written out."""

    freedoms: tuple[Freedom, ...] | None
    fixed: frozenset[str]
    notes: tuple[str, ...]

    @classmethod
    def of(cls, document: Document, entry: CampaignEntry, cell: Cell, problems: Problems) -> _Choice:
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
