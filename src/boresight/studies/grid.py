"""What a study asks: the points of its grid, each one kind of simulated campaign, and how many seeds of each."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from boresight.calibration.campaign import Freedom
from boresight.calibration.solve import Solver, SolverName
from boresight.errors import InputError
from boresight.search import CPU, STRATEGIES, Device, DifferentialEvolution, Stops
from boresight.sensing import Cell
from boresight.studies.content import key_of

STEEPEST = 0.02
"""`error_size` makes no component of a normal err by more than this, unless `within` itself is larger: its plane
might lean the other way."""

AXES = (
    "robot",
    "planes",
    "fixed",
    "rows",
    "repeats",
    "noise_std",
    "error_size",
    "gross_errors",
    "solver",
    "strategy",
    "population",
    "generations",
)
"""What can be varied."""


@dataclass(frozen=True)
class Bench:
    """What is calibrated, before its settings are varied.

    Attributes:
        cell: the nominal cell with all its targets.
        freedoms: what is wrong, uniformly within `within`, and estimated.
        joints: configurations to measure in; None to draw them.
        target: for each of them the index of its target.
    """

    cell: Cell
    freedoms: tuple[Freedom, ...]
    joints: Float[np.ndarray, "rows joints"] | None = None
    target: Int[np.ndarray, "rows"] | None = None


@dataclass(frozen=True)
class Chosen:
    """Some targets or parameters.

    Attributes:
        words: what the study calls them: `3`, `base.*`.
        names: which they are.
    """

    words: str
    names: tuple[str, ...] = ()


NONE = Chosen("none")


@dataclass(frozen=True)
class Settings:
    """What can be varied beside the robot.

    Attributes:
        planes: the targets that are used.
        fixed: the parameters that are neither wrong nor estimated.
        rows: configurations drawn; None for the bench's own.
        repeats: readings averaged in a row.
        noise_std: standard deviation of one reading [m].
        error_size: factor on the errors, and on the box and the priors that go with them.
        gross_errors: share of rows that are grossly wrong.
        solver: which stages to run.
        strategy, population, generations, patience: of the evolution.
        validation_rows: configurations drawn to judge by.
        device: where evolution runs: it changes the last digits of what is found.
    """

    planes: Chosen
    noise_std: float
    repeats: int = 1
    fixed: Chosen = NONE
    rows: int | None = 35
    error_size: float = 1.0
    gross_errors: float = 0.0
    solver: SolverName = "evolution+least-squares"
    strategy: str = "trade-off"
    population: int = 150
    generations: int = 500
    patience: int = 100
    validation_rows: int = 20
    device: Device = CPU


@dataclass(frozen=True)
class Point:
    """One kind of simulated campaign; with a seed it is one campaign.

    Attributes:
        robot: what the study calls the arm.
        bench: what is calibrated.
        settings: how.
    """

    robot: str
    bench: Bench
    settings: Settings

    @cached_property
    def cell(self) -> Cell:
        """The nominal cell with the planes and the sensor of this point."""
        cell, settings = self.bench.cell, self.settings
        sensor: Any = cell.sensor
        return replace(
            cell,
            sensor=replace(sensor, noise_std=settings.noise_std, repeats=settings.repeats),
            targets={name: plane for name, plane in cell.targets.items() if name in settings.planes.names},
        )

    @cached_property
    def freedoms(self) -> tuple[Freedom, ...]:
        """What is wrong and estimated, its widths scaled."""
        return tuple(
            self._scaled(freedom)
            for freedom in self.bench.freedoms
            if freedom.parameter in self.cell.index and freedom.parameter not in self.settings.fixed.names
        )

    @property
    def solver(self) -> Solver:
        """How to search; the seed is the run's."""
        settings = self.settings
        evolution = DifferentialEvolution(STRATEGIES[settings.strategy], settings.population)
        stops = Stops(settings.generations, patience=settings.patience)
        return Solver(settings.solver, evolution, stops, device=settings.device)

    @property
    def evolves(self) -> bool:
        """Whether an evolution is part of it."""
        return self.settings.solver != "least-squares"

    @property
    def on_card(self) -> bool:
        """Whether a card runs it."""
        return self.evolves and self.settings.device.on_card

    @cached_property
    def key(self) -> str:
        """A digest of all that decides its outcomes, and of nothing else: not the study's name, nor the grid."""
        return key_of(self.cell, self.freedoms, self.bench.joints, self.bench.target, self._numbers())

    def label(self, axis: str) -> Any:
        """Returns the value of something that can be varied, for tables and axes; None where it means nothing."""
        if axis in ("strategy", "population", "generations") and not self.evolves:
            return None
        if axis == "robot":
            return self.robot
        value = getattr(self.settings, axis)
        if axis == "rows" and value is None:
            return len(self.bench.joints)  # type: ignore[arg-type]
        return value.words if isinstance(value, Chosen) else value

    def _scaled(self, freedom: Freedom) -> Freedom:
        assert freedom.within is not None
        size = self.settings.error_size
        if self.cell.parameters[self.cell.index[freedom.parameter]].quantity == "number" and size > 1.0:
            size = max(1.0, min(size, STEEPEST / freedom.within))
        return replace(
            freedom,
            within=size * freedom.within,
            prior_std=None if freedom.prior_std is None else size * freedom.prior_std,
        )

    def _numbers(self) -> dict[str, Any]:
        settings = self.settings
        numbers = {name: getattr(settings, name) for name in ("rows", "gross_errors", "solver", "validation_rows")}
        if self.evolves:
            numbers |= {n: getattr(settings, n) for n in ("strategy", "population", "generations", "patience")}
        if self.evolves and settings.device != CPU:
            numbers["device"] = str(settings.device)
        return numbers


@dataclass(frozen=True)
class Study:
    """A grid of campaigns, and how often each is simulated.

    Attributes:
        name: for titles and folders.
        points: the grid.
        varied: what is varied in it, in the order of `AXES`.
        seeds: every point has the seeds 0 to this, this one left out.
    """

    name: str
    points: tuple[Point, ...]
    varied: tuple[str, ...]
    seeds: int

    def on(self, device: Device) -> Study:
        """Returns the same study with its evolutions on a device."""
        moved = (replace(point, settings=replace(point.settings, device=device)) for point in self.points)
        return replace(self, points=tuple(moved))

    def __len__(self) -> int:
        """Number of runs."""
        return len(self.points) * self.seeds

    def runs(self) -> Iterator[tuple[Point, int]]:
        """Yields every (point, seed).

        Seeds advance together over the whole grid, a few at a time: what is done so far is always about the same
        share of every point, so time left is told honestly and half a study is a whole one with fewer seeds.
        """
        for first in range(0, self.seeds, _TOGETHER):
            for point in self.points:
                for seed in range(first, min(first + _TOGETHER, self.seeds)):
                    yield point, seed


_TOGETHER = 8


def grid(benches: Mapping[str, Bench], axes: Mapping[str, Sequence[Any]], fixed: Settings) -> tuple[Point, ...]:
    """Returns the product of what is varied, points that mean the same left out.

    Args:
        benches: by the robot's name.
        axes: values of each thing that is varied beside the robot.
        fixed: all other settings.

    Raises:
        InputError: a point has nothing to estimate.
    """
    points: dict[str, Point] = {}
    for (robot, bench), *values in itertools.product(benches.items(), *axes.values()):
        settings = replace(fixed, **dict(zip(axes, values, strict=True)))
        point = Point(robot, bench, settings)
        if not point.freedoms:
            raise InputError("every parameter is fixed, so there is nothing to calibrate")
        points.setdefault(point.key, point)
    return tuple(points.values())
