"""robot.yaml, read and written."""

from __future__ import annotations

import math
from pathlib import Path

from boresight.arm import DOWN, HARMONICS, LINK_NUMBERS, Arm, Joint
from boresight.errors import InputError
from boresight.files.documents import Document, read_document
from boresight.files.equipment import frame_of
from boresight.files.explaining import validated
from boresight.files.names import comment_lines, yaml_quoted
from boresight.files.problems import Problems, shown
from boresight.files.schemas import JointEntry, RobotEntry, UnitsEntry
from boresight.files.urdf import SUFFIXES, read_urdf
from boresight.geometry import Frame
from boresight.units import Units

_LENGTHS = ("d", "a")


def load_robot(path: Path | str, base: str | None = None, tip: str | None = None) -> Arm:
    """Returns the arm that a robot.yaml or a URDF describes.

    Args:
        path: where it is.
        base: of a URDF, the link the arm stands on; the root link by default.
        tip: of a URDF, the link that carries the sensor; the last link, if there is only one, by default.

    Raises:
        InputError: everything that is wrong with the file.
    """
    if is_urdf(str(path)):
        return read_urdf(path, base=base, tip=tip).chain.arm
    if base is not None or tip is not None:
        raise InputError(f"{path}: base and tip are links of a URDF; a robot.yaml has none")
    return arm_of(read_document(path))


def is_urdf(name: str) -> bool:
    """Whether a robot file is read as URDF, by the end of its name."""
    return Path(name).suffix.lower() in SUFFIXES


def arm_of(document: Document) -> Arm:
    """Returns the arm that a document describes, in metres and radians."""
    problems = Problems()
    problems.extend(_repeated_names(document))
    with problems.gathered():
        entry = validated(document, RobotEntry)
        problems.extend(_sag_out_of_place(document, entry))
    problems.raise_if_any()
    units = entry.units.value
    joints = tuple(_joint(joint, units, entry) for joint in entry.joints)
    root, tip = (frame_of(place, units) for place in (entry.root, entry.tip))
    return Arm(entry.name, joints, entry.convention, root, tip, entry.gravity or DOWN)


def units_of(document: Document) -> Units | None:
    """Returns the units that a robot's document is in; None where it does not say them as it should."""
    given = document.data.get("units", {}) if isinstance(document.data, dict) else {}
    try:
        return UnitsEntry.model_validate(given).value
    except ValueError:
        return None  # `arm_of` says what is wrong with it


def dump_robot(arm: Arm, header_comment: str = "") -> str:
    """Returns the text of a robot.yaml, in metres and radians, that loads again to the same bits.

    Args:
        arm: what to write.
        header_comment: lines to put above it.
    """
    numbers = ("theta", "d", "a", "alpha", "beta")
    lines = [f"# {line}".rstrip() for line in comment_lines(header_comment)]
    lines += [
        f"name: {yaml_quoted(arm.name)}",
        "units: {length: m, angle: rad}",
        f"convention: {arm.convention}",
        *_place("root", arm.root),
        *([f"gravity: {list(map(float, arm.gravity))}"] if any(joint.sag for joint in arm.joints) else []),
        "joints:",
    ]
    for joint in arm.joints:
        links = ", ".join(f"{number}: {float(getattr(joint, number))!r}" for number in numbers)
        low, high = map(float, joint.limits)
        limits = "none" if math.isinf(low) else f"[{low!r}, {high!r}]"
        follows = f", follows: {yaml_quoted(joint.follows)}, ratio: {float(joint.ratio)!r}" if joint.follows else ""
        further = follows + _further(joint)
        lines.append(f"  - {{name: {yaml_quoted(joint.name)}, type: {joint.type}, {links}, limits: {limits}{further}}}")
    return "\n".join([*lines, *_place("tip", arm.tip)]) + "\n"


def _place(name: str, frame: Frame) -> list[str]:
    """Returns the line of a frame, or none for one that is nothing."""
    xyz, rpy = ([float(value) for value in part] for part in (frame.xyz, frame.rpy))
    return [f"{name}: {{xyz: {xyz}, rpy: {rpy}}}"] if frame != Frame() else []


def _further(joint: Joint) -> str:
    """Returns what turns a joint beside its reading, as further keys; what is 0 turns nothing."""
    waves = "".join(f", {wave}: {float(h)!r}" for wave, h in zip(HARMONICS, joint.harmonics, strict=False) if h)
    sag = ", ".join(f"{link}: {float(turn)!r}" for link, turn in joint.sag if turn)
    return waves + (f", sag: {{{sag}}}" if sag else "")


def _joint(entry: JointEntry, units: Units, robot: RobotEntry) -> Joint:
    numbers = {
        number: getattr(entry, number) * (units.metres if number in _LENGTHS else units.radians)
        for number in LINK_NUMBERS
    }
    scale = units.radians if entry.type == "revolute" else units.metres
    low, high = (limit * scale for limit in entry.limits) if entry.limits else (-math.pi, math.pi)
    ratio = entry.ratio
    if entry.follows is not None:
        leads = next(joint.type for joint in robot.joints if joint.name == entry.follows)
        ratio *= scale / (units.radians if leads == "revolute" else units.metres)
    harmonics = tuple(height * units.radians for height in entry.harmonics)
    sag = tuple((link, turn * units.radians) for link, turn in entry.sag)
    return Joint(
        entry.name,
        entry.type,
        limits=(low, high),
        follows=entry.follows,
        ratio=ratio,
        harmonics=harmonics,
        sag=sag,
        **numbers,
    )


def _sag_out_of_place(document: Document, entry: RobotEntry) -> list[str]:
    """Joints said to sag under links that do not come after them, or do not exist."""
    return [
        f"{document.at(('joints', place, 'sag'))}{shown(joint.name)} sags under link {link}; expected its own link, "
        f"{place + 1}, or one after it, to {len(entry.joints)}"
        for place, joint in enumerate(entry.joints)
        for link, _ in joint.sag
        if not place < link <= len(entry.joints)
    ]


def _repeated_names(document: Document) -> list[str]:
    """Joints of one name, found before the rest is checked so that both kinds of fault are told at once."""
    data = document.data
    joints = data.get("joints") if isinstance(data, dict) else None
    faults, seen = [], set()
    for place, joint in enumerate(joints if isinstance(joints, list) else ()):
        name = joint.get("name") if isinstance(joint, dict) else None
        if isinstance(name, str) and name in seen:
            where = document.at(("joints", place, "name"))
            faults.append(f"{where}{shown(name)} is the name of an earlier joint; expected another")
        elif isinstance(name, str):
            seen.add(name)
    return faults
