"""The result folder: every file whole or not at all, and an accepted result never overwritten by a rejected one."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

from boresight.calibration.result import Result
from boresight.errors import OutputError
from boresight.files import dump_robot
from boresight.files.folders import check_folder, staged, swap_in
from boresight.files.splicing import calibrated_urdf
from boresight.report.document import SCHEMA, result_json
from boresight.report.page import render_page
from boresight.report.tables import convergence_csv, pose_uncertainty_csv, residuals_csv

RESULT_FILE = "result.json"
ROBOT_FILE = "robot-calibrated.yaml"
PAGE_FILE = "report.html"
URDF_FILE = "robot-calibrated.urdf"
_OURS = (
    ROBOT_FILE,
    URDF_FILE,
    "residuals.csv",
    "convergence.csv",
    "pose-uncertainty.csv",
    PAGE_FILE,
    RESULT_FILE,
)


def write_result(result: Result, folder: Path, version: str) -> Path:
    """Returns the folder a result was written to: the one asked for, or one beside it for a rejected result.

    Files are written to a temporary folder and renamed, `result.json` last, which names the others by their SHA-256:
    where a killed run left some of two results, `load_result` refuses them.

    Args:
        result: the result.
        folder: where to write; created if need be.
        version: of the software that made it.

    Raises:
        OutputError: the folder cannot be written, or holds files of the same names that are not a result.
    """
    chosen = folder
    if not result.verdict.accepted and _holds_accepted(folder):
        beside = folder.resolve() if folder.name in ("", "..") else folder  # `-o .` has no name of its own
        chosen = beside.with_name(f"{beside.name}-rejected")
    check_writable(chosen)
    contents: dict[str, str | bytes] = {
        ROBOT_FILE: dump_robot(result.cell.arm, _robot_comment(result)),
        **_urdf(result),
        "residuals.csv": residuals_csv(result),
        "convergence.csv": convergence_csv(result),
        "pose-uncertainty.csv": pose_uncertainty_csv(result),
        PAGE_FILE: render_page(result, version),
    }
    digests = {name: digest_of(each) for name, each in contents.items() if name != PAGE_FILE}  # which tells the time
    contents[RESULT_FILE] = result_json(result, version, digests)
    try:
        chosen.mkdir(parents=True, exist_ok=True)
        with staged(chosen) as staging:
            for name, content in contents.items():
                if isinstance(content, bytes):
                    (staging / name).write_bytes(content)
                else:
                    (staging / name).write_text(content, encoding="utf-8", newline="\n")
            # an earlier result's URDF is not this arm
            swap_in(staging, chosen, contents, gone=() if URDF_FILE in contents else (URDF_FILE,))
    except OSError as error:
        raise OutputError(f"{chosen}: cannot write the result: {error.strerror or error}") from error
    return chosen


def digest_of(content: str | bytes) -> str:
    """Returns the SHA-256 of a file's content."""
    return hashlib.sha256(content if isinstance(content, bytes) else content.encode("utf-8")).hexdigest()


def check_writable(folder: Path) -> None:
    """Checks that a result can be written to a folder, before anyone waits for it.

    Raises:
        OutputError: it cannot, or the folder holds files of the same names that are not a result.
    """
    check_folder(folder, "result", _OURS, lambda where: _schema(where) is not None, "Boresight result")


def _urdf(result: Result) -> dict[str, bytes]:
    if result.robot_file is None:
        return {}
    return {URDF_FILE: calibrated_urdf(result.robot_file, result.nominal.arm, result.cell.arm)}


def _holds_accepted(folder: Path) -> bool:
    try:
        return bool(json.loads((folder / RESULT_FILE).read_text(encoding="utf-8"))["verdict"]["accepted"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return False


def _schema(folder: Path) -> str | None:
    try:
        schema = json.loads((folder / RESULT_FILE).read_text(encoding="utf-8")).get("schema")
    except (OSError, ValueError, AttributeError, RecursionError):
        return None
    return schema if isinstance(schema, str) and schema.split("/")[0] == SCHEMA.split("/")[0] else None


def _robot_comment(result: Result) -> str:
    verdict = "accepted" if result.verdict.accepted else "REJECTED"
    return f"{result.name}, calibrated by Boresight ({verdict}); see result.json for uncertainty and frames"
