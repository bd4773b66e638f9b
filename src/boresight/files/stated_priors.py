"""Standard deviations that a campaign states of what it does not estimate: the GUM's Type B."""

from __future__ import annotations

import math

import numpy as np

from boresight.files.documents import Document
from boresight.files.patterns import Matcher
from boresight.files.problems import Problems
from boresight.files.schemas import CampaignEntry, FrameEntry, PlaneEntry, PointEntry
from boresight.geometry import Plane
from boresight.sensing import Cell, Readings
from boresight.units import Units

_UNIFORM = math.sqrt(12.0)
"""Width of a uniform distribution over its standard deviation."""


def read_priors(document: Document, entry: CampaignEntry, cell: Cell, problems: Problems) -> dict[str, float]:
    """Returns the stated standard deviation [m, rad or 1] of each parameter, later statements over earlier ones."""
    units, found = entry.units.value, dict[str, float]()
    for name, sensor in entry.named_sensors.items():
        for number, scale in (("bias", units.metres), ("scale", 1.0)):
            std = getattr(sensor, f"{number}_std")
            if std is not None:
                found[f"{name}.{number}"] = std * scale
    for name, frame in {"base": entry.base, **entry.named_mounts}.items():
        found |= _of_frame(name, frame, units)
    for name, target in entry.targets.items():
        if name in cell.targets:
            found |= _of_target(name, target, cell, units)
    matcher = Matcher(cell)
    quantity = {parameter.name: parameter.quantity for parameter in cell.parameters}
    for i, prior in enumerate(entry.priors):
        for k, pattern in enumerate(prior.parameters):
            reached = matcher.match(pattern).parameters
            if not reached:
                problems.add(f"{document.at(('priors', i, 'parameters', k))}{matcher.nothing(pattern)}")
            found |= {name: prior.prior_std * units.scale(quantity[name]) for name in reached}
    return found


def _of_frame(name: str, frame: FrameEntry, units: Units) -> dict[str, float]:
    found: dict[str, float] = {}
    if frame.xyz_std is not None:
        found |= {f"{name}.{axis}": frame.xyz_std * units.metres for axis in "xyz"}
    if frame.rpy_std is not None:
        found |= {f"{name}.{turn}": frame.rpy_std * units.radians for turn in ("roll", "pitch", "yaw")}
    return found


def _of_target(name: str, target: PlaneEntry | PointEntry, cell: Cell, units: Units) -> dict[str, float]:
    if isinstance(target, PointEntry):
        std = target.position_std
        return {} if std is None else {f"{name}.{axis}": std * units.metres for axis in "xyz"}
    plane, found = cell.targets[name], dict[str, float]()
    assert isinstance(plane, Plane)
    if target.offset_std is not None:
        found[f"{name}.offset"] = target.offset_std * units.metres
    if target.normal_std is not None:
        # A tilt by one angle about any axis in the plane moves component i of the normal by sqrt(1 - n_i²) of it.
        tilt = target.normal_std * units.radians
        found |= {
            f"{name}.normal_{'xyz'[i]}": tilt * math.sqrt(max(1.0 - plane.normal[i] ** 2, 1e-6))
            for i in plane.free_components
        }
    return found


def read_joint_noise(document: Document, entry: CampaignEntry, cell: Cell, problems: Problems) -> tuple[float, ...]:
    """Returns the standard deviation of each joint's readings [rad or m]; nothing where none is stated."""
    stated, units = entry.joint_noise_std, entry.units.value
    if stated is None:
        return ()
    driven = cell.arm.driven
    if not isinstance(stated, dict):
        return tuple(stated * units.radians if joint.type == "revolute" else 0.0 for joint in driven)
    for name in stated:
        if name not in cell.arm.joint_names:
            known = ", ".join(cell.arm.joint_names)
            problems.add(f"{document.at(('joint_noise_std', name))}there is no such joint; the joints are {known}")
    scale = {"revolute": units.radians, "prismatic": units.metres}
    return tuple(stated.get(joint.name, 0.0) * scale[joint.type] for joint in driven)


def with_flatness(entry: CampaignEntry, cell: Cell, readings: Readings) -> Readings:
    """Returns readings whose standard deviations hold their planes' lack of flatness too.

    Flatness is the width of the zone between two parallel planes that holds the surface (ISO 1101); a spot of it lies
    anywhere in between. Along a beam that meets the plane at an angle, the zone is wider by one over its cosine.
    """
    metres = entry.units.value.metres
    flat = {
        name: target.flatness * metres / _UNIFORM
        for name, target in entry.targets.items()
        if isinstance(target, PlaneEntry) and target.flatness is not None
    }
    if not flat:
        return readings
    std = readings.std.copy()
    poses = cell.poses(readings.joints, target=readings.target)
    for place, aim in enumerate(cell.aims):
        if aim.target not in flat:
            continue
        plane, rows = cell.targets[aim.target], readings.target == place
        assert isinstance(plane, Plane)
        along = np.abs(poses[rows, :3, 2] @ np.asarray(plane.normal))
        cosine = np.maximum(along, 0.1) if cell.sensors[aim.sensor].type == "laser_ranger" else 1.0
        std[rows] = np.hypot(std[rows], (flat[aim.target] / cosine * np.ones(len(along)))[:, None])
    return Readings(
        readings.joints,
        readings.values,
        std,
        readings.target,
        readings.line,
        readings.reference,
        readings.session,
        readings.since,
    )
