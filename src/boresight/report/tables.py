"""A result's row-by-row and generation-by-generation numbers as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence

import numpy as np

from boresight.calibration.result import Result


def residuals_csv(result: Result) -> str:
    """Returns `residuals.csv`: for each calibration row the errors [m], measured minus predicted."""
    channels = result.cell.sensor.channels
    flagged = {outlier.line for outlier in result.outliers}
    header = ["line", "target", *(f"before_{c}_m" for c in channels), *(f"after_{c}_m" for c in channels), "outlier"]
    before, after = -result.errors["before"], -result.errors["after"]
    names = list(result.cell.targets) if result.cell.sensor.needs_target else [""]
    rows = (
        [int(line), names[place], *map(_digits, before[i]), *map(_digits, after[i]), int(int(line) in flagged)]
        for i, (line, place) in enumerate(zip(result.readings.line, result.readings.target, strict=True))
    )
    return _csv(header, rows)


def convergence_csv(result: Result) -> str:
    """Returns `convergence.csv`: best and mean cost [mm²] after every generation, the first population's in row 0."""
    history = np.asarray(result.solution.history) * 1e6
    rows = ([generation, *map(_digits, costs)] for generation, costs in enumerate(history))
    return _csv(["generation", "best_cost_mm2", "mean_cost_mm2"], rows)


def pose_uncertainty_csv(result: Result) -> str:
    """Returns `pose-uncertainty.csv`: how certain the calibrated tool's pose is over the work space."""
    found = result.in_workspace
    header = ["position_std_m", "position_95_m", "orientation_std_rad", "orientation_95_rad"]
    columns = (found.position_std, found.position_95, found.orientation_std, found.orientation_95)
    rows = (
        [*map(_digits, joints), *map(_digits, sizes)] for joints, *sizes in zip(found.joints, *columns, strict=True)
    )
    return _csv([*result.cell.arm.joint_names, *header], rows)


def _csv(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()


def _digits(value: float) -> str:
    return f"{value:.9g}" if np.isfinite(value) else ""
