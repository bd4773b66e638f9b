"""The search for placements: its equations, its gauge, what it refuses, and 5 % to 40 % of gross errors."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import NOISE, WALLS, measured, ranger_cell

from boresight.arm import catalogue
from boresight.calibration import Campaign
from boresight.calibration.placement import find_frames
from boresight.calibration.placement.equations import equations_of
from boresight.calibration.placement.placements import Placements, Unknowns, linearised, residuals
from boresight.errors import InputError
from boresight.geometry import Frame, Plane, rotation_angle
from boresight.sensing import Cell, LaserRanger, PlaneContact, Pose, Position

AXES = ("x", "y", "z", "roll", "pitch", "yaw")
BASE, MOUNT = (frozenset(f"{frame}.{axis}" for axis in AXES) for frame in ("base", "mount"))
BASE_FRAME = Frame((0.02, -0.03, 0.05), (0.2, -0.1, 2.0))
MOUNT_FRAME = Frame((0.02, -0.01, 0.05), (0.4, 0.3, -0.2))
SENSORS = (LaserRanger(NOISE), Position(NOISE), Pose(NOISE, 1e-4))


def at(cell):
    base, mount = cell.base.matrix, cell.mounts["mount"].matrix
    return Placements(base[None, :3, :3], base[None, :3, 3], mount[None, None, :3, :3], mount[None, None, :3, 3])


def sensor_cell(sensor):
    targets = {"deck": Plane.of((0.0, 1.0, 4.6), -0.69), **WALLS} if sensor.aims_at is Plane else {}
    return Cell(catalogue.load("space-arm"), sensor, targets=targets, mount=MOUNT_FRAME)


def three_planes(**frames):
    return ranger_cell(planes=3, **frames)


def moved_world(cell, frame):
    """The same cell described in a world that stands elsewhere: base and planes move together."""
    T = frame.matrix
    targets = {}
    for name, plane in cell.targets.items():
        normal = T[:3, :3] @ plane.normal
        targets[name] = Plane.of(tuple(normal), plane.offset - float(normal @ T[:3, 3]))
    return replace(cell, base=Frame.of(T @ cell.base.matrix), targets=targets)


def beam_error(found, truth, readings):
    """RMS distance of the tool [m] and largest angle between beams [rad]."""
    ours, theirs = (cell.poses(readings.joints) for cell in (found, truth))
    cosine = np.einsum("ri,ri->r", ours[:, :3, 2], theirs[:, :3, 2])
    away = np.linalg.norm(ours[:, :3, 3] - theirs[:, :3, 3], axis=1)
    return float(np.sqrt(np.mean(away**2))), float(np.arccos(np.clip(cosine, -1, 1)).max())


@pytest.mark.parametrize("sensor", SENSORS, ids=lambda sensor: sensor.type)
def test_the_true_placement_satisfies_the_equations_of_every_sensor(sensor):
    cell = sensor_cell(sensor)
    readings = measured(cell, rows=12)
    equations = equations_of(replace(cell, base=BASE_FRAME, mount=Frame()), readings)
    assert np.abs(residuals(at(cell), equations)).max() < 8 * NOISE
    assert np.abs(residuals(at(replace(cell, mount=Frame())), equations)).max() > 100 * NOISE


def test_a_contacts_equations_are_its_distances_from_the_planes():
    cell = sensor_cell(LaserRanger(NOISE))
    touching = replace(cell, sensor=PlaneContact(NOISE))
    readings = measured(cell, rows=12)
    np.testing.assert_allclose(
        np.sort(residuals(at(touching), equations_of(touching, readings))[0]),
        np.sort(touching.predict(readings.joints, readings.target)[:, 0]),
        atol=1e-12,
    )


@pytest.mark.parametrize("sensor", SENSORS, ids=lambda sensor: sensor.type)
def test_slopes_of_the_equations_are_those_of_small_steps(sensor):
    cell = sensor_cell(sensor)
    equations = equations_of(cell, measured(cell, rows=4))
    unknowns = Unknowns((True, True), ((True, True),))
    start = at(replace(cell, base=BASE_FRAME))
    _, slopes = linearised(start, equations, unknowns)
    for number in range(12):
        step = np.zeros((1, 12))
        step[0, number] = 1e-6
        ahead, behind = (residuals(start.moved(sign * step, unknowns), equations) for sign in (1.0, -1.0))
        np.testing.assert_allclose(slopes[0, number], (ahead - behind)[0] / 2e-6, atol=1e-7)


def test_a_part_that_is_stated_stays_as_it_is():
    truth = moved_world(three_planes(mount=MOUNT_FRAME), BASE_FRAME)
    readings = measured(truth, rows=60)
    start = replace(
        truth, mount=replace(MOUNT_FRAME, xyz=(0.0, 0.0, 0.0)), base=replace(truth.base, rpy=(0.0, 0.0, 0.0))
    )
    unknown = frozenset({"mount.x", "mount.y", "mount.z", "base.roll", "base.pitch", "base.yaw"})
    found = find_frames(start, readings, unknown, 0).cell
    assert found.base.xyz == truth.base.xyz
    assert rotation_angle(found.mounts["mount"].matrix[:3, :3], MOUNT_FRAME.matrix[:3, :3]) < 1e-12
    assert beam_error(found, truth, readings)[0] < 1e-3


@pytest.mark.parametrize("share", [0.05, 0.2, 0.4])
def test_base_and_mount_are_found_among_gross_errors(share):
    truth = moved_world(three_planes(mount=MOUNT_FRAME), Frame((1.0, -2.0, 0.5), (2.0, 0.7, -2.5)))
    readings = measured(truth, rows=90, seed=3)
    random = np.random.default_rng(5)
    wrong = random.choice(90, round(share * 90), replace=False)
    values = readings.values.copy()
    values[wrong, 0] += random.uniform(0.05, 0.5, len(wrong))
    found = find_frames(
        replace(truth, base=Frame(), mount=Frame()), replace(readings, values=values), BASE | MOUNT, 0
    ).cell
    away, turned = beam_error(found, truth, readings)
    assert away < 1e-3
    assert turned < 2e-3


def test_the_spin_about_the_beam_stays_where_the_file_has_it():
    truth = three_planes(mount=Frame((0.01, 0.02, 0.03), (0.0, 0.0, 1.2)))
    found = find_frames(replace(truth, mount=Frame()), measured(truth, rows=60), MOUNT, 0).cell
    assert abs(found.mounts["mount"].rpy[2]) < 1e-2


def test_two_planes_leave_a_mirrored_base_which_is_told():
    truth = moved_world(ranger_cell(planes=2), BASE_FRAME)
    readings = measured(truth, rows=60)
    placed = find_frames(replace(truth, base=Frame()), readings, BASE, 0)
    assert len(placed.warnings) == 1
    assert "may as well stand at" in placed.warnings[0]
    assert "`deck` and `wall_x` cannot tell which" in placed.warnings[0]


def test_against_one_plane_the_base_stays_near_where_the_file_has_it():
    truth = moved_world(ranger_cell(planes=1), BASE_FRAME)
    stated = Frame((0.0, 0.0, 0.0), (0.2, -0.1, 1.9))
    found = find_frames(replace(truth, base=stated), measured(truth, rows=60), BASE, 0).cell
    assert rotation_angle(found.base.matrix[:3, :3], stated.matrix[:3, :3]) < 0.1
    normal = np.asarray(truth.targets["deck"].normal)
    moved = np.asarray(found.base.xyz) - stated.xyz
    np.testing.assert_allclose(moved, (moved @ normal) * normal, atol=1e-3)


def test_planes_square_to_each_other_are_refused_and_the_sentence_says_what_helps():
    truth = three_planes()
    square = {"deck": (0.0, 0.0, 1.0), "wall_x": (1.0, 0.0, 0.0), "wall_y": (0.0, 1.0, 0.0)}
    targets = {name: Plane.of(normal, 0.4 if name == "deck" else -1.4) for name, normal in square.items()}
    truth = replace(truth, targets=targets)
    with pytest.raises(InputError, match=r"fit \d placements of base alike .*square to each other.*tilt one"):
        find_frames(replace(truth, base=Frame()), measured(truth, rows=60), BASE, 0)


def test_a_plane_whose_offset_has_the_wrong_sign_is_named():
    truth = three_planes(mount=MOUNT_FRAME)
    readings = measured(truth, rows=60)
    deck = truth.targets["deck"]
    wrong = replace(truth, mount=Frame(), targets={**truth.targets, "deck": Plane.of(deck.normal, -deck.offset)})
    with pytest.raises(InputError, match=r"The offset of `deck` with the other sign explains the readings"):
        find_frames(wrong, readings, MOUNT, 0)


def test_rows_that_name_another_target_are_named_by_their_lines():
    truth = three_planes(mount=MOUNT_FRAME)
    readings = measured(truth, rows=90)
    target = readings.target.copy()
    wrong = np.random.default_rng(1).choice(90, 36, replace=False)
    target[wrong] = (target[wrong] + 1) % 3
    with pytest.raises(InputError, match=r"3\d rows fit another target than the one they name \(lines "):
        find_frames(replace(truth, mount=Frame()), replace(readings, target=target), MOUNT, 0)


def test_a_base_that_is_stated_roughly_is_found_on_the_side_where_it_was_stated():
    truth = moved_world(ranger_cell(planes=2), BASE_FRAME)
    readings = measured(truth, rows=60)
    stated = replace(truth, base=Frame((0.1, 0.05, -0.1), (0.1, 0.1, 1.8)))
    std = {**dict.fromkeys(("base.x", "base.y", "base.z"), 0.1), **dict.fromkeys(("base.roll", "base.pitch"), 0.2)}
    campaign = Campaign("rough", stated, readings, priors={**std, "base.yaw": 0.2})
    assert campaign.sought == BASE
    placed = find_frames(stated, readings, campaign.sought, 0, campaign.priors)
    assert not placed.warnings
    assert rotation_angle(placed.cell.base.matrix[:3, :3], truth.base.matrix[:3, :3]) < 2e-3


def test_a_base_that_is_stated_well_is_not_sought():
    cell = ranger_cell()
    assert Campaign("well", cell, priors={"base.x": 0.003, "base.yaw": 0.002}).sought == frozenset()
