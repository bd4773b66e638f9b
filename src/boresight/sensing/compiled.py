"""A cell and its readings written out as the flat arrays of the compiled loops.

What turns a joint beside its reading (`boresight.arm.bending`) enters as it nominally is, added to the readings: it
is small, linear, and left to least squares.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from boresight.arm import Chain, Motion
from boresight.geometry import Plane
from boresight.kernels.evolving import evolve_generations
from boresight.kernels.lanes import padded
from boresight.kernels.programs import (
    COMPONENT,
    FIXED,
    POINT,
    SHIFT,
    TURN,
    Program,
    Rows,
    aligned,
    in_precision,
    workspace,
)
from boresight.kernels.sweeping import sweep
from boresight.search import Box, DifferentialEvolution, Population, Staleness, Stops, Stretch, seed_population
from boresight.sensing.aims import Aim
from boresight.sensing.cell import Cell
from boresight.sensing.readings import Readings
from boresight.sensing.sensor import Target

_AXIS_PLANES = (Plane((1.0, 0.0, 0.0), 0.0), Plane((0.0, 1.0, 0.0), 0.0), Plane((0.0, 0.0, 1.0), 0.0))
"""Planes whose offsets, seen from the sensor, are its position, and whose normals its orientation."""


def compile_program(
    cell: Cell, free: Sequence[str], prior_weight: Float[np.ndarray, "free"], loss: float = 0.0
) -> Program:
    """Returns how corrections of the free parameters, in that order, become links, planes and points.

    Args:
        cell: the nominal cell.
        free: names of the parameters that move.
        prior_weight: weight in the cost of each squared correction.
        loss: squared residual [m²] beyond which the cost grows with the residual, not its square; 0 for never.
    """
    place = {name: row for row, name in enumerate(free)}
    (segments, prismatic), *others = (_segments(chain) for chain in cell.chains.values())
    segments += [last for (*_, last), _ in others]
    kept = [[m for m in segment if m.value != 0.0 or m.parameter in place] for segment in segments]
    motions = [motion for segment in kept for motion in segment]
    value = np.array([motion.value for motion in motions], dtype=float)
    planes, sensors = carried_planes(cell), _sensors(cell)
    return Program(
        segment_start=np.cumsum([0] + [len(segment) for segment in kept]),
        motion_kind=np.array([TURN if m.turns else SHIFT for m in motions], dtype=np.int64),
        motion_axis=np.array([m.axis for m in motions], dtype=np.int64),
        motion_value=value,
        motion_sine=np.sin(value),
        motion_cosine=np.cos(value),
        motion_parameter=np.array([place.get(m.parameter or "", FIXED) for m in motions], dtype=np.int64),
        prismatic=np.array(prismatic, dtype=np.bool_),
        plane=np.array([_plane_values(plane) for _, plane in planes]),
        plane_parameter=np.array([_plane_rows(name, plane, place) for name, plane in planes], dtype=np.int64),
        plane_dropped=np.array([plane.dropped if isinstance(plane, Plane) else POINT for _, plane in planes]),
        sensor_value=np.array([_sensor_values(cell, aim) for aim in sensors]),
        sensor_parameter=np.array([_sensor_rows(aim, place) for aim in sensors], dtype=np.int64),
        prior_weight=np.ascontiguousarray(prior_weight, dtype=float),
        loss=float(loss),
    )


def compile_rows(cell: Cell, readings: Readings, weight: Float[np.ndarray, "rows channels"]) -> Rows:
    """Returns the readings as the scalars that the loop reads, each with the weight of its squared residual."""
    angle = np.array([motion.turns for motion in cell.chain.motions if motion.joint is not None])
    order = [motion.joint for motion in cell.chain.motions if motion.joint is not None]
    ratio = [motion.ratio for motion in cell.chain.motions if motion.joint is not None]
    moved = readings.joints[:, order] * ratio + cell.chain.bends(readings.joints)
    first, second = np.where(angle, np.cos(moved), moved), np.where(angle, np.sin(moved), 0.0)
    parts = [_scalars(cell, readings, weight, place) for place in np.unique(readings.target).tolist() or [0]]
    rows = np.concatenate([part.rows for part in parts])
    by_row = np.argsort(rows, kind="stable")
    numbers = {name: np.concatenate([getattr(part, name) for part in parts])[by_row] for name in _Scalars._fields}
    rows = numbers.pop("rows")
    return Rows(first=np.ascontiguousarray(first[rows]), second=np.ascontiguousarray(second[rows]), **numbers)


class _Scalars(NamedTuple):
    """What `Rows` has, and the row of the readings each scalar is of."""

    rows: np.ndarray
    plane: np.ndarray
    mount: np.ndarray
    sensor: np.ndarray
    readout: np.ndarray
    reading: np.ndarray
    weight: np.ndarray


def _scalars(cell: Cell, readings: Readings, weight: Float[np.ndarray, "rows channels"], place: int) -> _Scalars:
    """Returns the scalars of the rows of one aim, row by row."""
    aim = cell.aims[place]
    rows, readouts = np.flatnonzero(readings.target == place), cell.sensors[aim.sensor].readouts
    targets = list(cell.targets)
    own = 0 if aim.target is None else targets.index(aim.target)
    reading, weights = np.empty((len(rows), len(readouts))), np.empty((len(rows), len(readouts)))
    for column, readout in enumerate(readouts):
        weights[:, column] = readout.weight * weight[rows, readout.channel]
        if readout.kind >= COMPONENT:
            assert readings.reference is not None
            assert readout.axis is not None
            reading[:, column] = readings.reference[rows, readout.axis, readout.kind - COMPONENT]
        else:
            reading[:, column] = readings.values[rows, readout.channel]
    count = reading.size
    return _Scalars(
        rows=np.repeat(rows, len(readouts)),
        plane=np.tile([own if r.axis is None else len(targets) + r.axis for r in readouts], len(rows)),
        mount=np.full(count, list(cell.mounts).index(aim.mount)),
        sensor=np.full(count, _sensor_keys(cell).index((aim.sensor, aim.session))),
        readout=np.tile([readout.kind for readout in readouts], len(rows)),
        reading=reading.ravel(),
        weight=weights.ravel(),
    )


def _segments(chain: Chain) -> tuple[list[list[Motion]], list[bool]]:
    """Splits a chain at its joints: each joint's own motion opens a segment."""
    segments: list[list[Motion]] = [[]]
    prismatic = []
    for motion in chain.motions:
        if motion.factor is not None:
            continue
        if motion.joint is not None:
            assert motion.axis == 2, "the compiled loop's joints move about or along z"
            segments.append([])
            prismatic.append(not motion.turns)
        segments[-1].append(motion)
    return segments, prismatic


