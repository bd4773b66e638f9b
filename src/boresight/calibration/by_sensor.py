"""Errors sensor by sensor, lengths apart from angles, in the units that people read them in."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Bool, Float

from boresight.calibration.holdout import summary_of
from boresight.calibration.result import SensorErrors
from boresight.sensing import Cell, Readings

_WHAT = {
    "laser_ranger": "range",
    "draw_wire": "length",
    "position": "position",
    "pose": "position",
    "plane_contact": "contact",
    "point_contact": "contact",
    "distances": "distance",
}


def errors_by_sensor(
    cell: Cell,
    readings: Readings,
    kept: Bool[np.ndarray, "rows"],
    errors: Mapping[str, Float[np.ndarray, "rows channels"]],
) -> tuple[SensorErrors, ...]:
    """Returns the errors of the rows that were used.

    Args:
        cell: whose sensors they are.
        readings: all rows.
        kept: which were used.
        errors: `before` and `after`, predicted minus measured [m].
    """
    own = np.array([aim.sensor for aim in cell.aims])[readings.target]
    told = []
    for name, sensor in cell.sensors.items():
        rows = np.flatnonzero((own == name) & kept)
        for angle in (False, True):
            channels = [k for k, lever in enumerate(sensor.levers) if (lever is not None) == angle]
            if not channels or not len(rows):
                continue
            scale = (sensor.levers[channels[0]] or 1.0) if angle else 1.0
            sizes = {when: np.linalg.norm(errors[when][rows][:, channels], axis=1) / scale for when in errors}
            both = np.isfinite(sizes["before"]) & np.isfinite(sizes["after"])
            std = float(np.median(readings.std[rows][:, channels])) / scale
            told.append(
                SensorErrors(
                    name,
                    "orientation" if angle else _WHAT.get(sensor.type, sensor.type),
                    "rad" if angle else "m",
                    len(rows),
                    std,
                    summary_of(sizes["before"][both]),
                    summary_of(sizes["after"][both]),
                )
            )
    return tuple(told)
