"""A cell and its readings written out as the flat arrays of the compiled loops."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from boresight.arm import Chain, Motion
from boresight.geometry import Plane
from boresight.kernels.evolving import evolve_generations
from boresight.kernels.programs import FIXED, SHIFT, TURN, Program, Rows, aligned, padded, workspace
from boresight.kernels.sweeping import sweep
from boresight.search import Box, DifferentialEvolution, Population, Staleness, Stops, Stretch, seed_population
from boresight.sensing.cell import SENSOR, Cell
from boresight.sensing.readings import Readings

_SENSOR_NUMBERS = ("bias", "scale")


def compile_program(
    cell: Cell, free: Sequence[str], prior_weight: Float[np.ndarray, "free"], loss: float = 0.0
) -> Program:
    """Returns how corrections of the free parameters, in that order, become links and planes.

    Args:
        cell: the nominal cell.
        free: names of the parameters that move.
        prior_weight: weight in the cost of each squared correction.
        loss: squared residual [m²] beyond which the cost grows with the residual, not its square; 0 for never.
    """
    place = {name: row for row, name in enumerate(free)}
    segments, prismatic = _segments(cell.chain)
    kept = [[m for m in segment if m.value != 0.0 or m.parameter in place] for segment in segments]
    motions = [motion for segment in kept for motion in segment]
    planes = carried_planes(cell)
    return Program(
        segment_start=np.cumsum([0] + [len(segment) for segment in kept]),
        motion_kind=np.array([TURN if m.turns else SHIFT for m in motions], dtype=np.int64),
        motion_axis=np.array([m.axis for m in motions], dtype=np.int64),
        motion_value=np.array([m.value for m in motions], dtype=float),
        motion_parameter=np.array([place.get(m.parameter or "", FIXED) for m in motions], dtype=np.int64),
        prismatic=np.array(prismatic, dtype=np.bool_),
        plane=np.array([[*plane.normal, plane.offset] for _, plane in planes]),
        plane_parameter=np.array([_plane_rows(name, plane, place) for name, plane in planes], dtype=np.int64),
        plane_dropped=np.array([plane.dropped for _, plane in planes], dtype=np.int64),
        sensor_value=np.array([getattr(cell.sensor, name, 0.0) for name in _SENSOR_NUMBERS]),
        sensor_parameter=np.array([place.get(f"{SENSOR}.{name}", FIXED) for name in _SENSOR_NUMBERS], dtype=np.int64),
        prior_weight=np.ascontiguousarray(prior_weight, dtype=float),
        loss=float(loss),
    )


def compile_rows(cell: Cell, readings: Readings, weight: Float[np.ndarray, "rows channels"]) -> Rows:
    """Returns the readings channel by channel, each with the weight of its squared residual in the cost."""
    count, channels = readings.values.shape
    angle = np.array([motion.turns for motion in cell.chain.motions if motion.joint is not None])
    order = [motion.joint for motion in cell.chain.motions if motion.joint is not None]
    moved = readings.joints[:, order]
    own = np.broadcast_to(readings.target[:, None], (count, channels))
    plane = np.array([channel if readout.plane else 0 for channel, readout in enumerate(cell.sensor.readouts)])
    is_own = np.array([readout.plane is None for readout in cell.sensor.readouts])
    first, second = np.where(angle, np.cos(moved), moved), np.where(angle, np.sin(moved), 0.0)
    return Rows(
        first=np.ascontiguousarray(np.repeat(first, channels, axis=0)),
        second=np.ascontiguousarray(np.repeat(second, channels, axis=0)),
        plane=np.where(is_own, own, plane).ravel().astype(np.int64),
        readout=np.tile([readout.kind for readout in cell.sensor.readouts], count).astype(np.int64),
        reading=readings.values.ravel().astype(float),
        weight=np.ascontiguousarray(weight, dtype=float).ravel(),
    )


def _segments(chain: Chain) -> tuple[list[list[Motion]], list[bool]]:
    """Splits a chain at its joints: each joint's own motion opens a segment."""
    segments: list[list[Motion]] = [[]]
    prismatic = []
    for motion in chain.motions:
        if motion.joint is not None:
            assert motion.axis == 2, "the compiled loop's joints move about or along z"
            segments.append([])
            prismatic.append(not motion.turns)
        segments[-1].append(motion)
    return segments, prismatic


def carried_planes(cell: Cell) -> list[tuple[str, Plane]]:
    """Returns the planes that are carried and their names: the targets, or those the sensor itself is read against."""
    if cell.sensor.needs_target:
        return list(cell.targets.items())
    return [("", readout.plane) for readout in cell.sensor.readouts if readout.plane is not None]


def _plane_rows(name: str, plane: Plane, place: dict[str, int]) -> list[int]:
    return [place.get(f"{name}.{number}", FIXED) for number in ("normal_x", "normal_y", "normal_z", "offset")]


class CompiledCost:
    """The cost of corrections: weighted squared residuals plus weighted squared corrections.

    Callable on (members, parameters), and able to run whole generations (`boresight.search.evolve`).
    """

    def __init__(self, program: Program, rows: Rows) -> None:
        self._program = program
        self._rows = rows
        self._work = workspace(program)

    def __call__(self, members: Float[np.ndarray, "members parameters"]) -> Float[np.ndarray, "members"]:
        """Returns the cost of every member."""
        lanes = np.zeros((members.shape[1], padded(len(members))))
        lanes[:, : len(members)] = members.T
        costs = np.empty(lanes.shape[1])
        sweep(self._program, self._rows, self._work, lanes, costs)
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
        count, parameters = population.members.shape
        members, trials = aligned(count, parameters), aligned(count, parameters)
        members[:] = population.members
        costs = population.costs.copy()
        lanes = aligned(parameters, padded(count))
        history = np.empty((generations, 2))
        done, stale, reference = evolve_generations(
            self._program,
            self._rows,
            self._work,
            settings.breeding(box),
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
        after = replace(population, members=members, costs=costs, generation=population.generation + done)
        return Stretch(after, Staleness(stale, reference), history[:done])
