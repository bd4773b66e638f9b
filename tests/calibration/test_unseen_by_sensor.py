"""What each kind of sensor cannot see, in words: counted by symmetry and said by `inspect`."""

import pytest

from boresight.arm import catalogue
from boresight.calibration import Campaign, inspect
from boresight.calibration.campaign import Freedom
from boresight.geometry import Frame, Plane, Point
from boresight.sensing import Cell, Distances, DrawWire, LaserRanger, PlaneContact, Pose, Position

ARM = catalogue.load("space-arm")
DECK = {"deck": Plane.of((0.0, 1.0, 4.6), -0.69)}
POST = {"post": Point((1.5, 0.0, 0.0))}
HOOK = {"hook": Point((1.5, 0.7, 0.3))}
TURNED = "they only turn the sensor about its own origin"
IDENTITY = Frame()
SPIN = ("mount.yaw", "mount.pitch", "mount.roll")


def inspected(sensor, targets=None, mount=IDENTITY, extra=()):
    cell = Cell(ARM, sensor, mount=mount, targets=targets or {})
    frames = [f"{owner}.{n}" for owner in ("base", *cell.mounts) for n in ("x", "y", "z", "roll", "pitch", "yaw")]
    links = [n for n in cell.index if n.partition(".")[2] in ("theta", "alpha") and n[:2] not in ("j1", "j6")]
    freedoms = tuple(Freedom(name, 0.02, 0.01) for name in (*links, *frames, "j2.a", *extra))
    return inspect(Campaign("unseen", cell, freedoms=freedoms), rows=100)


@pytest.mark.parametrize(
    ("sensor", "targets", "unseen", "whole_arm"),
    [
        (LaserRanger(1e-4), DECK, 4, 26),
        (DrawWire(1e-4), POST, 6, 24),
        (DrawWire(1e-4), POST | HOOK, 4, 26),
        (PlaneContact(1e-4), DECK, 6, 23),
        (Position(1e-4), None, 3, 27),
        (Pose(1e-4, 1e-4), None, 0, 30),
        (Distances(1e-4), None, 9, 21),
    ],
)
def test_symmetries_count_what_is_unseen(sensor, targets, unseen, whole_arm):
    found = inspected(sensor, targets)
    assert len(found.free) - found.rank == unseen
    assert found.arm_rank == whole_arm
    assert sum(each.directions for each in found.unseen) == unseen


def words_of(found):
    return " / ".join(f"{each.words}. {each.mend}" for each in found.unseen)


def test_ranger_does_not_see_its_spin():
    assert "spin about the beam is not seen" in words_of(inspected(LaserRanger(1e-4), DECK))


@pytest.mark.parametrize(
    ("sensor", "targets"), [(DrawWire(1e-4), POST), (PlaneContact(1e-4), DECK), (Position(1e-4), None)]
)
def test_sensors_of_a_position_do_not_see_how_they_are_turned(sensor, targets):
    (turned,) = (each for each in inspected(sensor, targets).unseen if set(each.parameters) == set(SPIN))
    assert TURNED in turned.words


def test_wire_to_one_point_turns_about_it():
    words = words_of(inspected(DrawWire(1e-4), POST))
    assert "moves the sensor about point `post`" in words
    assert "turning the base about the z axis through point `post` changes no reading" in words
    assert "measure to more points" in words


def test_wire_to_two_points_turns_about_the_line_between_them():
    words = words_of(inspected(DrawWire(1e-4), POST | HOOK))
    assert "turning the base about the line through points `post` and `hook` changes no reading" in words
    assert "one more point that is not in line with these" in words


def test_points_that_nobody_surveyed_move_with_the_base():
    found = inspected(DrawWire(1e-4), POST | HOOK, extra=[f"{n}.{axis}" for n in ("post", "hook") for axis in "xyz"])
    assert "with it changes no reading" in words_of(found)
    assert "points `hook` and `post`" in words_of(found)


def test_distances_do_not_tell_where_the_arm_stands():
    words = words_of(inspected(Distances(1e-4)))
    assert "they only move the whole arm" in words
    assert TURNED in words


def test_each_marker_is_told_by_name():
    mounts = {"red": Frame((0.05, 0.0, 0.1)), "green": Frame((-0.05, 0.02, 0.1))}
    found = inspected(Position(1e-4), mount=mounts)
    turned = [each for each in found.unseen if "about its own origin" in each.words]
    assert {name for each in turned for name in each.parameters} == {
        f"{marker}.{turn}" for marker in mounts for turn in ("roll", "pitch", "yaw")
    }
    assert found.arm_rank == 29  # two points of a tool do not see it spin about the line between them
