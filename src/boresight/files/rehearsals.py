"""A simulated campaign on disk: a folder that `boresight calibrate` takes, and the truth beside it."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

from ruamel.yaml import YAML

from boresight.calibration.campaign import Campaign
from boresight.calibration.simulate import Rehearsal
from boresight.errors import OutputError
from boresight.files.robots import dump_robot
from boresight.files.writing import write_atomically
from boresight.sensing import Cell, Readings
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
        taken = any(folder.iterdir())
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror or error}") from error
    if taken:
        raise OutputError(f"{folder}: is not empty; nothing is overwritten: name a new folder with -o")
    text, units = _campaign_text(source)
    write_atomically(folder / "robot.yaml", dump_robot(campaign.cell.arm, "the nominal robot of a simulated campaign"))
    write_atomically(folder / "observations.csv", _readings_csv(campaign.cell, rehearsal.readings, units))
    write_atomically(folder / "validation.csv", _readings_csv(campaign.cell, rehearsal.validation, units))
    write_atomically(folder / "truth.json", _truth_json(rehearsal))
    write_atomically(folder / "campaign.yaml", text)
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
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    named = cell.sensor.needs_target
    writer.writerow([*cell.arm.joint_names, *cell.sensor.channels, *(["target"] if named else [])])
    per_joint = [units.radians if joint.type == "revolute" else units.metres for joint in cell.arm.driven]
    names = list(cell.targets)
    for joints, values, target in zip(readings.joints, readings.values, readings.target, strict=True):
        numbers = [f"{value:.12g}" for value in (*(joints / per_joint), *(values / units.metres))]
        writer.writerow([*numbers, *([names[target]] if named else [])])
    return text.getvalue()


def _truth_json(rehearsal: Rehearsal) -> str:
    poses = rehearsal.truth.poses(rehearsal.validation.joints)
    truth = {
        "units": {"length": "m", "angle": "rad"},
        "parameters": rehearsal.truth.values,
        "validation_position": poses[:, :3, 3].tolist(),
        "validation_rotation": poses[:, :3, :3].tolist(),
    }
    return json.dumps(truth, indent=1) + "\n"
