"""What a cell's sensors read, and the derivatives by some parameters: `Cell.linearise`, compiled where it can be."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from boresight.geometry import Plane
from boresight.kernels.linearising import Point, linearise_rows, predict_rows
from boresight.kernels.programs import FIXED, OFFSET
from boresight.sensing.cell import Cell
from boresight.sensing.compiled import carried_planes, compile_program, compile_rows
from boresight.sensing.readings import Readings


class CompiledModel:
    """A cell at some configurations, as a function of corrections of its free parameters.

    The NumPy model (`Cell.errors`, `Cell.slopes`) stays the reference that tests hold it to; 100 ranges and 25
    parameters take it 3 ms, this 0.1.
    """

    def __init__(self, cell: Cell, readings: Readings, free: Sequence[str]) -> None:
        """Args: cell is the nominal cell, readings its configurations and targets, free the names that may move."""
        self._values = readings.values
        self._free = len(free)
        self._planes = [(name, plane) for name, plane in carried_planes(cell) if isinstance(plane, Plane)]
        place = {name: column for column, name in enumerate(free)}
        self._plane_column = np.array(
            [[place.get(f"{name}.{number}", FIXED) for number, _ in plane.numbers] for name, plane in self._planes],
            dtype=np.int64,
        ).reshape(-1, 3)
        self._program = compile_program(cell, free, np.zeros(self._free))
        self._rows = compile_rows(cell, readings, np.ones(self._values.shape))

    def errors(self, x: Float[np.ndarray, "free"]) -> Float[np.ndarray, "rows channels"]:
        """Returns predicted minus measured values [m]; NaN where a beam misses."""
        predicted, hit = np.empty(len(self._rows.reading)), np.empty(len(self._rows.reading), dtype=np.bool_)
        predict_rows(self._program, self._at(x), self._rows, predicted, hit)
        predicted[~hit] = np.nan
        return predicted.reshape(self._values.shape) - self._values

    def slopes(self, x: Float[np.ndarray, "free"]) -> Float[np.ndarray, "rows channels free"]:
        """Returns the exact derivative of `errors`; zeros where a beam misses."""
        count = len(self._rows.reading)
        predicted, hit, slopes = np.empty(count), np.empty(count, dtype=np.bool_), np.empty((count, self._free))
        linearise_rows(self._program, self._at(x), self._rows, predicted, hit, slopes)
        return slopes.reshape(*self._values.shape, self._free)

    def _at(self, x: Float[np.ndarray, "free"]) -> Point:
        """Returns what does not depend on the row."""
        program = self._program
        padded = np.append(x, 0.0)  # FIXED is the last
        value = program.motion_value + padded[program.motion_parameter]
        moved = [
            plane.corrected(padded[columns].tolist()) if (columns != FIXED).any() else plane
            for (_, plane), columns in zip(self._planes, self._plane_column, strict=True)
        ]
        own = padded[program.sensor_parameter]
        return Point(
            value=value,
            sine=np.sin(value),
            cosine=np.cos(value),
            plane=np.array([[*plane.normal, plane.offset] for plane in moved]).reshape(-1, 4),
            by_plane=np.array([plane.derivative for plane in moved]).reshape(-1, 4, 3),
            plane_column=self._plane_column,
            bias=program.sensor_value[:, 0] + own[:, 0] + own[:, 2],
            gain=1.0 + program.sensor_value[:, 1] + own[:, 1],
        )


class ReferenceModel:
    """The same by NumPy, for cells that the compiled loops do not linearise."""

    def __init__(self, cell: Cell, readings: Readings, free: Sequence[str]) -> None:
        """Args: see `CompiledModel`."""
        self._cell, self._readings = cell, readings
        self._columns = [cell.index[name] for name in free]

    def errors(self, x: Float[np.ndarray, "free"]) -> Float[np.ndarray, "rows channels"]:
        """Returns predicted minus measured values [m]; NaN where a beam misses."""
        return self._cell.errors(self._readings, self._corrections(x))

    def slopes(self, x: Float[np.ndarray, "free"]) -> Float[np.ndarray, "rows channels free"]:
        """Returns the exact derivative of `errors`; zeros where a beam misses."""
        slopes = self._cell.slopes(self._readings, self._corrections(x))
        slopes[np.isnan(slopes).any(axis=2)] = 0.0
        return slopes[:, :, self._columns]

    def _corrections(self, x: Float[np.ndarray, "free"]) -> Float[np.ndarray, "all"]:
        full = np.zeros(len(self._cell.parameters))
        full[self._columns] = x
        return full


def model_of(cell: Cell, readings: Readings, free: Sequence[str]) -> CompiledModel | ReferenceModel:
    """Returns the fastest model of a cell's readings."""
    return (CompiledModel if is_compiled(cell) else ReferenceModel)(cell, readings, free)


def is_compiled(cell: Cell) -> bool:
    """Returns whether a cell is of the kind that the compiled loops linearise.

    One sensor on one mount, whose every channel is a plane's range or offset; an arm that does not bend.
    """
    if len(cell.sensors) > 1 or len(cell.mounts) > 1 or cell.arm.is_bent:
        return False
    sensor = next(iter(cell.sensors.values()))
    plain = [(readout.channel, readout.weight) for readout in sensor.readouts]
    return (
        all(readout.kind <= OFFSET for readout in sensor.readouts)
        and plain == [(channel, 1.0) for channel in range(len(sensor.channels))]
        and all(isinstance(target, Plane) for target in cell.targets.values())
    )
