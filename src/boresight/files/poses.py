"""poses.csv: where the arm is asked to go, as joint readings, as poses of its flange, or both."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from boresight.arm import Arm
from boresight.errors import InputError, did_you_mean
from boresight.files.columns import QUATERNION
from boresight.files.headers import with_known_names
from boresight.files.numbers import number_of
from boresight.files.plausible_poses import check_joints, check_positions, check_turns
from boresight.files.problems import Problems, listed, printable, shown
from boresight.files.schemas import LARGEST
from boresight.files.sheets import Sheet, sheet_of
from boresight.files.sources import read_source
from boresight.geometry import quaternion_matrix, vector_rotation
from boresight.units import Quantity, Units

POSITION = ("x", "y", "z")

VECTOR = ("rx", "ry", "rz")
"""A rotation vector: the axis times the angle, as UR's controllers write orientations."""

OTHER_TURNS = (
    "roll",
    "pitch",
    "yaw",
    "phi",
    "theta",
    "psi",
    "alpha",
    "beta",
    "gamma",
    "a",
    "b",
    "c",
    "w",
    "p",
    "r",
    "rpy",
)
"""Columns, in any case, that controllers write orientations in by turns in an order of their own."""

LIMIT_MIB = 512

_NORM = 0.01
"""How far a quaternion's length may be from 1: beyond, it is something else."""


@dataclass(frozen=True)
class WantedPoses:
    """What a file asks for.

    Attributes:
        joints: (rows, joints) readings [rad or m], or None.
        poses: (rows, 4, 4) `T_base_flange`, or None; orientations are the identity where they are free.
        free: whether only positions are asked for.
        others: the header and the cells of columns that mean nothing here, to be handed on.
        notes: how the file was read, a sentence each.
    """

    joints: Float[np.ndarray, "rows joints"] | None
    poses: Float[np.ndarray, "rows 4 4"] | None
    free: bool
    others: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...] = ()


def read_poses(path: Path | str, arm: Arm, units: Units) -> WantedPoses:
    """Returns the poses of a CSV file, in metres and radians.

    Args:
        path: of the file: a column a joint, or x, y, z with or without qw, qx, qy, qz or a rotation vector rx, ry, rz,
            or joints and a pose.
        arm: whose joints they are.
        units: the units it is written in.

    Raises:
        InputError: everything that is wrong with it.
    """
    source = read_source(Path(path), str(path), kind="a CSV file of poses", limit_mib=LIMIT_MIB, mend="split it")
    sheet = with_known_names(sheet_of(source), _known(arm), arm.joint_names, units)
    header, rows, lines = _cells(sheet)
    problems = Problems()
    at = _columns(header, arm, source.name, problems)
    problems.raise_if_any()
    numbers = {name: _numbers(rows, lines, place, name, source.name, problems) for name, place in at.items()}
    problems.raise_if_any()
    joints = poses = None
    if arm.joint_names[0] in numbers:
        scales = [units.radians if joint.type == "revolute" else units.metres for joint in arm.driven]
        joints = np.stack([numbers[n] * scale for n, scale in zip(arm.joint_names, scales, strict=True)], axis=1)
    if "x" in numbers:
        poses = np.tile(np.eye(4), (len(rows), 1, 1))
        poses[:, :3, 3] = np.stack([numbers[axis] * units.metres for axis in POSITION], axis=1)
        if "qw" in numbers:
            poses[:, :3, :3] = _rotations(np.stack([numbers[q] for q in QUATERNION], axis=1), lines, source.name)
        if "rx" in numbers:
            turns = np.stack([numbers[part] * units.radians for part in VECTOR], axis=1)
            poses[:, :3, :3] = vector_rotation(turns)
            check_turns(turns, units, source.name, problems)
    if joints is not None:
        check_joints(joints, arm, units, source.name, problems)
    if poses is not None:
        check_positions(poses[:, :3, 3], arm, units, source.name, problems)
    problems.raise_if_any()
    others = [place for place, name in enumerate(header) if name not in at]
    kept = (tuple(header[place] for place in others), *(tuple(row[place] for place in others) for row in rows))
    free = poses is not None and not {"qw", "rx"} & set(numbers)
    return WantedPoses(joints, poses, free, kept, _notes(source.name, sheet, kept[0], free))


def _notes(name: str, sheet: Sheet, others: tuple[str, ...], free: bool) -> tuple[str, ...]:
    """Returns how the file was read, where that is not plain, and what was not read."""
    said = [*sheet.form]
    if free:
        said.append(f"{name}: there are positions and no orientations, which are left free.")
    if others:
        said.append(f"{name}: columns that mean nothing here are handed on as they are: {listed(others)}.")
    return tuple(printable(sentence) for sentence in said)


