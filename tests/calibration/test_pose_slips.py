"""Quaternions in another order, inverted poses, angles about moving axes, left-handed frames: told by name."""

from dataclasses import replace

import numpy as np
import pytest
from rehearsed import measured, position_cell, ranger_cell
from scipy.spatial.transform import Rotation
from test_explanations import alternatives, truth_of

from boresight.arm import catalogue
from boresight.calibration.placement import find_frames
from boresight.calibration.pose_slips import pose_slips
from boresight.calibration.slips import slips
from boresight.errors import InputError
from boresight.geometry import Frame
from boresight.sensing import Cell, Pose

CELL = Cell(
    catalogue.load("ur10"),
    Pose(6e-5, 1e-4),
    base=Frame((0.4, -0.3, 0.2), (0.2, -0.3, 1.0)),
    mount=Frame((0.02, 0.01, 0.1), (0.3, 0.2, -0.4)),
)
FRAMES = frozenset(f"{f}.{a}" for f in ("base", "mount") for a in ("x", "y", "z", "yaw", "pitch", "roll"))
MIRROR = np.diag([1.0, 1.0, -1.0])


def turned(readings, rotations, values=None):
    values = readings.values if values is None else np.hstack([values, readings.values[:, 3:]])
    return replace(readings, reference=rotations, values=values)


def scalar_last(readings):
    """What is read where x, y, z, w stand in the columns qw, qx, qy, qz."""
    x, y, z, w = Rotation.from_matrix(readings.reference).as_quat().T
    return turned(readings, Rotation.from_quat(np.stack([y, z, w, x], axis=1)).as_matrix())


def scalar_first(readings):
    x, y, z, w = Rotation.from_matrix(readings.reference).as_quat().T
    return turned(readings, Rotation.from_quat(np.stack([w, x, y, z], axis=1)).as_matrix())


def orientations_inverted(readings):
    return turned(readings, Rotation.from_matrix(readings.reference).inv().as_matrix())


def poses_inverted(readings):
    inverse = Rotation.from_matrix(readings.reference).inv()
    return turned(readings, inverse.as_matrix(), -inverse.apply(readings.values[:, :3]))


def about_moving_axes(readings):
    """What is read where the file's roll, pitch and yaw are those of x-y'-z'': read as about fixed axes."""
    angles = Rotation.from_matrix(readings.reference).as_euler("XYZ")
    return turned(readings, Rotation.from_euler("xyz", angles).as_matrix())


def left_handed(readings):
    return turned(readings, MIRROR @ readings.reference @ MIRROR, readings.values[:, :3] @ MIRROR)


def z_negated(readings):
    return turned(readings, readings.reference, readings.values[:, :3] @ MIRROR)


SLIPS = [
    (scalar_last, "quaternion order", "scalar last"),
    (scalar_first, "quaternion order", "scalar first"),
    (orientations_inverted, "orientations inverted", "world in the tool's frame"),
    (poses_inverted, "poses inverted", "invert them"),
    (about_moving_axes, "order of angles", "axes that move"),
    (left_handed, "left-handed coordinates", "column z with the other sign, orientations with them"),
    (z_negated, "left-handed coordinates", "column z with the other sign:"),
]


@pytest.mark.parametrize(("slip", "effect", "words"), SLIPS)
def test_a_slip_of_poses_is_told(slip, effect, words):
    readings = slip(measured(CELL, truth_of(CELL), 60, 1))
    found = alternatives(CELL, readings)
    assert found[0].effect == effect
    assert words in found[0].sentence
    assert found[0].ratio_after < 2.0


@pytest.mark.parametrize(("slip", "words"), [(scalar_last, "scalar last"), (poses_inverted, "invert them")])
def test_a_slip_of_poses_is_told_where_frames_are_unknown(slip, words):
    readings = slip(measured(CELL, truth_of(CELL), 60, 1))
    start = replace(CELL, base=Frame(), mount=Frame())
    with pytest.raises(InputError, match=rf"no placement of `base` and `mount` explains.*{words}"):
        find_frames(start, readings, FRAMES, 0)


def test_undoing_a_slip_gives_the_readings_back():
    given = measured(CELL, rows=12)
    for slip, _, words in SLIPS:
        undone = [changed for _, said, changed in pose_slips(CELL, slip(given)) if words.rstrip(":") in said]
        left = [
            np.abs(each.reference - given.reference).max() + np.abs(each.values - given.values).max() for each in undone
        ]
        assert min(left) < 1e-9


def test_no_slip_of_poses_is_told_of_rows_that_are_as_they_should_be():
    assert alternatives(CELL, measured(CELL, truth_of(CELL), 60, 1)) == ()


def test_ranges_have_no_slips_of_poses():
    cell = ranger_cell()
    assert not list(pose_slips(cell, measured(cell, rows=10)))


def test_positions_alone_have_those_of_left_handed_frames():
    cell = position_cell("ur10")
    effects = {effect for effect, *_ in pose_slips(cell, measured(cell, rows=10))}
    assert effects == {"left-handed coordinates"}
    assert effects < {effect for effect, *_ in slips(cell, measured(cell, rows=10))}


def test_what_neither_placement_nor_slip_explains_is_not_told_as_two_placements(monkeypatch):
    monkeypatch.setattr("boresight.calibration.placement.find.slip_that_explains", lambda *_: None)
    cell = replace(CELL, arm=catalogue.load("space-arm"))
    readings = orientations_inverted(measured(cell, truth_of(cell), 40, 1))
    with pytest.raises(InputError, match="no placement of `base` and `mount` explains the readings: the best one"):
        find_frames(replace(cell, base=Frame(), mount=Frame()), readings, FRAMES, 0)
