"""A result's row-by-row and generation-by-generation numbers as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from jaxtyping import Float

from boresight.calibration.result import Result
from boresight.files.names import csv_word
from boresight.sensing import Cell, Readings, Sensor

_BLOCK = 16_384


def residuals_csv(result: Result) -> str:
    """Returns `residuals.csv`: for each calibration row the errors [m or rad], measured minus predicted.

    A column a channel of any sensor, empty where a row's sensor has no such channel.
    """
    cell, readings = result.cell, result.readings
    units = {name: unit for sensor in cell.sensors.values() for name, unit in _channel_units(sensor).items()}
    flagged = [outlier.line for outlier in result.outliers]
    columns: dict[str, np.ndarray] = {
        "line": readings.line,
        "target": _of_aims([aim.target or "" for aim in cell.aims], readings),
    }
    if len(cell.sensors) > 1:
        columns["sensor"] = _of_aims([aim.sensor for aim in cell.aims], readings)
    if len(cell.mounts) > 1:
        columns["marker"] = _of_aims([aim.mount for aim in cell.aims], readings)
    if readings.session is not None:
        columns["session"] = np.array([csv_word(str(name)) for name in readings.session], dtype=object)
    for when in ("before", "after"):
        for channel, unit in units.items():
            columns[f"{when}_{channel}_{unit}"] = _errors_of_channel(channel, cell, readings, result.errors[when])
    columns["outlier"] = np.isin(readings.line, flagged).astype(int)
    return _csv(tuple(columns), _rows_of(tuple(columns.values())))


def _of_aims(words: Sequence[str], readings: Readings) -> np.ndarray:
    """Returns each row's word, given a word an aim."""
    return np.array(list(map(csv_word, words)), dtype=object)[readings.target]


def _errors_of_channel(
    channel: str, cell: Cell, readings: Readings, errors: Float[np.ndarray, "rows channels"]
) -> Float[np.ndarray, " rows"]:
    """Returns the errors of a channel [m or rad], measured minus predicted; NaN where a row's sensor has none."""
    sensor_of_aim = np.array([list(cell.sensors).index(aim.sensor) for aim in cell.aims])
    own, found = sensor_of_aim[readings.target], np.full(len(readings), np.nan)
    for place, sensor in enumerate(cell.sensors.values()):
        if channel in sensor.channels:
            k, rows = sensor.channels.index(channel), own == place
            found[rows] = -errors[rows, k] / (sensor.levers[k] or 1.0)
    return found


def _channel_units(sensor: Sensor) -> dict[str, str]:
    """Returns the unit of each channel as it is told to people: m, or rad where it is an angle on a lever."""
    units = ("m" if lever is None else "rad" for lever in sensor.levers)
    return dict(zip(sensor.channels, units, strict=True))


def convergence_csv(result: Result) -> str:
    """Returns `convergence.csv`: best and mean cost [mm²] after every generation, the first population's in row 0."""
    history = np.asarray(result.solution.history) * 1e6
    return _csv(["generation", "best_cost_mm2", "mean_cost_mm2"], _rows_of((np.arange(len(history)), *history.T)))


def pose_uncertainty_csv(result: Result) -> str:
    """Returns `pose-uncertainty.csv`: how certain the calibrated tool's pose is over the work space.

    The absolute accuracy first, then the relative one, after the best rigid motion; a radius that the readings do not
    determine is written as inf.
    """
    found, relative = result.accuracy.absolute.pose, result.accuracy.relative
    header = ["position_std_m", "position_95_m", "orientation_std_rad", "orientation_95_rad"]
    header += ["relative_position_95_m", "relative_orientation_95_rad"]
    sizes = (
        found.position_std,
        found.position_95,
        found.orientation_std,
        found.orientation_95,
        relative.pose.position_95,
        relative.pose.orientation_95,
    )
    return _csv(
        [*map(csv_word, result.cell.arm.joint_names), *header], _rows_of((*found.joints.T, *map(_written, sizes)))
    )


def _written(radius: Float[np.ndarray, "rows"]) -> np.ndarray:
    """Returns radii as they are written, with a word where there is none."""
    return radius if np.isfinite(radius).all() else np.array(["inf"] * len(radius), dtype=object)


def _csv(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()


def _rows_of(columns: Sequence[np.ndarray]) -> Iterator[tuple[object, ...]]:
    """Yields the rows of columns of equal length.

    Column after column, as a million rows one by one take ten times as long, and block after block, as a million
    strings a column take gigabytes.
    """
    for first in range(0, len(columns[0]), _BLOCK):
        yield from zip(*(_cells(column[first : first + _BLOCK]) for column in columns), strict=True)


def _cells(values: np.ndarray) -> list[object]:
    """Returns values as they are written: floating-point numbers with nine digits, nothing where one is none."""
    if values.dtype != np.float64:
        return values.tolist()
    finite = np.isfinite(values).tolist()
    return [f"{value:.9g}" if good else "" for value, good in zip(values.tolist(), finite, strict=True)]
