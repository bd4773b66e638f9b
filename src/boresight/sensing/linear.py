"""What a cell's sensors read, and the derivatives by some parameters: `Cell.linearise`, compiled where it can be.

Rows are asked for in blocks, so that a million of them and their derivatives are never there at once.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from boresight.geometry import Plane
from boresight.kernels.linearising import Columns, Point, linearise_rows, predict_rows
from boresight.kernels.programs import FIXED, OFFSET
from boresight.search import Triangle, reduced
from boresight.sensing.cell import Cell
from boresight.sensing.compiled import carried_planes, compile_program, compile_rows
from boresight.sensing.readings import Readings

BLOCK = 2048
"""Values that are linearised at once: with 25 derivatives each they stay in the second-level cache. Linearising and
reducing a million of them (`boresight.search.triangles`) took longer with blocks of 512 and of 8,192."""

_ROWS = 8192
"""Rows that go through NumPy at once: enough that its calls cost little, 100 MB at most."""


class Block(NamedTuple):
    """Some rows, linearised, all of it times the values' weights.

    Attributes:
        rows: which.
        columns: (free + 1, values) derivatives by each free parameter, then errors, predicted minus measured [m];
            row by row and channel by channel. It may be written over once the next block is asked for.
    """

    rows: slice
    columns: Float[np.ndarray, "columns values"]


@runtime_checkable
class Model(Protocol):
    """A cell at some configurations, as a function of corrections of its free parameters."""

    def errors(self, x: Float[np.ndarray, "free"]) -> Float[np.ndarray, "rows channels"]:
        """Returns predicted minus measured values [m]; NaN where a beam misses."""
        ...

    def blocks(
        self, x: Float[np.ndarray, "free"], weight: Float[np.ndarray, "rows channels"], missed: float
    ) -> Iterator[Block]:
        """Yields all rows, linearised, in their order.

        Args:
            x: where.
            weight: of each value.
            missed: the error [m] of a beam that misses; its derivatives are 0.
        """
        ...


class CompiledModel:
    """The model of a cell that the compiled loops linearise.

    The NumPy model (`Cell.errors`, `Cell.slopes`) stays the reference that tests hold it to; 100 ranges and 25
    parameters take it 3 ms, this 0.05.
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
        self._columns = _columns(cell, readings)

    def errors(self, x: Float[np.ndarray, "free"]) -> Float[np.ndarray, "rows channels"]:
        """Returns predicted minus measured values [m]; NaN where a beam misses."""
        predicted, hit = np.empty(self._values.size), np.empty(self._values.size, dtype=np.bool_)
        predict_rows(self._program, self._at(x), self._columns, predicted, hit)
        predicted[~hit] = np.nan
        return predicted.reshape(self._values.shape) - self._values

    def blocks(
        self, x: Float[np.ndarray, "free"], weight: Float[np.ndarray, "rows channels"], missed: float
    ) -> Iterator[Block]:
        """Yields all rows, linearised; see `Model`."""
        point, flat, (rows, channels) = self._at(x), np.ascontiguousarray(weight).ravel(), self._values.shape
        step = max(BLOCK // channels, 1)
        columns = np.empty((self._free + 1, min(step, rows) * channels))
        for start in range(0, rows, step):
            stop = min(start + step, rows)
            own = flat[start * channels : stop * channels]
            columns = columns if len(own) == columns.shape[1] else np.empty((self._free + 1, len(own)))
            linearise_rows(self._program, point, self._columns, start * channels, own, missed, columns)
            yield Block(slice(start, stop), columns)

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
        self._places = [cell.index[name] for name in free]

    def errors(self, x: Float[np.ndarray, "free"]) -> Float[np.ndarray, "rows channels"]:
        """Returns predicted minus measured values [m]; NaN where a beam misses."""
        errors, corrections = np.empty(self._readings.values.shape), self._corrections(x)
        for rows in _slices(len(errors)):
            errors[rows] = self._cell.errors(self._readings.chosen(rows), corrections)
        return errors

    def blocks(
        self, x: Float[np.ndarray, "free"], weight: Float[np.ndarray, "rows channels"], missed: float
    ) -> Iterator[Block]:
        """Yields all rows, linearised; see `Model`."""
        corrections = self._corrections(x)
        for rows in _slices(len(self._readings)):
            some = self._readings.chosen(rows)
            predicted, slopes = self._cell.linearise(some.joints, some.target, corrections, some.reference, some.since)
            slopes = slopes[:, :, self._places]
            slopes[np.isnan(predicted) | np.isnan(slopes).any(axis=2)] = 0.0
            errors = np.nan_to_num(predicted - some.values, nan=missed)
            columns = np.concatenate([np.moveaxis(slopes, 2, 0), errors[None]]) * weight[rows]
            yield Block(rows, columns.reshape(len(columns), -1))

    def _corrections(self, x: Float[np.ndarray, "free"]) -> Float[np.ndarray, "all"]:
        full = np.zeros(len(self._cell.parameters))
        full[self._places] = x
        return full


def model_of(cell: Cell, readings: Readings, free: Sequence[str]) -> CompiledModel | ReferenceModel:
    """Returns the fastest model of a cell's readings."""
    compiled = is_compiled(cell) and not _scaled_trackers(cell) & {*free, *_wrong_scales(cell)}
    return (CompiledModel if compiled else ReferenceModel)(cell, readings, free)


def slopes_of(
    model: Model, x: Float[np.ndarray, "free"], readings: Readings
) -> Float[np.ndarray, "rows channels free"]:
    """Returns the exact derivative of a model's errors for all of its rows; zeros where a beam misses."""
    shape = readings.values.shape
    parts = [block.columns[:-1].T.copy() for block in model.blocks(x, np.ones(shape), 0.0)]
    return np.concatenate(parts).reshape(*shape, len(x))


def triangle_of(model: Model, x: Float[np.ndarray, "free"], weight: Float[np.ndarray, "rows channels"]) -> Triangle:
    """Returns all that least squares needs of a model's rows, each value times its weight; misses count for nothing."""
    return reduced((block.columns for block in model.blocks(x, weight, 0.0)), len(x))


def seen_by(cell: Cell, readings: Readings, free: Sequence[str]) -> Float[np.ndarray, "free free"]:
    """Returns the triangular factor of what readings see of parameters, nominally and over their stated noise.

    R'R is the derivatives' own square, so columns' lengths and angles, ranks and combinations are theirs.
    """
    return triangle_of(model_of(cell, readings, free), np.zeros(len(free)), 1.0 / readings.std).slopes


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


def _scaled_trackers(cell: Cell) -> set[str]:
    """Returns the scales of sensors that read offsets, which compiled loops take to be right."""
    return {
        f"{name}.scale"
        for name, sensor in cell.sensors.items()
        if "scale" in sensor.numbers and any(readout.kind == OFFSET for readout in sensor.readouts)
    }


def _wrong_scales(cell: Cell) -> set[str]:
    """Returns the scales that are not what they should be."""
    return {f"{name}.scale" for name, sensor in cell.sensors.items() if getattr(sensor, "scale", 0.0)}


def _columns(cell: Cell, readings: Readings) -> Columns:
    """Returns the readings as the compiled loops take them, made block by block: what they are made of is large."""
    joints, values = len([m for m in cell.chain.motions if m.joint is not None]), readings.values.size
    channels = readings.values.shape[1]
    columns = Columns(
        first=np.empty((joints, values)),
        second=np.empty((joints, values)),
        plane=np.empty(values, dtype=np.int32),
        sensor=np.empty(values, dtype=np.int32),
        readout=np.empty(values, dtype=np.int8),
        reading=np.empty(values),
    )
    for rows in _slices(len(readings)):
        some = readings.chosen(rows)
        own, at = (
            compile_rows(cell, some, np.ones(some.values.shape)),
            slice(rows.start * channels, rows.stop * channels),
        )
        columns.first[:, at], columns.second[:, at] = own.first.T, own.second.T
        for name in ("plane", "sensor", "readout", "reading"):
            getattr(columns, name)[at] = getattr(own, name)
    np.nan_to_num(columns.reading, copy=False)  # of configurations alone: compiled code knows no NaN
    return columns


def _slices(rows: int) -> Iterator[slice]:
    """Yields the rows in stretches, one even of none."""
    for start in range(0, max(rows, 1), _ROWS):
        yield slice(start, min(start + _ROWS, rows))
