"""robot.yaml, read and written."""

from __future__ import annotations

import json
import math
from pathlib import Path

from boresight.arm import DOWN, HARMONICS, LINK_NUMBERS, Arm, Joint
from boresight.errors import InputError
from boresight.files.documents import Document, read_document
from boresight.files.explaining import validated
from boresight.files.problems import Problems, shown
from boresight.files.schemas import JointEntry, RobotEntry
from boresight.units import Units

_LENGTHS = ("d", "a")


def load_robot(path: Path | str) -> Arm:
    """Returns the arm that a robot.yaml describes.

    Raises:
        InputError: everything that is wrong with the file.
    """
    refuse_urdf(str(path))
    return arm_of(read_document(path))


def refuse_urdf(name: str, named_by: str = "") -> None:
    """Raises an `InputError` for a robot file of a kind that cannot be read yet."""
    if Path(name).suffix.lower() in (".urdf", ".xacro", ".xml"):
        raise InputError(f"{named_by}{name}: URDF robots are not supported yet; expected a robot.yaml")


def arm_of(document: Document) -> Arm:
    """Returns the arm that a document describes, in metres and radians."""
    problems = Problems()
    problems.extend(_repeated_names(document))
    with problems.gathered():
        entry = validated(document, RobotEntry)
        problems.extend(_sag_out_of_place(document, entry))
    problems.raise_if_any()
    units = entry.units.value
    joints = tuple(_joint(joint, units) for joint in entry.joints)
    return Arm(entry.name, joints, entry.convention, entry.gravity or DOWN)


def dump_robot(arm: Arm, header_comment: str = "") -> str:
    """Returns the text of a robot.yaml, in metres and radians, that loads again to the same bits.

    Args:
        arm: what to write.
        header_comment: lines to put above it.
    """
    numbers = ("theta", "d", "a", "alpha", "beta")
    lines = [f"# {line}".rstrip() for line in header_comment.splitlines()]
    lines += [
        f"name: {_quoted(arm.name)}",
        "units: {length: m, angle: rad}",
        f"convention: {arm.convention}",
        *([f"gravity: {list(map(float, arm.gravity))}"] if any(joint.sag for joint in arm.joints) else []),
        "joints:",
    ]
    for joint in arm.joints:
        links = ", ".join(f"{number}: {float(getattr(joint, number))!r}" for number in numbers)
        low, high = map(float, joint.limits)
        lines.append(
            f"  - {{name: {_quoted(joint.name)}, type: {joint.type}, {links}, limits: [{low!r}, {high!r}]"
            f"{_further(joint)}}}"
        )
    return "\n".join(lines) + "\n"


def _further(joint: Joint) -> str:
    """Returns what turns a joint beside its reading, as further keys; what is 0 turns nothing."""
    waves = "".join(f", {wave}: {float(h)!r}" for wave, h in zip(HARMONICS, joint.harmonics, strict=False) if h)
    sag = ", ".join(f"{link}: {float(turn)!r}" for link, turn in joint.sag if turn)
    return waves + (f", sag: {{{sag}}}" if sag else "")


def _quoted(name: str) -> str:
    # YAML 1.2 holds JSON: a quoted name is itself, whatever it looks like.
    return json.dumps(name, ensure_ascii=False)


def _joint(entry: JointEntry, units: Units) -> Joint:
    numbers = {
        number: getattr(entry, number) * (units.metres if number in _LENGTHS else units.radians)
        for number in LINK_NUMBERS
    }
    scale = units.radians if entry.type == "revolute" else units.metres
    low, high = (limit * scale for limit in entry.limits) if entry.limits else (-math.pi, math.pi)
    harmonics = tuple(height * units.radians for height in entry.harmonics)
    sag = tuple((link, turn * units.radians) for link, turn in entry.sag)
    return Joint(entry.name, entry.type, limits=(low, high), harmonics=harmonics, sag=sag, **numbers)


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
