"""All scenarios, by what they vary: arms, plates, frames, sensors, joints and links, rows, trackers."""

from __future__ import annotations

import fnmatch

import numpy as np

from benchmarks.trust.configurations import Beams
from benchmarks.trust.faults import joints, plates, rows, sensors
from benchmarks.trust.scenario import Scenario
from benchmarks.trust.truth import AS_PRIOR

TWO_DEGREES = float(np.deg2rad(2.0))
FRAMES = ("base", "mount")

ARMS = (
    Scenario("SCARA", "SCARA"),
    Scenario("five axes", "five axes"),
    Scenario("gantry, two planes", "gantry", planes=2),
    Scenario("space arm"),
    Scenario("PUMA-like", "PUMA-like"),
    Scenario("UR-like", "UR-like"),
    Scenario("seven axes", "seven axes"),
    Scenario("reach 0.1 m", size=0.1),
    Scenario("reach 10 m", size=10.0),
    Scenario("errors as large as the prior", errors=AS_PRIOR),
    Scenario("errors as large as the prior, one plane", planes=1, errors=AS_PRIOR),
    Scenario("errors as large as the prior, seven axes", "seven axes", errors=AS_PRIOR),
)

PLATES = (
    Scenario("one plane", planes=1),
    Scenario("one plane, estimated", planes=1, estimated=True),
    Scenario("two planes", planes=2),
    Scenario("two planes, estimated", planes=2, estimated=True),
    Scenario("three planes, estimated", estimated=True),
    Scenario("level plane", planes=1, level=True),
    Scenario("level plane, errors as large as the prior", planes=1, level=True, errors=AS_PRIOR),
    Scenario("level plane and wall", planes=2, level=True),
    Scenario("level plane and wall, gantry", "gantry", planes=2, level=True),
    Scenario("grazing beams", beams=Beams(farthest=8.0, cosine=(0.08, 0.25))),
    Scenario("plates wavy by 0.3 mm", fault=plates.wavy(0.3e-3)),
    Scenario("plates wavy by 1 mm", fault=plates.wavy(1e-3)),
    Scenario("one of three plates 5 mm off", fault=plates.plate_off("deck", 5e-3)),
    Scenario("one of three plates 2° off", fault=plates.plate_tilted("deck", TWO_DEGREES)),
    Scenario("the only plate 5 mm off", planes=1, fault=plates.plate_off("deck", 5e-3)),
    Scenario("the only plate 2° off", planes=1, fault=plates.plate_tilted("deck", TWO_DEGREES)),
    Scenario(
        "the only plate 2° off, estimated", planes=1, estimated=True, fault=plates.plate_tilted("deck", TWO_DEGREES)
    ),
    Scenario("normal with the other sign", fault=plates.normal_flipped("wall_x")),
    Scenario("offset with the other sign", fault=plates.offset_flipped("wall_x")),
)

PLACES = (
    Scenario("base unknown", "PUMA-like", unknown=("base",)),
    Scenario("base unknown, two planes", "PUMA-like", planes=2, unknown=("base",)),
    Scenario("base unknown, gantry, two planes", "gantry", planes=2, unknown=("base",)),
    Scenario("mount unknown", "PUMA-like", unknown=("mount",)),
    Scenario("base and mount unknown", "PUMA-like", unknown=FRAMES),
    Scenario("base 3 mm and 3 mrad off", fault=plates.base_off(3e-3, 3e-3)),
    Scenario("base 3 mm and 3 mrad off, one plane", planes=1, fault=plates.base_off(3e-3, 3e-3)),
    Scenario("mount 3 mm and 3 mrad off", fault=plates.mount_off(3e-3, 3e-3)),
    Scenario("base and mount unknown, seven axes", "long seven axes", unknown=FRAMES),
)

SENSORS = (
    Scenario("ranges 0.5 mm long", fault=sensors.bias(0.5e-3)),
    Scenario("ranges 2 mm long", fault=sensors.bias(2e-3)),
    Scenario("ranges 10 mm long", fault=sensors.bias(10e-3)),
    Scenario("ranges 0.5 mm long, planes estimated", estimated=True, fault=sensors.bias(0.5e-3)),
    Scenario("ranges 2 mm long, one plane", planes=1, fault=sensors.bias(2e-3)),
    Scenario("ranges 1 % long", fault=sensors.scale(1e-2)),
    Scenario("ranges 1 % long, one plane estimated", planes=1, estimated=True, fault=sensors.scale(1e-2)),
    Scenario("ranges 0.1 % long", fault=sensors.scale(1e-3)),
    Scenario("ranges 0.1 % long, one plane", planes=1, fault=sensors.scale(1e-3)),
    Scenario("ranges in steps of 1 mm", fault=sensors.quantised(1e-3)),
    Scenario("zero of the ranger moves 1 mm half way", fault=sensors.step(1e-3)),
    Scenario("zero of the ranger drifts 1 mm", fault=sensors.zero_drift(1e-3)),
    Scenario("noise with heavy tails", fault=sensors.heavy_tails()),
    Scenario("noise grows with incidence", fault=sensors.noise_with_incidence(4.0)),
    Scenario("noise stated at a third", stated=1 / 3, fault=sensors.noise_understated()),
    Scenario("noise stated at a third, 30 rows", rows=30, stated=1 / 3, fault=sensors.noise_understated()),
    Scenario("noise stated at half, 35 rows", rows=35, stated=0.5, fault=sensors.noise_understated()),
    Scenario("noise stated at twice", stated=2.0),
)

