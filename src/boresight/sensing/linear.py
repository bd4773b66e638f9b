"""What a cell's sensor reads and its exact derivatives by some parameters, compiled: `Cell.linearise`, but fast."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from boresight.kernels.linearising import Point, linearise_rows, predict_rows
from boresight.kernels.programs import FIXED
from boresight.sensing.cell import Cell
from boresight.sensing.compiled import carried_planes, compile_program, compile_rows
from boresight.sensing.readings import Readings


class CompiledModel:
    """A cell at some configurations, as a function of corrections of its free parameters.

    The NumPy model (`Cell.predict`, `Cell.linearise`) stays the reference that tests hold it to; 100 ranges and 25
    parameters take it 3 ms, this 0.1.
    """

    def __init__(self, cell: Cell, readings: Readings, free: Sequence[str]) -> None:
        """Args: cell is the nominal cell, readings its configurations and targets, free the names that may move."""
        self._shape = readings.values.shape
        self._free = len(free)
        self._planes = carried_planes(cell)
        place = {name: column for column, name in enumerate(free)}
        self._plane_column = np.array(
            [[place.get(f"{name}.{n}", FIXED) for n in _plane_numbers(plane)] for name, plane in self._planes],
            dtype=np.int64,
        ).reshape(-1, 3)
        self._program = compile_program(cell, free, np.zeros(self._free))
        self._rows = compile_rows(cell, readings, np.ones(self._shape))

    def predict(self, x: Float[np.ndarray, "free"]) -> Float[np.ndarray, "rows channels"]:
        """Returns what the sensor would read [m]; NaN where a beam misses."""
        predicted, hit = np.empty(len(self._rows.reading)), np.empty(len(self._rows.reading), dtype=np.bool_)
        predict_rows(self._program, self._at(x), self._rows, predicted, hit)
        return self._shaped(predicted, hit)

    def linearise(
        self, x: Float[np.ndarray, "free"]
    ) -> tuple[Float[np.ndarray, "rows channels"], Float[np.ndarray, "rows channels free"]]:
        """Returns the same and its derivatives by the free parameters; zeros where a beam misses."""
        count = len(self._rows.reading)
        predicted, hit, slopes = np.empty(count), np.empty(count, dtype=np.bool_), np.empty((count, self._free))
        linearise_rows(self._program, self._at(x), self._rows, predicted, hit, slopes)
        return self._shaped(predicted, hit), slopes.reshape(*self._shape, self._free)

    def _shaped(self, predicted: np.ndarray, hit: np.ndarray) -> Float[np.ndarray, "rows channels"]:
        predicted[~hit] = np.nan
        return predicted.reshape(self._shape)

    def _at(self, x: Float[np.ndarray, "free"]) -> Point:
        """Returns what does not depend on the row."""
        program = self._program
        padded = np.append(x, 0.0)  # FIXED is the last
        value = program.motion_value + padded[program.motion_parameter]
        moved = [
            plane.moved((float(padded[c[0]]), float(padded[c[1]])), float(padded[c[2]]))
            if (c != FIXED).any()
            else plane
            for (_, plane), c in zip(self._planes, self._plane_column, strict=True)
        ]
        bias, scale = program.sensor_value + padded[program.sensor_parameter]
        return Point(
            value=value,
            sine=np.sin(value),
            cosine=np.cos(value),
            plane=np.array([[*plane.normal, plane.offset] for plane in moved]),
            by_plane=np.array([plane.derivative for plane in moved]),
            plane_column=self._plane_column,
            bias=float(bias),
            gain=1.0 + float(scale),
        )


def _plane_numbers(plane) -> tuple[str, str, str]:
    first, second = ("xyz"[axis] for axis in plane.free_components)
    return f"normal_{first}", f"normal_{second}", "offset"
