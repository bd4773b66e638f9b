"""A case as files, as a user would write them: robot.yaml, campaign.yaml, observations.csv, validation.csv."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from benchmarks.trust.case import Case
from benchmarks.trust.faults.fault import Rows
from benchmarks.trust.kinematics import roll_pitch_yaw

WITHIN_ANGLE, WITHIN_LENGTH = 0.02, 0.02
"""How far a campaign that says what to estimate lets link parameters and plates be from nominal [rad, m]."""


def write_campaign(case: Case, folder: Path) -> Path:
    """Returns campaign.yaml, written with the files that it names."""
    (folder / "robot.yaml").write_text(_robot(case))
    _write_rows(case, case.observations, folder / "observations.csv")
    if case.validation is not None:
        _write_rows(case, case.validation, folder / "validation.csv")
    path = folder / "campaign.yaml"
    path.write_text(_campaign(case))
    return path


def _robot(case: Case) -> str:
    arm = case.stated.arm
    lines = ["name: arm", "units: {length: m, angle: rad}", "convention: standard-dh", "joints:"]
    for k, kind in enumerate(arm.types):
        numbers = ", ".join(f"{n}: {getattr(arm, n)[k]:.15g}" for n in ("theta", "d", "a", "alpha", "beta"))
        kind = "revolute" if kind == "r" else "prismatic"
        lines.append(f"  - {{name: j{k + 1}, type: {kind}, {numbers}, limits: {_numbers(arm.limits[k])}}}")
    return "\n".join(lines) + "\n"


def _campaign(case: Case) -> str:
    scenario, cell = case.scenario, case.stated
    std, repeats = scenario.noise
    noise = f"noise_std: {scenario.stated * std:.6g}, repeats: {repeats}"
    lines = ["robot: robot.yaml", "units: {length: m, angle: rad}", f"sensor: {{type: {scenario.sensor}, {noise}}}"]
    for name, T in (("base", cell.base), ("mount", cell.mount)):
        if name in scenario.unknown:
            turn = "unknown" if scenario.sensor == "laser_ranger" or name == "base" else "[0, 0, 0]"
            lines.append(f"{name}: {{xyz: unknown, rpy: {turn}}}")
        elif not np.array_equal(T, np.eye(4)):
            lines.append(f"{name}: {{xyz: {_numbers(T[:3, 3])}, rpy: {_numbers(roll_pitch_yaw(T))}}}")
    if cell.planes:
        lines.append("targets:")
        for name, plane in cell.planes.items():
            lines.append(f"  {name}: {{type: plane, normal: {_numbers(plane.normal)}, offset: {plane.offset:.12g}}}")
    lines.append("observations: observations.csv")
    if case.validation is not None:
        lines.append("validation: validation.csv")
    fixed = list(scenario.exact)
    if scenario.estimated:
        lines += _estimate(case)
        fixed += [f"j{k + 1}.d" for k in np.flatnonzero(cell.arm.parallel)]
    if fixed:
        lines.append(f"fixed: [{', '.join(dict.fromkeys(fixed))}]")
    return "\n".join(lines) + "\n"


def _estimate(case: Case) -> Iterable[str]:
    arm, size = case.stated.arm, case.scenario.size
    turns = ["*.theta", "*.alpha", *(f"j{k + 1}.beta" for k in np.flatnonzero(arm.parallel))]
    tilts = [f"{name}.normal_{axis}" for name, plane in case.stated.planes.items() for axis in _free_axes(plane.normal)]
    yield "estimate:"
    for names, within in (
        (turns, WITHIN_ANGLE),
        (["*.d", "*.a", "*.offset"], WITHIN_LENGTH * size),
        (tilts, WITHIN_ANGLE),
    ):
        quoted = ", ".join(f'"{name}"' for name in names)
        yield f"  - {{parameters: [{quoted}], within: {within:g}}}"


def _free_axes(normal: np.ndarray) -> str:
    """Returns the two components that docs/files.md says are free: y follows unless it is small."""
    if abs(normal[1]) > 0.2:
        return "xz"
    return "yz" if abs(normal[0]) > abs(normal[2]) else "xy"


def _write_rows(case: Case, rows: Rows, path: Path) -> None:
    names = list(case.stated.planes)
    read = ("range", "target") if names else ("x", "y", "z")
    lines = [",".join((*(f"j{k + 1}" for k in range(case.stated.arm.count)), *read))]
    for joints, values, target in zip(rows.joints, rows.values, rows.target, strict=True):
        cells = [f"{value:.10g}" for value in (*joints, *values)]
        lines.append(",".join(cells + ([names[target]] if names else [])))
    path.write_text("\n".join(lines) + "\n")


def _numbers(values: Iterable[float]) -> str:
    return f"[{', '.join(f'{value:.12g}' for value in values)}]"
