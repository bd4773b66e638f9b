"""A result folder read again: the arm as it was believed to be, and as it was identified."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from boresight.arm import LINK_NUMBERS, Arm, Joint
from boresight.errors import InputError, did_you_mean
from boresight.files.problems import shown
from boresight.files.robots import load_robot
from boresight.files.sources import read_source

RESULT_FILE, ROBOT_FILE = "result.json", "robot-calibrated.yaml"
LIMIT_MIB = 64


@dataclass(frozen=True)
class StoredResult:
    """What a result folder says about the arm.

    Attributes:
        name: the campaign's.
        accepted: the verdict.
        nominal: the arm before.
        calibrated: the arm as identified.
    """

    name: str
    accepted: bool
    nominal: Arm
    calibrated: Arm


def load_result(folder: Path | str) -> StoredResult:
    """Returns the arms of a result folder, or of the result.json in it.

    Raises:
        InputError: it is no result of a calibration, or its files do not belong together.
    """
    folder = Path(folder)
    folder = folder.parent if folder.name == RESULT_FILE else folder
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: this is a file; expected the folder of a result, such as NAME-result")
    if not (folder / RESULT_FILE).is_file():
        raise InputError(
            f"{folder}: there is no {RESULT_FILE} in it{_nearest(folder)}; expected a calibration's result"
        )
    source = read_source(folder / RESULT_FILE, str(folder / RESULT_FILE), kind="a result", limit_mib=LIMIT_MIB, mend="")
    try:
        document = json.loads(source.content)
        name, accepted = str(document["name"]), bool(document["verdict"]["accepted"])
        nominal = {one["name"]: _number(one["nominal"]) for one in document["parameters"]}
    except (ValueError, KeyError, TypeError, RecursionError):
        raise InputError(f"{source.name}: this is not a result of a calibration; run the calibration again") from None
    calibrated = load_robot(folder / ROBOT_FILE)
    return StoredResult(name, accepted, _nominal_arm(calibrated, nominal, source.name), calibrated)


def _nominal_arm(calibrated: Arm, nominal: dict[str, float], name: str) -> Arm:
    """Returns the calibrated arm with the nominal numbers in its links."""
    wanted = {f"{joint.name}.{number}" for joint in calibrated.joints for number in LINK_NUMBERS}
    missing = sorted(wanted - nominal.keys())
    if missing:
        raise InputError(f"{name}: there is no nominal {shown(missing[0])}; {ROBOT_FILE} beside it is of another arm")
    joints = (_replaced(joint, nominal) for joint in calibrated.joints)
    return replace(calibrated, joints=tuple(joints))


def _replaced(joint: Joint, nominal: dict[str, float]) -> Joint:
    numbers: dict[str, Any] = {number: nominal[f"{joint.name}.{number}"] for number in LINK_NUMBERS}
    return replace(joint, **numbers)


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError(value)
    return float(value)


def _nearest(folder: Path) -> str:
    if not folder.parent.is_dir():
        return ""
    return did_you_mean(folder.name, (path.parent.name for path in folder.parent.glob(f"*/{RESULT_FILE}")))