def _known(arm: Arm) -> dict[str, Quantity | None]:
    """Returns the names that columns may have, and what each measures."""
    joints: dict[str, Quantity | None]
    joints = {joint.name: "angle" if joint.type == "revolute" else "length" for joint in arm.driven}
    return {
        **dict.fromkeys(POSITION, "length"),
        **dict.fromkeys(VECTOR, "angle"),
        **dict.fromkeys(QUATERNION),
        **joints,
    }


def _cells(sheet: Sheet) -> tuple[list[str], list[list[str]], list[int]]:
    """Returns the header, the rows and their lines; `#` begins a comment."""
    found = [(line, row) for line, row in sheet.rows if any(cell.strip() for cell in row)]
    if len(found) < 2:
        raise InputError(f"{sheet.name}: there are no poses in it; expected a row of column names and then poses")
    header = [name.strip() for name in found[0][1]]
    problems = Problems()
    for line, row in found[1:]:
        if len(row) != len(header):
            problems.add(f"{sheet.name}, line {line}: {len(row)} cells; expected {len(header)}, as in the header")
    problems.raise_if_any()
    return header, [row for _, row in found[1:]], [line for line, _ in found[1:]]


def _columns(header: list[str], arm: Arm, name: str, problems: Problems) -> dict[str, int]:
    """Returns the places of the columns that mean something; all joints or none, all of a pose or none."""
    at = {column: place for place, column in enumerate(header)}
    for column, count in Counter(header).items():
        if count > 1:
            problems.add(f"{name}: there are several columns {shown(column)}; expected one")
    known = (*arm.joint_names, *POSITION, *QUATERNION, *VECTOR)
    for group in (arm.joint_names, POSITION, QUATERNION, VECTOR):
        given = [column for column in group if column in at]
        if given and len(given) < len(group):
            missing = [column for column in group if column not in at]
            near = did_you_mean(missing[0], [column for column in header if column not in known])
            problems.add(f"{name}: there is no column {listed(missing)}{near} beside {listed(given)}; expected all")
    if "qw" in at and "rx" in at:
        problems.add(f"{name}: there are columns {listed(QUATERNION)} and {listed(VECTOR)}; expected one or the other")
    turned = [column for column in header if column.casefold() in OTHER_TURNS and column not in known]
    if turned and not {"qw", "rx"} & set(at):
        problems.add(
            f"{name}: {listed(map(shown, turned))} looks like an orientation, by an order of turns that a file cannot "
            f"say; expected a quaternion {listed(QUATERNION)}, or a rotation vector {listed(VECTOR)}"
        )
    if {"qw", "rx"} & set(at) and "x" not in at:
        problems.add(f"{name}: there are orientations but no positions; expected x, y, z as well")
    if not any(column in at for column in known):
        problems.add(
            f"{name}: the columns are {listed(map(shown, header))}; expected the joints {listed(arm.joint_names)}, "
            f"or a pose {listed(POSITION)} with {listed(QUATERNION)} or {listed(VECTOR)}, or both"
        )
    return {column: at[column] for column in known if column in at}


def _numbers(
    rows: list[list[str]], lines: list[int], place: int, column: str, name: str, problems: Problems
) -> np.ndarray:
    cells = [row[place] for row in rows]
    try:
        numbers = np.array([number_of(cell) for cell in cells])
        if np.all(np.abs(numbers) <= LARGEST):
            return numbers
    except ValueError:
        numbers = np.full(len(rows), np.nan)
    for row, line in zip(rows, lines, strict=True):
        try:
            good = abs(number_of(row[place])) <= LARGEST
        except ValueError:
            good = False
        if not good:
            problems.add(f"{name}, line {line}: {column}: got {shown(row[place].strip())}; expected a finite number")
    return numbers


def _rotations(quaternions: np.ndarray, lines: list[int], name: str) -> Float[np.ndarray, "rows 3 3"]:
    """Returns the rotations of quaternions (w first) brought to length 1."""
    norm = np.linalg.norm(quaternions, axis=1)
    problems = Problems()
    for row in np.flatnonzero(np.abs(norm - 1.0) > _NORM):
        problems.add(f"{name}, line {lines[row]}: the quaternion's length is {norm[row]:.4g}; expected 1")
    problems.raise_if_any()
    return quaternion_matrix(quaternions)
