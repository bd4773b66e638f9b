"""A result read back from its folder, as far as exporting its arm needs it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from boresight.arm import HARMONICS, LINK_NUMBERS, SAG, Arm, Joint
from boresight.errors import InputError, did_you_mean
from boresight.files import load_robot
from boresight.files.problems import printable
from boresight.files.sources import read_source
from boresight.report.folder import RESULT_FILE, ROBOT_FILE, URDF_FILE, digest_of
from boresight.report.frames_beside import EstimatedFrame, estimated_frames
from boresight.report.stored_document import checked_document

LIMIT_MIB = 64


@dataclass(frozen=True)
class StoredResult:
    """What a result folder says of its arm.

    Attributes:
        folder: where it lies.
        name: of the campaign.
        accepted: the verdict.
        reasons: why, a sentence each.
        nominal: the arm before calibration.
        identified: the arm after it.
        urdf: the bytes of the calibrated URDF, or None where the arm came as a table.
        origins: of the URDF's joints, each with `joint`, `type`, `nominal` and `identified`; empty without a URDF.
        frames: those that were estimated beside the arm.
    """

    folder: Path
    name: str
    accepted: bool
    reasons: tuple[str, ...]
    nominal: Arm
    identified: Arm
    urdf: bytes | None
    origins: tuple[Mapping[str, Any], ...]
    frames: tuple[EstimatedFrame, ...] = ()


def load_result(folder: Path) -> StoredResult:
    """Returns what a folder that `write_result` wrote says of its arm.

    Raises:
        InputError: it is not such a folder, or its files do not belong together.
    """
    if folder.name == RESULT_FILE:
        folder = folder.parent
    if not (folder / RESULT_FILE).is_file():
        wanted = "the folder that boresight calibrate wrote"
        raise InputError(printable(f"{folder}: holds no {RESULT_FILE}{_near(folder)}; expected {wanted}"))
    document = _document(folder)
    _check_files(folder, document)
    identified = load_robot(folder / "robot-calibrated.yaml")
    described = document.get("urdf")
    try:
        verdict = document["verdict"]
        numbers = {parameter["name"]: parameter["nominal"] for parameter in document["parameters"]}
        return StoredResult(
            folder=folder,
            name=str(document["name"]),
            accepted=verdict["accepted"] is True,
            reasons=tuple(map(str, verdict["reasons"])),
            nominal=_with_numbers(identified, numbers),
            identified=identified,
            urdf=None if described is None else _bytes(folder / "robot-calibrated.urdf"),
            origins=() if described is None else tuple(described["origins"]),
            frames=estimated_frames(document),
        )
    except (KeyError, TypeError) as error:  # of a parameter that is not there, or has no nominal value
        said = (
            f"{folder / RESULT_FILE}: it does not belong to robot-calibrated.yaml beside it ({error}); calibrate again"
        )
        raise InputError(printable(said)) from None


def _near(folder: Path) -> str:
    """The result beside it that may have been meant."""
    if not folder.parent.is_dir():
        return ""
    return did_you_mean(folder.name, (path.parent.name for path in folder.parent.glob(f"*/{RESULT_FILE}")))


def _document(folder: Path) -> dict[str, Any]:
    source = read_source(
        folder / RESULT_FILE, str(folder / RESULT_FILE), kind="a result", limit_mib=LIMIT_MIB, mend="is it one?"
    )
    return checked_document(source)


def _check_files(folder: Path, document: Mapping[str, Any]) -> None:
    """Raises an `InputError` where a file that describes the arm is not the one that the result was written with."""
    digests = document.get("files")
    if not isinstance(digests, dict):
        return  # of an earlier version
    for name in (ROBOT_FILE, URDF_FILE):
        path = folder / name
        if name in digests and path.is_file() and digest_of(path.read_bytes()) != digests[name]:
            raise InputError(
                printable(
                    f"{path}: does not belong to {RESULT_FILE} beside it: a run was killed between the two, or the "
                    "file was edited; calibrate again"
                )
            )


def _with_numbers(arm: Arm, numbers: Mapping[str, float]) -> Arm:
    return replace(arm, joints=tuple(_joint_with_numbers(joint, numbers) for joint in arm.joints))


def _joint_with_numbers(joint: Joint, numbers: Mapping[str, float]) -> Joint:
    """Returns a joint with other numbers; what turns it beside its reading is not there unless they name it."""
    waves = tuple(float(numbers.get(f"{joint.name}.{wave}") or 0.0) for wave in HARMONICS)
    sag = ((link, float(numbers.get(f"{joint.name}.{SAG}{link}") or 0.0)) for link, _ in joint.sag)
    return replace(
        joint.with_numbers({number: float(numbers[f"{joint.name}.{number}"]) for number in LINK_NUMBERS}),
        harmonics=waves if any(waves) else (),
        sag=tuple((link, turn) for link, turn in sag if turn),
    )


def _bytes(path: Path) -> bytes:
    return read_source(path, str(path), kind="a URDF file", limit_mib=LIMIT_MIB, mend="is it one?").content
