"""Simulated campaigns of the space arm: initial errors uniform within `within`, the ranger's noise of 0.2 mm / √10."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from boresight.arm import catalogue
from boresight.calibration.campaign import Campaign, Freedom
from boresight.calibration.freedom import link_candidates
from boresight.calibration.problem import Problem
from boresight.geometry import Plane
from boresight.inference import spread_configurations
from boresight.sensing import Cell, LaserRanger, Readings
from boresight.synthetic import draw_configurations, perturbed, simulated_readings

PLANES = {
    "deck": Plane.of((0.0, 1.0, 4.6), -0.69),
    "wall_x": Plane.of((-1.0, 0.15, 0.2), 1.6),
    "wall_y": Plane.of((0.1, -1.0, 0.15), 1.7),
}
"""The paper's plane (23), and two walls."""

WITHIN = {"angle": 0.025, "length": 0.010, "number": 0.02}
"""Half-widths of the initial errors [rad, m, 1], those of the examples."""


@dataclass(frozen=True)
class Setup:
    """A kind of campaign.

    Attributes:
        name: in words.
        cell: the nominal cell.
        freedoms: what is wrong, and by how much at most.
        rows: number of readings.
    """

    name: str
    cell: Cell
    freedoms: tuple[Freedom, ...]
    rows: int


@dataclass(frozen=True)
class Drawn:
    """One simulated campaign.

    Attributes:
        truth: the cell that was measured.
        x: true corrections of the free parameters.
        problem: what is to be fitted, priors and bounds as `calibrate` has them.
        noise: (rows, 1) what the noise added to each reading [m].
    """

    truth: Cell
    x: np.ndarray
    problem: Problem
    noise: np.ndarray

    def with_readings(self, readings: Readings) -> Problem:
        """Returns the problem with other readings."""
        return replace(self.problem, readings=readings)

    def campaign(self, readings: Readings | None = None) -> Campaign:
        """Returns what `calibrate` takes."""
        problem = self.problem
        return Campaign("benchmark", problem.cell, readings or problem.readings, freedoms=problem.freedoms)


def setup(
    planes: int, rows: int, estimated: tuple[str, ...] = (), fixed: tuple[str, ...] = (), widths: dict | None = None
) -> Setup:
    """Returns a kind of campaign.

    Args:
        planes: how many of `PLANES` are aimed at.
        rows: number of readings.
        estimated: parameters of planes that are free beside the links'.
        fixed: link parameters that are not.
        widths: half-widths of the initial errors by quantity; `WITHIN` by default.
    """
    targets = dict(list(PLANES.items())[:planes])
    cell = Cell(catalogue.load("space-arm"), LaserRanger(0.0002, repeats=10), targets=targets)
    free = (set(link_candidates(cell.arm)) | set(estimated)) - set(fixed)
    width = {p.name: (widths or WITHIN)[p.quantity] for p in cell.parameters}
    freedoms = tuple(Freedom(n, width[n], width[n] / np.sqrt(3.0)) for n in cell.index if n in free)
    what = "one plane" if planes == 1 else f"{planes} planes"
    known = "estimated" if estimated else "known"
    return Setup(f"{what}, {known}, {rows} rows, {len(freedoms)} parameters", cell, freedoms, rows)


def one_plane(rows: int, widths: dict | None = None) -> Setup:
    """Returns the example `space-arm-one-plane`: the plane's tilt is estimated, azimuth defined by joint 1."""
    return setup(1, rows, ("deck.normal_x", "deck.normal_z"), ("j1.theta",), widths)


def three_planes(rows: int, widths: dict | None = None) -> Setup:
    """Returns three known planes, which see every link parameter, joint 1's azimuth included."""
    return setup(3, rows, widths=widths)


def three_planes_estimated(rows: int) -> Setup:
    """Returns three planes of which nothing is certain: azimuth and height are defined by joint 1."""
    cell = three_planes(rows).cell
    planes = tuple(p.name for p in cell.parameters if p.name.split(".")[0] in PLANES)
    return setup(3, rows, planes, ("j1.theta", "j1.d"))


def draw(kind: Setup, seed: int) -> Drawn:
    """Returns the campaign of a seed: truth, configurations and noise depend on nothing else."""
    cell = kind.cell
    truth = perturbed(cell, {f.parameter: f.within for f in kind.freedoms if f.within}, seed)
    joints, target = draw_configurations((cell, truth), kind.rows, seed)
    readings = simulated_readings(truth, joints, target, seed)
    x = np.array([truth.values[f.parameter] - cell.values[f.parameter] for f in kind.freedoms])
    return Drawn(truth, x, Problem(cell, readings, kind.freedoms), readings.values - truth.predict(joints, target))


def pose_error(truth: Cell, found: Cell, configurations: int = 100) -> float:
    """Returns the RMS error of the tool's position [m] over the work space."""
    joints = spread_configurations(truth, configurations)
    shift = truth.poses(joints)[:, :3, 3] - found.poses(joints)[:, :3, 3]
    return float(np.sqrt(np.mean(np.sum(shift**2, axis=1))))
