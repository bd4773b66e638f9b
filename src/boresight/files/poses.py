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
from boresight.files.problems import Problems, listed, shown
from boresight.files.schemas import LARGEST
from boresight.files.sheets import sheet_of
from boresight.files.sources import Source, read_source
from boresight.geometry import quaternion_matrix
from boresight.units import Units

POSITION = ("x", "y", "z")
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
    """

    joints: Float[np.ndarray, "rows joints"] | None
    poses: Float[np.ndarray, "rows 4 4"] | None
    free: bool
    others: tuple[tuple[str, ...], ...]


def read_poses(path: Path | str, arm: Arm, units: Units) -> WantedPoses:
    """Returns the poses of a CSV file, in metres and radians.

    Args:
        path: of the file: a column a joint, or x, y, z with or without qw, qx, qy, qz, or both.
        arm: whose joints they are.
        units: the units it is written in.

    Raises:
        InputError: everything that is wrong with it.
    """
    source = read_source(Path(path), str(path), kind="a CSV file of poses", limit_mib=LIMIT_MIB, mend="split it")
    header, rows, lines = _cells(source)
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
    others = [place for place, name in enumerate(header) if name not in at]
    kept = (tuple(header[place] for place in others), *(tuple(row[place] for place in others) for row in rows))
    return WantedPoses(joints, poses, poses is not None and "qw" not in numbers, kept)


def _cells(source: Source) -> tuple[list[str], list[list[str]], list[int]]:
    """Returns the header, the rows and their lines; `#` begins a comment."""
    found = [(line, row) for line, row in sheet_of(source).rows if any(cell.strip() for cell in row)]
    if len(found) < 2:
        raise InputError(f"{source.name}: there are no poses in it; expected a row of column names and then poses")
    header = [name.strip() for name in found[0][1]]
    problems = Problems()
    for line, row in found[1:]:
        if len(row) != len(header):
            problems.add(f"{source.name}, line {line}: {len(row)} cells; expected {len(header)}, as in the header")
    problems.raise_if_any()
    return header, [row for _, row in found[1:]], [line for line, _ in found[1:]]


def _columns(header: list[str], arm: Arm, name: str, problems: Problems) -> dict[str, int]:
    """Returns the places of the columns that mean something; all joints or none, all of a pose or none."""
    at = {column: place for place, column in enumerate(header)}
    for column, count in Counter(header).items():
        if count > 1:
            problems.add(f"{name}: there are several columns {shown(column)}; expected one")
    known = (*arm.joint_names, *POSITION, *QUATERNION)
    for group in (arm.joint_names, POSITION, QUATERNION):
        given = [column for column in group if column in at]
        if given and len(given) < len(group):
            missing = [column for column in group if column not in at]
            near = did_you_mean(missing[0], [column for column in header if column not in known])
            problems.add(f"{name}: there is no column {listed(missing)}{near} beside {listed(given)}; expected all")
    if "qw" in at and "x" not in at:
        problems.add(f"{name}: there are orientations but no positions; expected x, y, z as well")
    if not any(column in at for column in known):
        problems.add(
            f"{name}: the columns are {listed(map(shown, header))}; expected the joints {listed(arm.joint_names)}, "
            f"or a pose {listed((*POSITION, *QUATERNION))}, or both"
        )
    return {column: at[column] for column in known if column in at}


def _numbers(
    rows: list[list[str]], lines: list[int], place: int, column: str, name: str, problems: Problems
) -> np.ndarray:
    try:
        numbers = np.array([row[place] for row in rows], dtype=np.float64)
        if np.all(np.abs(numbers) <= LARGEST):
            return numbers
    except ValueError:
        numbers = np.full(len(rows), np.nan)
    for row, line in zip(rows, lines, strict=True):
        try:
            good = abs(float(row[place])) <= LARGEST
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