JOINTS = (
    Scenario("encoder noise 0.02 mrad", fault=joints.encoder_noise(0.02e-3)),
    Scenario("encoder noise 0.2 mrad", fault=joints.encoder_noise(0.2e-3)),
    Scenario("encoder noise 1 mrad", fault=joints.encoder_noise(1e-3)),
    Scenario("encoder noise 0.2 mrad, one plane estimated", planes=1, estimated=True, fault=joints.encoder_noise(2e-4)),
    Scenario("backlash 0.5 mrad", fault=joints.backlash(0.5e-3)),
    Scenario("joints sag", "UR-like", fault=joints.sag(5e-6, 4.0)),
    Scenario("joints sag, one plane", "UR-like", planes=1, fault=joints.sag(5e-6, 4.0)),
    Scenario("joints sag, planes estimated", "UR-like", estimated=True, fault=joints.sag(5e-6, 4.0)),
    Scenario("joint 3 turns 0.1 % further", fault=joints.gain(3, 1e-3)),
    Scenario("gears with waves of 0.3 mrad", fault=joints.waves(0.3e-3)),
    Scenario("gears with waves of 0.3 mrad, planes estimated", estimated=True, fault=joints.waves(0.3e-3)),
    Scenario("joint 3 counts backwards", fault=joints.counts_backwards(3)),
    Scenario("link 2 grows 0.5 mm", fault=joints.link_grows(2, 0.5e-3)),
    Scenario("zero of joint 2 moves 1 mrad half way", fault=joints.zero_moves(2, 1e-3)),
    Scenario("a fixed length 2 mm wrong", fixed=("j2.a",), fault=joints.fixed_but_wrong(2, "a", 2e-3)),
)

ROWS = (
    Scenario("35 rows", rows=35),
    Scenario("no validation file", validation=0),
    Scenario("30 postures, each read ten times", rows=300, postures=30),
    Scenario("30 postures, no validation file", rows=300, postures=30, validation=0),
    Scenario(
        "30 postures, encoder noise 0.1 mrad", rows=300, postures=30, validation=0, fault=joints.encoder_noise(1e-4)
    ),
    Scenario("5 % of targets swapped", validation=0, fault=rows.swapped_targets(0.05)),
    Scenario("40 % of targets swapped", validation=0, fault=rows.swapped_targets(0.40)),
    Scenario("ranges one row late", fault=rows.shifted_rows(1)),
    Scenario("8 % gross errors", validation=0, fault=rows.gross_errors(0.08)),
    Scenario("20 % gross errors", validation=0, fault=rows.gross_errors(0.20)),
    Scenario("35 % gross errors", validation=0, fault=rows.gross_errors(0.35)),
    Scenario("8 % gross errors, 35 rows", rows=35, validation=0, fault=rows.gross_errors(0.08)),
    Scenario("8 % gross errors, in the validation file too", fault=rows.gross_errors(0.08)),
    Scenario("a block of 8 % wrong", validation=0, fault=rows.clustered_errors(0.08)),
    Scenario("a block of 20 % wrong", validation=0, fault=rows.clustered_errors(0.20)),
    Scenario("a block of 35 % wrong", validation=0, fault=rows.clustered_errors(0.35)),
    Scenario("ranges in mm, labelled m", fault=rows.in_millimetres()),
    Scenario("joints in degrees, labelled rad", fault=rows.in_degrees()),
)

TRACKERS = (
    Scenario("tracker", sensor="position", unknown=FRAMES),
    Scenario("tracker, base and mount known", sensor="position"),
    Scenario("tracker, 30 rows", sensor="position", unknown=FRAMES, rows=30),
    Scenario("tracker, 0.01 % long", sensor="position", unknown=FRAMES, fault=sensors.scale(1e-4)),
    Scenario("tracker, first axis tilted 5 mrad", sensor="position", fault=plates.base_tilted(5e-3)),
    Scenario("tracker, joints sag", "UR-like", sensor="position", unknown=FRAMES, fault=joints.sag(5e-6, 4.0)),
    Scenario("tracker, gears with waves of 0.3 mrad", sensor="position", unknown=FRAMES, fault=joints.waves(0.3e-3)),
    Scenario("tracker, encoder noise 0.2 mrad", sensor="position", unknown=FRAMES, fault=joints.encoder_noise(2e-4)),
    Scenario(
        "tracker, 8 % gross errors", sensor="position", unknown=FRAMES, validation=0, fault=rows.gross_errors(0.08)
    ),
)

FAMILIES = {
    "Arms": ARMS,
    "Plates": PLATES,
    "Base and mount": PLACES,
    "Rangers": SENSORS,
    "Joints and links": JOINTS,
    "Rows": ROWS,
    "Trackers": TRACKERS,
}

SCENARIOS = {each.name: each for family in FAMILIES.values() for each in family}


def matching(pattern: str) -> list[Scenario]:
    """Returns the scenarios whose names match a pattern of a shell, `*plane*`, in order; `|` stands between several."""
    patterns = pattern.split("|")
    return [each for name, each in SCENARIOS.items() if any(fnmatch.fnmatchcase(name, one) for one in patterns)]
