"""Base and mount found from ranges alone, in random cells.

Each cell has an arm of 4 to 7 axes drawn at random, three plates on random sides of it, a base anywhere within 3 m in
any orientation and a ranger on the flange in any orientation. Ranges are computed by kinematics that the package does
not share, on an arm whose every independent number is wrong (normal, 10 mm and 10 mrad), with noise of 0.2 mm, and 5 %
of the rows are 20 to 400 mm wrong. The package is given the nominal arm, the plates and the rows. Arms that are not
what they seem are drawn anew: two joints in a row about one axis, all axes parallel, or all through one point.

*Found*: at 300 configurations that were not measured, the nominal arm where it was placed puts the tool no farther
from the truth, RMS, than `NEAR` times where least squares from the true base and mount puts it (SciPy, robust loss,
the benchmark's own kinematics), in position and in the beam's direction. *Refused*: the package said that it cannot
tell. *Wrong*: all else.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cache, partial

import numpy as np

from benchmarks.parallel import on_all_cores
from benchmarks.report import Figure, Report, Table, percent
from benchmarks.trust.cell import Cell as TrueCell
from benchmarks.trust.cell import Plane as TruePlane
from benchmarks.trust.cell import ranges
from benchmarks.trust.configurations import Beams, anywhere, measured
from benchmarks.trust.kinematics import Arm as TrueArm
from benchmarks.trust.kinematics import frame
from benchmarks.trust.truth import Errors, true_arm
from boresight.arm import Arm, Joint
from boresight.calibration.placement import find_frames
from boresight.errors import InputError
from boresight.geometry import Frame, Plane
from boresight.sensing import Cell, LaserRanger, Readings

NOISE_M = 0.2e-3
ERRORS = Errors(angle=10e-3, length=10e-3)
GROSS = 0.05
NEAR = 5.0
CHECKED = 300
BEAMS = Beams(farthest=3.0, cosine=(0.3, 1.01))
UNKNOWN = frozenset(f"{frame}.{n}" for frame in ("base", "mount") for n in ("x", "y", "z", "roll", "pitch", "yaw"))


@dataclass(frozen=True)
class Outcome:
    """What became of one cell.

    Attributes:
        axes: how many the arm has.
        rows: how many readings.
        found: `found`, `refused` or `wrong`.
        seconds: of processor time that the search took, on one core.
        ratio: the larger of position's and direction's error over those of the fit from the truth.
    """

    axes: int
    rows: int
    found: str
    seconds: float
    ratio: float


def random_arm(axes: int, random: np.random.Generator) -> TrueArm:
    """Returns an arm of random links, axes parallel, square or askew, one in eight joints prismatic."""
    while True:
        slides = random.random(axes) < 0.125
        slides[[0, -1]] = False
        alpha = random.choice([0.0, 0.5 * np.pi, -0.5 * np.pi, np.nan], axes, p=[0.25, 0.325, 0.325, 0.1])
        alpha = np.where(np.isnan(alpha), random.uniform(-2.0, 2.0, axes), alpha)
        theta = np.where(random.random(axes) < 0.5, 0.0, random.uniform(-np.pi, np.pi, axes))
        d = np.where(random.random(axes) < 0.6, random.uniform(0.05, 0.4, axes), 0.0)
        a = np.where(random.random(axes) < 0.6, random.uniform(0.05, 0.5, axes), 0.0)
        inner = slice(0, -1)
        one_axis = (alpha[inner] == 0.0) & (a[inner] == 0.0)
        at_one_point = not (a[inner].any() or d[1:-1].any())
        if one_axis.any() or at_one_point or not alpha[inner].any():
            continue
        limits = np.where(slides[:, None], [0.0, 0.4], np.deg2rad([-150.0, 150.0]))
        types = "".join("p" if slide else "r" for slide in slides)
        return TrueArm(types, theta, d, a, alpha, np.zeros(axes), limits)


def random_cell(seed: int, rows: int) -> tuple[TrueArm, TrueCell, np.ndarray, np.ndarray]:
    """Returns a nominal arm, the true cell, and configurations that meet its plates, with the plate of each."""
    random = np.random.default_rng([2026, seed + 1])
    while True:
        axes = int(random.integers(4, 8))
        nominal = random_arm(axes, random)
        arm = true_arm(nominal, ERRORS, 1.0, (), random)
        base, mount = _any_pose(3.0, random), _any_pose(0.15, random)
        normals = _any_turns(3, random)[:, 0]
        if abs(np.linalg.det(normals)) < 0.35:
            continue
        offsets = random.uniform(0.5, 1.5, 3) - normals @ base[:3, 3]
        planes = {f"plate_{k + 1}": TruePlane(normals[k], float(offsets[k])) for k in range(3)}
        cell = TrueCell(arm, base, mount, planes)
        try:
            return nominal, cell, *measured((cell,), rows, BEAMS, random)
        except RuntimeError:
            continue


def measured_cell(seed: int, rows: int) -> tuple[TrueArm, TrueCell, Readings, np.random.Generator]:
    """Returns a nominal arm, the true cell, its readings, and a generator for what comes after."""
    nominal, cell, joints, target = random_cell(seed, rows)
    random = np.random.default_rng([2027, seed + 1])
    values = ranges(cell, joints, target)[0] + random.normal(0.0, NOISE_M, rows)
    gross = random.choice(rows, round(GROSS * rows), replace=False)
    amount = random.uniform(0.02, 0.4, len(gross)) * random.choice([-1.0, 1.0], len(gross))
    values[gross] = np.abs(values[gross] + amount)
    std = np.full((rows, 1), NOISE_M)
    return nominal, cell, Readings(joints, values[:, None], std, target, np.arange(rows) + 2), random


def outcome(seed: int, rows: int) -> Outcome:
    """Returns what became of one cell."""
    load_kernels()
    nominal, cell, readings, random = measured_cell(seed, rows)
    start = time.process_time()
    try:
        found = find_frames(package_cell(nominal, cell), readings, UNKNOWN, seed).cell
    except InputError:
        return Outcome(nominal.count, rows, "refused", time.process_time() - start, np.inf)
    seconds = time.process_time() - start
    checked = anywhere(cell, CHECKED, random)
    own = _errors(cell, fitted_from_truth(nominal, cell, readings), checked)
    placed = _errors(cell, TrueCell(nominal, found.base.matrix, found.mounts["mount"].matrix), checked)
    ratio = float(np.max(placed / own))
    return Outcome(nominal.count, rows, "found" if ratio < NEAR else "wrong", seconds, ratio)


@cache
def load_kernels() -> None:
    """Finds two placements, so that loading compiled loops and libraries is in nobody's time."""
    for rows in (45, 100):
        nominal, cell, readings, _ = measured_cell(-1, rows)
        find_frames(package_cell(nominal, cell), readings, UNKNOWN, 0)


