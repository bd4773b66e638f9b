"""What a campaign says of sensors, markers and targets, as the package's values."""

from __future__ import annotations

import math
from collections.abc import Mapping

from boresight.errors import did_you_mean
from boresight.files.documents import Document
from boresight.files.problems import Problems, listed, shown
from boresight.files.schemas import CampaignEntry, FrameEntry, PlaceEntry, PointEntry, SensorEntry
from boresight.geometry import Frame, Plane, Point
from boresight.sensing import (
    Aim,
    Distances,
    DrawWire,
    LaserRanger,
    PlaneContact,
    PointContact,
    Pose,
    Position,
    Sensor,
    Target,
)
from boresight.sensing.aims import targets_of
from boresight.units import Units

MOST_AIMS = 20_000
"""Ways in which rows can be taken: each sensor, on each marker, at each target."""

_EXAMPLES = {
    Plane: "targets: {deck: {type: plane, normal: [0, 0, 1], offset: -0.15}}",
    Point: "targets: {anchor: {type: point, position: [1, 0, 0]}}",
}


def sensor_of(entry: SensorEntry, units: Units) -> Sensor:
    """Returns the sensor that an entry describes."""
    noise, repeats = entry.noise_std * units.metres, entry.repeats
    if entry.noise_angle_std is not None:
        return Pose(noise, entry.noise_angle_std * units.radians, repeats)
    if entry.type == Distances.type:
        return Distances(math.sqrt(2.0) * noise, repeats)
    kinds: dict[str, type[LaserRanger | DrawWire | Position | PlaneContact | PointContact]]
    kinds = {kind.type: kind for kind in (LaserRanger, DrawWire, Position, PlaneContact, PointContact)}
    return kinds[entry.type](noise, repeats)


def frame_of(entry: FrameEntry | PlaceEntry, units: Units) -> Frame:
    """Returns the frame of an entry; what is unknown stands at zero."""
    x, y, z = (value * units.metres for value in entry.xyz or (0.0, 0.0, 0.0))
    roll, pitch, yaw = (value * units.radians for value in entry.rpy or (0.0, 0.0, 0.0))
    return Frame((x, y, z), (roll, pitch, yaw))


def read_targets(document: Document, entry: CampaignEntry, problems: Problems) -> dict[str, Target]:
    """Returns the targets by name, without those that make no sense; points that are unknown stand at zero."""
    metres = entry.units.value.metres
    targets: dict[str, Target] = {}
    for name, target in entry.targets.items():
        if isinstance(target, PointEntry):
            x, y, z = (value * metres for value in target.position or (0.0, 0.0, 0.0))
            targets[name] = Point((x, y, z))
            continue
        try:
            targets[name] = Plane.of(target.normal, target.offset * metres)
        except ValueError:
            given = f"{document.at(('targets', name, 'normal'))}got {shown(list(target.normal))}"
            problems.add(f"{given}; expected a direction, which is not zero and not beyond all measure")
    return targets


def read_aims(
    document: Document,
    entry: CampaignEntry,
    sensors: Mapping[str, Sensor],
    mounts: Mapping[str, Frame],
    targets: Mapping[str, Target],
    problems: Problems,
) -> tuple[Aim, ...]:
    """Returns every sensor on each of its markers at each target of its kind."""
    most = len(sensors) * len(mounts) * max(len(targets), 1)
    if most > MOST_AIMS:
        problems.add(
            f"{document.name}: {len(sensors)} sensors, {len(mounts)} markers and {len(targets)} targets combine "
            f"in {most:,} ways; expected at most {MOST_AIMS:,}: leave out what no row uses"
        )
        return ()
    aims = []
    for name, sensor in sensors.items():
        at = ("sensors", name) if entry.sensors is not None else ("sensor",)
        kind = sensor.aims_at
        if kind is not None and not any(isinstance(target, kind) for target in targets.values()):
            if not _spoiled(entry, kind):
                problems.add(
                    f"{document.at(at)}a {sensor.type} {_VERBS[sensor.type]} and there is none; "
                    f"expected {_EXAMPLES[kind]}"
                )
            continue
        chosen = entry.named_sensors[name].markers
        for marker in chosen or ():
            if marker not in mounts:
                near = did_you_mean(marker[:60], mounts)
                known = f"the markers are {listed(mounts)}" if entry.markers else "there are no markers"
                problems.add(f"{document.at((*at, 'markers'))}there is no marker {shown(marker)}{near}; {known}")
        own = [mount for mount in mounts if chosen is None or mount in chosen]
        aims += [Aim(name, mount, target) for mount in own for target in targets_of(sensor, targets)]
    return tuple(aims)


_VERBS = {
    "laser_ranger": "points at a target",
    "draw_wire": "is drawn to a point",
    "plane_contact": "touches a plane",
    "point_contact": "touches a point",
}


def _spoiled(entry: CampaignEntry, kind: type) -> bool:
    """Returns whether a target of a kind is there, though it makes no sense."""
    return any(isinstance(target, PointEntry) == (kind is Point) for target in entry.targets.values())
