"""`boresight import`."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.markup import escape

from boresight.arm import Joint
from boresight.cli.consoles import PipedConsole, print_plain
from boresight.errors import InputError, OutputError
from boresight.files.bag_observations import remarks_of
from boresight.files.bags import is_bag
from boresight.files.chosen_robots import robot_of_campaign
from boresight.files.dialects import described, in_house_words
from boresight.files.joint_logs import paired
from boresight.files.observations import LIMIT_MIB
from boresight.files.recorded import Recorded, began, read_recorded, rows_csv, sliding_joints
from boresight.files.robots import is_urdf, load_robot
from boresight.files.sheets import csv_text, sheet_of
from boresight.files.sources import read_source
from boresight.files.topics import Choice
from boresight.files.urdf import moving_joints
from boresight.files.writing import write_atomically
from boresight.units import Units, in_millimetres


def run_import(
    path: Path,
    output: Path | None,
    choice: Choice,
    *,
    arm: ArmOf,
    joint_file: Path | None,
    marker: int | None,
    overwrite: bool,
    as_json: bool,
) -> int:
    """Returns the exit code of an import, its observations written and what was found shown."""
    _check(choice)
    target = output or Path("observations.csv")
    if target.exists() and not overwrite:
        raise OutputError(f"{target}: is there already; name another file with -o, or say --overwrite")
    if target.exists() and path.exists() and target.samefile(path):
        raise OutputError(f"{target}: is the file to import itself; name another file with -o")
    if is_bag(path) or path.name == "metadata.yaml":
        summary, text = _bag(path, choice, arm)
    else:
        summary, text = _table(path, arm, joint_file, marker)
    write_atomically(target, text)
    summary["output"] = str(target)
    if as_json:
        print_plain(json.dumps(summary, indent=2, default=float) + "\n")
    else:
        _show(PipedConsole(), summary)
    return 0


def _check(choice: Choice) -> None:
    rules = choice.rules
    problems = [
        f"{option}: expected {expected}, got {given:g}"
        for option, given, expected, good in (
            ("--time-offset", choice.time_offset, "seconds", abs(choice.time_offset) <= 1e9),
            ("--still-speed", rules.still_speed, "a speed above 0", 0.0 < rules.still_speed <= 1e3),
            ("--still-time", rules.still_time, "seconds above 0", 0.0 < rules.still_time <= 1e6),
            ("--settle", rules.settle, "seconds, 0 or more", 0.0 <= rules.settle <= 1e6),
        )
        if not good
    ]
    if problems:
        raise InputError(problems)


@dataclass(frozen=True, slots=True)
class ArmOf:
    """Where the names of the arm's joints are.

    Attributes:
        robot: a robot.yaml or URDF, or None.
        base, tip: links of a URDF, or None.
        campaign: a campaign whose robot it is, or None.
    """

    robot: Path | None = None
    base: str | None = None
    tip: str | None = None
    campaign: Path | None = None

    def joints(self) -> tuple[tuple[Joint, ...], bool]:
        """Returns the arm's joints, none where nothing names them, and whether all of them must be in the source.

        Of a URDF with several last links, which no option tells apart, any that moves will do.

        Raises:
            InputError: a file cannot be read, or options exclude each other.
        """
        if self.campaign is not None:
            if self.robot is not None or self.base is not None or self.tip is not None:
                raise InputError("--campaign names the robot; leave out --robot, --base and --tip")
            return robot_of_campaign(self.campaign).driven, True
        if self.robot is None:
            if self.base is not None or self.tip is not None:
                raise InputError("--base and --tip are links of a URDF; name it: --robot arm.urdf")
            return (), True
        if not is_urdf(str(self.robot)) or self.base is not None or self.tip is not None:
            return load_robot(self.robot, self.base, self.tip).driven, True
        try:
            return load_robot(self.robot).driven, True
        except InputError:
            return moving_joints(self.robot), False  # which says it where the file cannot be read at all


def _bag(path: Path, choice: Choice, arm: ArmOf) -> tuple[dict[str, object], str]:
    joints, every = arm.joints()
    names = [joint.name for joint in joints] or None
    recorded = read_recorded(path, str(path), choice, names, all_joints=every, sliding=sliding_joints(joints))
    return _summary(recorded), rows_csv(recorded)


def _summary(recorded: Recorded) -> dict[str, object]:
    """Returns what was found in a bag, as plain values."""
    rows = recorded.rows
    std = rows.std[:, recorded.lengths]
    return {
        "source": recorded.bag.name,
        "rows": len(rows),
        "joints": recorded.joint_names,
        "began": began(recorded.start),
        "topics": {t.name: {"type": t.type, "messages": t.count} for t in recorded.bag.topics.values()},
        "used": recorded.used,
        "messages": recorded.counts,
        "set_aside": recorded.empty,
        "outlying": rows.outlying,
        "phases": len(rows) + len(rows.skipped),
        "without_a_row": [{"from": s.start, "to": s.end, "reason": s.reason} for s in rows.skipped],
        "repeats": {"median": float(np.median(rows.repeats)), "min": int(rows.repeats.min())},
        "scatter_m": rows.scatter[recorded.lengths].tolist(),
        "std_m": {"median": float(np.median(std)), "max": float(std.max())},
        **({} if recorded.angle_scatter is None else {"scatter_rad": recorded.angle_scatter}),
        "notes": list(remarks_of(recorded)),
        "warnings": list(recorded.bag.losses),
    }


def _table(path: Path, arm: ArmOf, joint_file: Path | None, marker: int | None) -> tuple[dict[str, object], str]:
    name, mend = str(path), "thin it or split it"
    joints, every = arm.joints()
    names = [joint.name for joint in joints]
    source = read_source(path, name, kind="a CSV file or a ROS bag", limit_mib=LIMIT_MIB, mend=mend)
    ours, translation = in_house_words(sheet_of(source), joints, Units(), marker)
    if translation is None:
        raise InputError(
            f"{name}: the columns are neither FIGAROH's (x1, y1, z1, joints) nor Leica's (X [mm], Y [mm], Z [mm]), and "
            "this is no ROS bag; a file with the columns of docs/files.md needs no import"
        )
    notes, warnings = [described(translation)], []
    if joint_file is not None:
        log = read_source(
            joint_file, str(joint_file), kind="a CSV file of joint readings", limit_mib=LIMIT_MIB, mend=mend
        )
        pairs = paired(ours, sheet_of(log), names if every else None, sliding_joints(joints))
        ours = pairs.sheet
        notes.append(f"Joints and measurements were paired {'by time' if pairs.by_time else 'row by row'}.")
        lines = ", ".join(map(str, pairs.left_out[:6])) + (" and others" if len(pairs.left_out) > 6 else "")
        if pairs.left_out:
            warnings.append(f"{name}: {len(pairs.left_out)} rows are at times without joints (lines {lines})")
    elif translation.dialect == "Leica" and not (names and set(names) <= set(translation.header)):
        raise InputError(
            f"{name}: a tracker's export has no joints; name their file: --joint-file joints.csv, a column a joint, "
            "and a row for each of its rows or a column time"
        )
    rows = list(ours.rows)
    summary: dict[str, object] = {"source": name, "dialect": translation.dialect, "rows": len(rows) - 1}
    return summary | {"notes": notes, "warnings": warnings}, csv_text(rows)


def _show(console: Console, summary: dict) -> None:
    """Prints what was found."""
    rows = summary["rows"]
    said = [f"[bold]{rows}[/] row{'s' if rows != 1 else ''} out of {escape(summary['source'])}."]
    if "used" in summary:
        counts = summary["messages"]
        used = ", ".join(f"{key} {topic}" for key, topic in summary["used"].items())
        scatter, std = max(summary["scatter_m"]), summary["std_m"]["median"]
        said += [
            f"  {counts['joint_states']} joint states, {counts['readings']} readings: {escape(used)}.",
            f"  One reading scatters by {in_millimetres(scatter)}; a row is known to {in_millimetres(std)} (median).",
        ]
    said += [f"  {escape(note)}" for note in summary["notes"]]
    said += [f"[yellow]Warning:[/] {escape(warning)}" for warning in summary["warnings"]]
    for line in (*said, f"Files: {escape(summary['output'])}"):
        console.print(line, soft_wrap=True, highlight=False)
