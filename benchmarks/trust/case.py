"""One seed of a scenario: the nominal cell, the true one, and the rows that were measured."""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.trust.arms import arm_of
from benchmarks.trust.cell import Cell, Plane, ranges
from benchmarks.trust.configurations import anywhere, measured
from benchmarks.trust.faults.fault import Rows
from benchmarks.trust.kinematics import frame
from benchmarks.trust.scenario import LEVEL, TILTED, Scenario
from benchmarks.trust.truth import moved_planes, true_arm

PLATE_ANGLE, PLATE_LENGTH = 3e-3, 2e-3
"""Standard deviations of what is wrong about plates that the campaign frees [rad, m]."""


@dataclass(frozen=True)
class Case:
    """A campaign and the truth behind it.

    Attributes:
        scenario: its kind.
        stated: the cell that the files describe; unknown frames are the true ones.
        nominal: the same, with nothing stated wrongly.
        truth: the cell when the campaign is over, in which the result will be used.
        observations: rows to calibrate with.
        validation: rows to judge by, read after those; None without.
    """

    scenario: Scenario
    stated: Cell
    nominal: Cell
    truth: Cell
    observations: Rows
    validation: Rows | None

    def true_poses(self, joints: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns positions [m] and orientations of the tool after the campaign."""
        return self.scenario.fault.during(self.truth, np.ones(len(joints))).poses(joints)


def draw(scenario: Scenario, seed: int) -> Case:
    """Returns the case of a seed; it depends on the scenario's name and the seed alone."""
    random = np.random.default_rng([seed, zlib.crc32(scenario.name.encode())])
    nominal = _nominal(scenario, random)
    arm = true_arm(nominal.arm, scenario.errors, scenario.size, scenario.exact, random)
    truth = replace(nominal, arm=arm)
    if scenario.estimated:
        truth = moved_planes(truth, PLATE_ANGLE, PLATE_LENGTH, random)
    truth = scenario.fault.truth(truth, random)
    observations = _rows(scenario, nominal, truth, scenario.rows, scenario.postures, random)
    validation = None
    if scenario.validation:
        validation = _rows(scenario, nominal, truth, scenario.validation, None, random, after=True)
    return Case(scenario, scenario.fault.stated(nominal), nominal, truth, observations, validation)


def _nominal(scenario: Scenario, random: np.random.Generator) -> Cell:
    """Returns the cell before anything goes wrong; frames that nobody has measured stand anywhere sensible."""
    known = LEVEL if scenario.level else TILTED
    planes = {
        name: Plane(plane.normal, scenario.size * plane.offset)
        for name, plane in list(known.items())[: scenario.planes if scenario.sensor == "laser_ranger" else 0]
    }
    base, mount = np.eye(4), np.eye(4)
    if "base" in scenario.unknown:
        tilt, yaw = random.normal(0.0, 0.02, 2), random.uniform(-np.pi, np.pi)
        base = frame(tuple(random.uniform((-0.15, -0.15, -0.05), (0.15, 0.15, 0.25))), (*tilt, yaw))
    if "mount" in scenario.unknown:
        turned = scenario.sensor == "laser_ranger"
        mount = frame(
            tuple(random.uniform(0.02, 0.08, 3)), tuple(random.uniform(-0.3, 0.3, 3)) if turned else (0, 0, 0)
        )
    return Cell(arm_of(scenario.arm, scenario.size), base, mount, planes, scenario.size)


def _rows(
    scenario: Scenario,
    nominal: Cell,
    truth: Cell,
    count: int,
    postures: int | None,
    random: np.random.Generator,
    after: bool = False,
) -> Rows:
    fault, ranger, different = scenario.fault, scenario.sensor == "laser_ranger", postures or count
    if ranger:
        joints, target = measured((nominal, truth), different, scenario.beams, random)
    else:
        joints, target = anywhere(nominal, different, random), np.zeros(different, dtype=int)
    actual = fault.actual(joints, random)
    joints, target, actual = (np.repeat(each, count // different, axis=0) for each in (joints, target, actual))
    time = np.ones(len(joints)) if after else np.linspace(0.0, 1.0, len(joints))
    then = fault.during(truth, time)
    if ranger:
        distance, cosine = ranges(then, actual, target)
        values = distance[:, None]
    else:
        values, cosine = then.poses(actual)[0], np.ones(len(joints))
    rows = Rows(joints, fault.sensor(values, time), target, cosine)
    std, repeats = scenario.noise
    noise = std / np.sqrt(repeats) * fault.noise(random, rows)
    return fault.rows(replace(rows, values=rows.values + noise), random)