def carried_planes(cell: Cell) -> list[tuple[str, Target]]:
    """Returns what is carried and its name: targets, and the world's x = 0, y = 0, z = 0 if some sensor needs them."""
    against = any(readout.axis is not None for sensor in cell.sensors.values() for readout in sensor.readouts)
    return [*cell.targets.items(), *((("", plane) for plane in _AXIS_PLANES) if against else ())]


def _plane_values(plane: Target) -> list[float]:
    return [*plane.normal, plane.offset] if isinstance(plane, Plane) else [*plane.xyz, 0.0]


def _plane_rows(name: str, plane: Target, place: dict[str, int]) -> list[int]:
    numbers = ("normal_x", "normal_y", "normal_z", "offset") if isinstance(plane, Plane) else ("x", "y", "z", "")
    return [place.get(f"{name}.{number}", FIXED) for number in numbers]


def _sensor_keys(cell: Cell) -> list[tuple[str, str | None]]:
    """Each sensor in each of its sessions."""
    return list(dict.fromkeys((aim.sensor, aim.session) for aim in cell.aims))


def _sensors(cell: Cell) -> list[Aim]:
    """An aim of each sensor in each of its sessions."""
    return [Aim(sensor, "", None, session) for sensor, session in _sensor_keys(cell)]


def _sensor_values(cell: Cell, aim: Aim) -> list[float]:
    sensor = cell.sensors[aim.sensor]
    return [getattr(sensor, "bias", 0.0) + cell.offsets.get(aim.offset, 0.0), getattr(sensor, "scale", 0.0)]


def _sensor_rows(aim: Aim, place: dict[str, int]) -> list[int]:
    return [place.get(name, FIXED) for name in (f"{aim.sensor}.bias", f"{aim.sensor}.scale", aim.offset)]


class CompiledCost:
    """The cost of corrections: weighted squared residuals plus weighted squared corrections.

    Callable on (members, parameters), and able to run whole generations (`boresight.search.evolve`). Members come and
    go in double precision, whatever costs are computed in.
    """

    def __init__(self, program: Program, rows: Rows) -> None:
        """Args: program and rows are in the precision to compute in."""
        self.program = program
        self.rows = rows
        self._real = program.plane.dtype.type
        self._work = workspace(program)

    def single(self) -> CompiledCost:
        """Returns the same in single precision, which is up to twice as fast and knows a range to a micrometre."""
        return CompiledCost(in_precision(self.program, np.float32), in_precision(self.rows, np.float32))

    def __call__(self, members: Float[np.ndarray, "members parameters"]) -> Float[np.ndarray, "members"]:
        """Returns the cost of every member."""
        lanes = np.zeros((max(members.shape[1], 1), padded(len(members), self._real)), dtype=self._real)
        lanes[: members.shape[1], : len(members)] = members.T
        costs = np.empty(lanes.shape[1])
        sweep(self.program, self.rows, self._work, lanes, costs)
        return costs[: len(members)]

    def load(self, settings: DifferentialEvolution, box: Box) -> None:
        """Compiles or loads what `advance` needs, so that a search is timed without it."""
        population = seed_population(replace(settings, population=5), box, 0)
        self.advance(settings, box, population, Staleness(), Stops(), 1)

    def advance(
        self,
        settings: DifferentialEvolution,
        box: Box,
        population: Population,
        staleness: Staleness,
        stops: Stops,
        generations: int,
    ) -> Stretch:
        """Returns the population some generations later, or at the first stop."""
        (count, parameters), real = population.members.shape, self._real
        members, trials = (aligned(count, parameters, dtype=real) for _ in range(2))
        members[:] = population.members
        costs = population.costs.copy()
        lanes = aligned(parameters, padded(count, real), dtype=real)
        history = np.empty((generations, 2))
        done, stale, reference = evolve_generations(
            self.program,
            self.rows,
            self._work,
            in_precision(settings.breeding(box), real),
            np.uint64(population.key),
            members,
            costs,
            trials,
            lanes,
            aligned(lanes.shape[1]),
            population.generation,
            (staleness.generations, staleness.reference),
            (stops.cost, stops.patience, stops.improvement),
            history,
        )
        after = replace(
            population,
            members=members.astype(np.float64, copy=False),
            costs=costs,
            generation=population.generation + done,
        )
        return Stretch(after, Staleness(stale, reference), history[:done])
