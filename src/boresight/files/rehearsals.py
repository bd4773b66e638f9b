"""A simulated campaign on disk: a folder that `boresight calibrate` takes, and the truth beside it."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np
from ruamel.yaml import YAML

from boresight.calibration.campaign import Campaign
from boresight.calibration.simulate import Rehearsal
from boresight.errors import OutputError
from boresight.files.columns import QUATERNION
from boresight.files.folders import staged, swap_in
from boresight.files.robots import dump_robot
from boresight.files.writing import PREFIX
from boresight.geometry import matrix_quaternion
from boresight.sensing import Aim, Cell, Distances, Pose, Readings
from boresight.units import Units


def write_rehearsal(campaign: Campaign, rehearsal: Rehearsal, source: Path, folder: Path) -> Path:
    """Returns the campaign file of a new folder: nominal robot, readings, validation rows and the truth.

    The campaign file is the one rehearsed, comments and all, pointing at the new files; its own units hold.

    Args:
        campaign: what was rehearsed.
        rehearsal: its readings and truth.
        source: the campaign file it was read from.
        folder: where to write; must not exist, or be empty.

    Raises:
        OutputError: the folder holds something, or cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        taken = any(not each.name.startswith(PREFIX) for each in folder.iterdir())  # what a killed run left is removed
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror or error}") from error
    if taken:
        raise OutputError(f"{folder}: is not empty; nothing is overwritten: name a new folder with -o")
    text, units = _campaign_text(source)
    contents = {
        "robot.yaml": dump_robot(campaign.cell.arm, "the nominal robot of a simulated campaign"),
        "observations.csv": _readings_csv(rehearsal.truth, rehearsal.readings, units),
        "validation.csv": _readings_csv(rehearsal.truth, rehearsal.validation, units),
        "truth.json": _truth_json(rehearsal),
        "campaign.yaml": text,
    }
    try:
        with staged(folder) as staging:
            for name, content in contents.items():
                (staging / name).write_text(content, encoding="utf-8", newline="\n")
            swap_in(staging, folder, contents)
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror or error}") from error
    return folder / "campaign.yaml"


def _campaign_text(source: Path) -> tuple[str, Units]:
    """Returns the campaign's own text pointing at the new files, and its units; it has been validated before."""
    yaml = YAML()
    data = yaml.load(source.read_text(encoding="utf-8"))
    data["robot"], data["observations"], data["validation"] = "robot.yaml", "observations.csv", "validation.csv"
    text = io.StringIO()
    yaml.dump(data, text)
    return text.getvalue(), Units(**dict(data.get("units", {})))


def _readings_csv(cell: Cell, readings: Readings, units: Units) -> str:
    """Returns an observations file.

    Args:
        cell: the true cell; of a distance between two configurations the positions at both ends are written, the
            second as it is and the first on the line between them.
        readings: what its sensors reported.
        units: of the file.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    columns = tuple(dict.fromkeys(column for sensor in cell.sensors.values() for column in sensor.columns))
    writer.writerow([*cell.arm.joint_names, *columns, *_key_columns(cell)])
    per_joint = [units.radians if joint.type == "revolute" else units.metres for joint in cell.arm.driven]
    others = []

    def write(joints: np.ndarray, aim: Aim, written: dict[str, float]) -> None:
        numbers = [f"{value:.12g}" for value in joints / per_joint]
        values = [f"{written[column]:.12g}" if column in written else "" for column in columns]
        writer.writerow([*numbers, *values, *(getattr(aim, field) or "" for field in _key_columns(cell).values())])

    for row, (joints, place) in enumerate(zip(readings.joints, readings.target, strict=True)):
        aim = cell.aims[place]
        sensor, read = cell.sensors[aim.sensor], readings.values[row]
        if isinstance(sensor, Distances) and readings.since is not None:
            here, there = cell.poses(np.stack([joints, readings.since[row]]), None, np.repeat(place, 2))[:, :3, 3]
            others.append((readings.since[row], aim, dict(zip("xyz", there / units.metres, strict=True))))
            read = there + read[0] * (here - there) / np.linalg.norm(here - there)
        written = dict(zip(sensor.columns, read / units.metres, strict=False))
        if isinstance(sensor, Pose) and readings.reference is not None:
            written |= dict(zip(QUATERNION, matrix_quaternion(readings.reference[row]), strict=True))
        write(joints, aim, written)
    for other in others:  # after all first ends, so that reading pairs them again
        write(*other)
    return text.getvalue()


def _key_columns(cell: Cell) -> dict[str, str]:
    """Returns the columns of names that a file needs, and the part of an aim that each holds."""
    wanted = {
        "sensor": ("sensor", len(cell.sensors) > 1),
        "marker": ("mount", len(cell.mounts) > 1),
        "target": ("target", any(aim.target is not None for aim in cell.aims)),
        "session": ("session", any(aim.session is not None for aim in cell.aims)),
    }
    return {column: field for column, (field, needed) in wanted.items() if needed}


def _truth_json(rehearsal: Rehearsal) -> str:
    poses = rehearsal.truth.poses(rehearsal.validation.joints)
    truth = {
        "units": {"length": "m", "angle": "rad"},
        "parameters": rehearsal.truth.values,
        "validation_position": poses[:, :3, 3].tolist(),
        "validation_rotation": poses[:, :3, :3].tolist(),
    }
    return json.dumps(truth, indent=1) + "\n"
