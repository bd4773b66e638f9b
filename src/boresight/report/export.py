"""An identified arm in the formats that others read."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from typing import Any, Literal, get_args

from boresight.arm import HARMONICS, SAG, Arm
from boresight.arm.conditioning import well_conditioned
from boresight.arm.conventions import Convention
from boresight.arm.screws import Screws, screws_of
from boresight.arm.serial import chain_of
from boresight.errors import InputError
from boresight.files.names import comment_lines, yaml_key
from boresight.files.robots import dump_robot
from boresight.files.universal_robots import (
    calibration_conf,
    is_universal,
    kinematics_yaml,
    universal_blocks,
    universal_chain,
)
from boresight.files.urdf_writing import dump_urdf
from boresight.geometry import Frame
from boresight.report.converting import in_convention, largest_difference
from boresight.report.frames_beside import in_words
from boresight.report.link_table import link_table
from boresight.report.stored import StoredResult
from boresight.units import in_millimetres

Format = Literal["urdf", "dh", "ur-kinematics", "ur-calibration-conf", "pal", "json"]
FORMATS: tuple[str, ...] = get_args(Format)

ARM_SCHEMA = "boresight-arm/1"
"""Name and version of the JSON export's layout."""

_DELTAS = ("dx", "dy", "dz", "droll", "dpitch", "dyaw")


@dataclass(frozen=True, slots=True)
class Export:
    """An exported arm.

    Attributes:
        content: the file's text or bytes.
        notes: what a person should know about it.
    """

    content: str | bytes
    notes: tuple[str, ...] = ()


def export(stored: StoredResult, to: Format, convention: Convention | None = None, table: bool = False) -> Export:
    """Returns the identified arm of a result in another format.

    Args:
        stored: the result.
        to: the format.
        convention: of `dh`; the arm's own by default.
        table: `dh` as a CSV table instead of a robot.yaml.

    Raises:
        InputError: that format cannot hold this arm exactly.
    """
    found = _with_bends(stored, to, convention, table)
    if to == "json":
        return found  # which has the frames
    return replace(found, notes=(*found.notes, *in_words(stored.frames, stored.identified)))


def _with_bends(stored: StoredResult, to: Format, convention: Convention | None, table: bool) -> Export:
    """Returns the export of an arm, without what turns its joints beside their readings where a format has no place."""
    if not stored.identified.is_bent:
        return _exported(stored, to, convention, table)
    if to == "json" or (to == "dh" and not table and convention in (None, stored.identified.convention)):
        return _exported(stored, to, convention, table)
    rigid = replace(stored, nominal=stored.nominal.rigid, identified=stored.identified.rigid)
    found = _exported(rigid, to, convention, table)
    shift, _ = largest_difference(rigid.identified, stored.identified)
    note = (
        "This format holds the geometry alone; what turns the joints beside their readings, gravity's sag and "
        f"harmonics, is in robot-calibrated.yaml. Without it the tool is off by up to {in_millimetres(shift)}."
    )
    return replace(found, notes=(*found.notes, note))


def _exported(stored: StoredResult, to: Format, convention: Convention | None, table: bool) -> Export:
    if to == "urdf":
        return Export(stored.urdf if stored.urdf is not None else _new_urdf(stored))
    if to == "dh":
        arm = in_convention(stored.identified, convention or stored.identified.convention)
        beside = in_words(stored.frames, stored.identified)
        return Export(*link_table(arm, beside)) if table else Export(dump_robot(arm, _comment(stored)))
    if to == "json":
        return Export(json.dumps(_document(stored), indent=2, ensure_ascii=False, allow_nan=False) + "\n")
    if to == "pal":
        return Export(_pal(stored))
    if to == "ur-kinematics" and stored.origins and not is_universal(stored.nominal):
        return _own_blocks(stored)
    nominal = in_convention(stored.nominal, "standard-dh")
    chain = universal_chain(nominal, in_convention(stored.identified, "standard-dh", like=nominal))
    if to == "ur-calibration-conf":
        return Export(calibration_conf(chain, _comment(stored)))
    blocks, notes = universal_blocks(chain)
    return Export(kinematics_yaml(blocks, _comment(stored), notes), notes)


def _comment(stored: StoredResult) -> str:
    verdict = "accepted" if stored.accepted else "REJECTED: do not use it for work"
    first = f"{stored.name}, calibrated by Boresight ({verdict})"
    return "\n".join([first, *in_words(stored.frames, stored.identified)])


