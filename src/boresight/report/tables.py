"""A result's row-by-row and generation-by-generation numbers as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence

import numpy as np

from boresight.calibration.result import Result
from boresight.sensing import Sensor


def residuals_csv(result: Result) -> str:
    """Returns `residuals.csv`: for each calibration row the errors [m or rad], measured minus predicted.

    A column a channel of any sensor, empty where a row's sensor has no such channel.
    """
    cell, readings = result.cell, result.readings
    units = {name: unit for sensor in cell.sensors.values() for name, unit in _channel_units(sensor).items()}
    named = {
        "sensor": len(cell.sensors) > 1,
        "marker": len(cell.mounts) > 1,
        "session": readings.session is not None,
    }
    extra = [name for name, wanted in named.items() if wanted]
    columns = [f"{when}_{name}_{unit}" for when in ("before", "after") for name, unit in units.items()]
    flagged = {outlier.line for outlier in result.outliers}

    def row(place: int) -> list[object]:
        aim, line = cell.aims[readings.target[place]], int(readings.line[place])
        sensor = cell.sensors[aim.sensor]
        keys = {"sensor": aim.sensor, "marker": aim.mount, "session": ""}
        if readings.session is not None:
            keys["session"] = readings.session[place]
        errors = []
        for when in ("before", "after"):
            own = {
                name: -error / (lever or 1.0)
                for name, lever, error in zip(sensor.channels, sensor.levers, result.errors[when][place], strict=False)
            }
            errors += [_digits(own[name]) if name in own else "" for name in units]
        return [line, aim.target or "", *(keys[name] for name in extra), *errors, int(line in flagged)]

    return _csv(["line", "target", *extra, *columns, "outlier"], map(row, range(len(readings))))


def _channel_units(sensor: Sensor) -> dict[str, str]:
    """Returns the unit of each channel as it is told to people: m, or rad where it is an angle on a lever."""
    units = ("m" if lever is None else "rad" for lever in sensor.levers)
    return dict(zip(sensor.channels, units, strict=True))


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