def fitted_from_truth(nominal: TrueArm, cell: TrueCell, readings: Readings) -> TrueCell:
    """Returns the nominal arm with base and mount where a robust fit of the ranges leads from where they truly are."""
    from scipy.optimize import least_squares

    def placed(x: np.ndarray) -> TrueCell:
        base, mount = cell.base.copy(), cell.mount.copy()
        for T, step in ((base, x[:6]), (mount, x[6:])):
            T[:3, 3] += step[:3]
            T[:3, :3] = T[:3, :3] @ frame(rpy=tuple(step[3:]))[:3, :3]
        return TrueCell(nominal, base, mount, cell.planes)

    def left(x: np.ndarray) -> np.ndarray:
        return np.concatenate(
            [ranges(placed(x), readings.joints, readings.target)[0] - readings.values[:, 0], 1e-6 * x]
        )

    return placed(least_squares(left, np.zeros(12), loss="soft_l1", f_scale=0.02).x)


def package_cell(arm: TrueArm, cell: TrueCell) -> Cell:
    """Returns the nominal cell as the package has it, base and mount at neutral values."""
    joints = tuple(
        Joint(f"j{k + 1}", "revolute" if kind == "r" else "prismatic", *map(float, numbers))
        for k, (kind, *numbers) in enumerate(zip(arm.types, arm.theta, arm.d, arm.a, arm.alpha, strict=True))
    )
    planes = {name: Plane.of(tuple(plane.normal), plane.offset) for name, plane in cell.planes.items()}
    return Cell(Arm("random", joints), LaserRanger(NOISE_M), Frame(), Frame(), planes)


def _errors(truth: TrueCell, other: TrueCell, joints: np.ndarray) -> np.ndarray:
    """Returns RMS errors of the tool's position [m] and of its beam's direction [rad]."""
    (place, turn), (other_place, other_turn) = truth.poses(joints), other.poses(joints)
    away = np.linalg.norm(place - other_place, axis=1)
    cosine = np.einsum("ri,ri->r", turn[:, :, 2], other_turn[:, :, 2])
    return np.sqrt([np.mean(away**2), np.mean(np.arccos(np.clip(cosine, -1.0, 1.0)) ** 2)])


def _any_turns(count: int, random: np.random.Generator) -> np.ndarray:
    q, r = np.linalg.qr(random.normal(size=(count, 3, 3)))
    q *= np.sign(np.einsum("nii->ni", r))[:, None, :]
    q[:, :, 0] *= np.linalg.det(q)[:, None]
    return q


def _any_pose(reach: float, random: np.random.Generator) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = _any_turns(1, random)[0], random.uniform(-reach, reach, 3)
    return T


def run(quick: bool) -> Report:
    count = 30 if quick else 500
    outcomes = [each for rows in (45, 100) for each in on_all_cores(partial(outcome, rows=rows), range(count))]
    table = []
    for rows in (45, 100):
        for axes in range(4, 8):
            of = [each for each in outcomes if (each.rows, each.axes) == (rows, axes)]
            counted = [str(sum(each.found == word for each in of)) for word in ("found", "refused", "wrong")]
            seconds = [each.seconds for each in of]
            table.append(
                (str(rows), str(axes), str(len(of)), *counted, f"{np.median(seconds):.2f} s", f"{max(seconds):.2f} s")
            )
    found, wrong = (sum(each.found == word for each in outcomes) for word in ("found", "wrong"))
    slowest = max(each.seconds for each in outcomes)
    return Report(
        "placements",
        f"{len(outcomes)} random cells, base and mount unknown; see the module's docstring.",
        (
            Figure("found", f"{found} of {len(outcomes)}", "999 of 1,000", found >= 0.999 * len(outcomes)),
            Figure("wrong without a word", str(wrong), "0", wrong == 0),
            Figure("slowest search, processor time", f"{slowest:.2f} s", "<= 2 s", slowest <= 2.0),
        ),
        (
            Table(
                "By rows and axes",
                ("rows", "axes", "cells", "found", "refused", "wrong", "median time", "longest"),
                tuple(table),
            ),
        ),
        (f"{percent(found / len(outcomes))} found.",),
    )