def _new_urdf(stored: StoredResult) -> str:
    arm = well_conditioned(in_convention(stored.identified, "standard-dh"))
    return dump_urdf(
        chain_of(arm), f"{_comment(stored)}\nLinks have no shape and no mass; limits no effort, no velocity."
    )


def _pal(stored: StoredResult) -> str:
    if not stored.origins:
        raise InputError(
            f"{stored.folder}: this format holds changes of a URDF's origins, and the arm came as a table; "
            "calibrate with robot: {urdf: ...}, or export to urdf"
        )
    lines = [
        *(f"# {line}" for line in comment_lines(_comment(stored))),
        "# Added to the origins of the URDF that was calibrated: metres, and radians of roll, pitch and yaw.",
        "robot_state_publisher:",
        "  geometric_calibration:",
    ]
    for joint in stored.origins:
        was, now = ([*joint[key]["xyz"], *joint[key]["rpy"]] for key in ("nominal", "identified"))
        if joint["type"] != "fixed" or was != now:
            keys = (yaml_key(f"{joint['joint']}_{part}") for part in _DELTAS)
            changes = (float(b) - float(a) + 0.0 for a, b in zip(was, now, strict=True))
            lines += [f"    {key}: {change!r}" for key, change in zip(keys, changes, strict=True)]
    return "\n".join(lines) + "\n"


def _own_blocks(stored: StoredResult) -> Export:
    """Returns the block with the URDF's own joints and origins, as other makers' descriptions read it."""
    moving = (joint for joint in stored.origins if joint["type"] != "fixed")
    new = {
        joint["joint"]: Frame(tuple(joint["identified"]["xyz"]), tuple(joint["identified"]["rpy"])) for joint in moving
    }
    notes = tuple(
        f"The fixed joint {joint['joint']} is new too, and not in this format: xyz {joint['identified']['xyz']} (m), "
        f"rpy {joint['identified']['rpy']} (rad)."
        for joint in stored.origins
        if joint["type"] == "fixed" and joint["nominal"] != joint["identified"]
    )
    return Export(kinematics_yaml(new, _comment(stored), notes), notes)


def _document(stored: StoredResult) -> dict[str, Any]:
    return {
        "schema": ARM_SCHEMA,
        "name": stored.name,
        "accepted": stored.accepted,
        "units": {"length": "m", "angle": "rad"},
        "nominal": _forms(stored.nominal.rigid),
        "identified": _forms(stored.identified.rigid),
        "beyond_geometry": _bends(stored.identified),
        "urdf_origins": list(stored.origins) or None,
        "frames": {
            frame.name: {
                "stated": None if frame.stated is None else _frame(frame.stated),
                "identified": _frame(frame.identified),
            }
            for frame in stored.frames
        },
    }


def _bends(arm: Arm) -> dict[str, Any] | None:
    """Returns what turns the joints beside their readings [rad]; None where nothing does."""
    if not arm.is_bent:
        return None
    joints = {
        joint.name: {
            **{wave: float(height) for wave, height in zip(HARMONICS, joint.harmonics, strict=False)},
            **{f"{SAG}{link}": float(turn) for link, turn in joint.sag},
        }
        for joint in arm.joints
    }
    return {"gravity": list(map(float, arm.gravity)), "joints": joints}


def _forms(arm: Arm) -> dict[str, Any]:
    """Returns an arm in both D-H conventions and as a product of exponentials."""
    screws = screws_of(arm)
    own = {convention: _links(in_convention(arm, convention)) for convention in get_args(Convention)}
    return {**own, "product_of_exponentials": _exponentials(screws)}


def _links(arm: Arm) -> dict[str, Any]:
    return {
        "root": _frame(arm.root),
        "joints": [
            {"name": j.name, "type": j.type, **j.numbers}
            | ({"follows": j.follows, "ratio": j.ratio} if j.follows else {})
            for j in arm.joints
        ],
        "tip": _frame(arm.tip),
    }


def _exponentials(screws: Screws) -> dict[str, Any]:
    return {
        "joints": [
            {"name": joint.name, "v": joint.twist[:3].tolist(), "w": joint.twist[3:].tolist()}
            | ({"follows": joint.follows, "ratio": joint.ratio} if joint.follows else {})
            for joint in screws.joints
        ],
        "home": screws.home.tolist(),
    }


def _frame(frame: Frame) -> dict[str, list[float]]:
    return {"xyz": [float(value) for value in frame.xyz], "rpy": [float(value) for value in frame.rpy]}
