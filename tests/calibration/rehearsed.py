"""Campaigns with a known truth: the paper's arm before its plane, and others, measured in simulation."""

from dataclasses import replace

import numpy as np

from boresight.arm import catalogue
from boresight.calibration import Campaign
from boresight.calibration.campaign import Freedom
from boresight.geometry import Plane
from boresight.sensing import Cell, LaserRanger, Position
from boresight.synthetic import draw_configurations, perturbed, simulated_readings

DECK = Plane.of((0.0, 1.0, 4.6), -0.69)
WALLS = {"wall_x": Plane.of((-1.0, 0.15, 0.2), 1.6), "wall_y": Plane.of((0.1, -1.0, 0.15), 1.7)}
NOISE = 6e-5


def ranger_cell(arm="space-arm", planes=1, **frames):
    targets = dict([("deck", DECK), *WALLS.items()][:planes])
    return Cell(catalogue.load(arm) if isinstance(arm, str) else arm, LaserRanger(NOISE), targets=targets, **frames)


def position_cell(arm="space-arm", **frames):
    return Cell(catalogue.load(arm) if isinstance(arm, str) else arm, Position(NOISE), **frames)


def measured(cell, truth=None, rows=80, seed=0):
    """Readings of a true cell (the nominal one by default) in configurations where both see their targets."""
    truth = cell if truth is None else truth
    return simulated_readings(truth, *draw_configurations((cell, truth), rows, seed), seed)


def usual_freedoms(cell, skipped=("j1.theta", "j2.d")):
    """The paper's: every angle within 25 mrad, every length within 10 mm, beta for d of the second joint."""
    widths = {"theta": 0.025, "alpha": 0.025, "d": 0.01, "a": 0.01}
    names = [f"{joint}.{number}" for joint in cell.arm.joint_names for number in widths] + ["j2.beta"]
    wanted = [name for name in cell.index if name in names and name not in skipped]
    return tuple(Freedom(n, widths.get(n[3:], 0.025), widths.get(n[3:], 0.025) / np.sqrt(3)) for n in wanted)


def rehearsed_campaign(planes=3, rows=80, seed=0, size=0.4):
    """A campaign of the paper's arm, and its true cell."""
    cell = ranger_cell(planes=planes)
    freedoms = usual_freedoms(cell)
    truth = perturbed(cell, {f.parameter: size * f.within for f in freedoms}, seed)
    readings = measured(cell, truth, rows, seed)
    return Campaign("rehearsed", cell, readings, freedoms=freedoms), truth


def with_gross_error(campaign, row, error_m):
    values = campaign.readings.values.copy()
    values[row] += error_m
    return replace(campaign, readings=replace(campaign.readings, values=values))
