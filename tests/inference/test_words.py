"""Unseen directions by name: which motion, which parameters, and that they really change no reading."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boresight.arm import catalogue
from boresight.geometry import Plane
from boresight.inference import identify_directions, movements_of, unseen_in_words
from boresight.inference.symmetries import symmetries_of
from boresight.sensing import Cell, LaserRanger, Position
from boresight.synthetic import draw_configurations
from random_cells import random_cell, random_joints, random_targets

ARM = catalogue.load("space-arm")
RANGER = LaserRanger(2e-4, 10)
DECK = Plane.of((0.0, 1.0, 4.6), -0.69)
FLOOR = Plane.of((0.0, 0.0, 1.0), -0.15)
WALL = Plane.of((-1.0, 0.15, 0.2), 1.6)
CORNER = Plane.of((0.1, -1.0, 0.15), 1.7)
LINKS = [f"j{i}.{n}" for i in range(1, 7) for n in ("theta", "d", "a", "alpha") if (i, n) != (2, "d")] + ["j2.beta"]
BASE = [f"base.{n}" for n in ("x", "y", "z", "roll", "pitch", "yaw")]


def said(cell, names, rows=80, corrections=None):
    joints, target = draw_configurations((cell,), rows, 1)
    names = tuple(name for name in cell.index if name in names)
    _, full = cell.linearise(joints, target, corrections)
    jacobian = full[:, :, [cell.index[name] for name in names]].reshape(-1, len(names)) / 1e-4
    scale = np.full(len(names), 0.01)
    moves = movements_of(cell, joints, target, names, corrections)
    return unseen_in_words(identify_directions(names, jacobian, scale), scale, moves)


def space_arm(sensor=RANGER, **targets):
    return Cell(ARM, sensor, targets=targets)


def test_azimuth_of_arm_and_plane_is_a_turn_of_the_base():
    (only,) = said(space_arm(deck=DECK), [*LINKS, "deck.normal_x", "deck.normal_z"])
    assert only.words == (
        "turning the base about z while turning plane `deck` with it changes no reading: "
        "j1.theta and deck.normal_x cannot be told apart"
    )
    assert only.mend.startswith("fix j1.theta")
    assert "a known azimuth" in only.mend


def test_flat_plane_hides_theta_1_a_1_and_d_3_for_one_reason():
    (only,) = said(space_arm(deck=FLOOR), LINKS)
    assert only.parameters == ("j1.theta", "j1.a", "j3.d")
    assert only.directions == 3
    assert only.words == (
        "j1.theta, j1.a and j3.d do not change any reading, because plane `deck` is perpendicular to the first axis: "
        "they only move the sensor along it"
    )


def test_flat_plane_hides_the_same_three_at_a_bent_arm_and_says_to_within_what():
    cell = space_arm(deck=FLOOR)
    rng = np.random.default_rng(3)
    bent = np.array([rng.normal(0.0, 0.006) if p.name in LINKS else 0.0 for p in cell.parameters])
    (only,) = said(cell, LINKS, corrections=bent)
    assert only.parameters == ("j1.theta", "j1.a", "j3.d")
    assert "j3.d (to within " in only.words


def test_spin_about_the_beam_is_said():
    spin = said(space_arm(a=DECK, b=WALL, c=CORNER), [*LINKS, "mount.yaw", "mount.roll"])[-1]
    assert spin.words == "mount.yaw does not change any reading: spin about the beam is not seen"


def test_parameters_that_do_the_same_are_told():
    (only,) = said(space_arm(deck=DECK), [*LINKS, "j1.beta"])
    assert only.words == (
        "j1.theta and j1.beta cannot be told apart: both move the sensor alike, in every configuration"
    )
    assert only.mend == "fix one of them, say `fixed: [j1.beta]`"


def test_one_plane_lets_the_base_slide_two_ways_and_turn():
    words = " ".join(each.words for each in said(space_arm(deck=DECK), BASE))
    assert "base.x does not change any reading" in words
    assert "turning the base about the normal of plane `deck`" in words
    assert "shifting the base along plane `deck`, towards z," in words


def test_two_planes_let_the_base_slide_along_their_line():
    (only,) = said(space_arm(deck=DECK, wall=WALL), BASE)
    assert "along the line where planes `deck` and `wall` meet" in only.words


def test_free_planes_move_with_the_base():
    found = said(space_arm(deck=DECK), ["j1.theta", "j1.d", "deck.normal_x", "deck.normal_z", "deck.offset"])
    assert [each.parameters for each in found] == [("j1.theta", "deck.normal_x"), ("j1.d", "deck.offset")]
    assert "shifting the base along z while shifting plane `deck` with it" in found[1].words


def test_tracker_does_not_see_the_reflector_turn_about_itself():
    (only,) = said(space_arm(Position(1e-4)), ["j2.theta", "mount.roll", "mount.pitch", "mount.yaw"])
    assert set(only.parameters) == {"mount.roll", "mount.pitch", "mount.yaw"}
    assert "turn the sensor about its own origin" in only.words


def test_planes_that_no_row_aims_at_are_told():
    cell = space_arm(deck=DECK, wall=WALL)
    joints, _ = draw_configurations((space_arm(deck=DECK),), 60, 1)
    names, target = ("j2.theta", "wall.offset"), np.zeros(60, dtype=int)
    _, full = cell.linearise(joints, target)
    jacobian = full[:, 0, [cell.index[name] for name in names]]
    found = identify_directions(names, jacobian, np.ones(2))
    (only,) = unseen_in_words(found, np.ones(2), movements_of(cell, joints, target, names))
    assert only.words == "wall.offset does not change any reading, because no row aims at plane `wall`"
    assert only.mend == "aim some rows at it, or leave it out of `estimate:`"


def test_too_few_readings_are_one_sentence():
    found = said(space_arm(deck=DECK), LINKS, rows=10)
    assert len(found) == 1
    assert found[0].directions == 14
    assert "there are 10 values for 24 parameters" in found[0].words


@pytest.mark.parametrize("sensor", ["laser_ranger", "position"])
@settings(max_examples=15)
@given(st.integers(0, 2**32 - 1))
def test_named_directions_are_a_basis_of_what_changes_no_reading(sensor, seed):
    rng = np.random.default_rng(seed)
    cell = random_cell(rng, planes=2, sensor=sensor)
    joints, target = random_joints(rng, cell.arm, 150), random_targets(rng, cell, 150)
    beams = cell.poses(joints)[:, :3, 2]
    normals = np.array([plane.normal for plane in cell.targets.values()])[target]
    steep = np.abs(np.sum(beams * normals, axis=1)) > 0.2
    joints, target = joints[steep], target[steep]
    names = tuple(cell.index)
    _, full = cell.linearise(joints, target)
    jacobian, scale = np.nan_to_num(full.reshape(-1, len(names))), np.full(len(names), 0.01)
    found = identify_directions(names, jacobian, scale)
    named = symmetries_of(found.unseen, scale, movements_of(cell, joints, target, names))
    directions = np.array([each.direction for each in named])
    assert len(named) == len(found.unseen)
    assert np.linalg.matrix_rank(directions, tol=1e-6) == len(named)
    assert np.abs((jacobian * scale) @ directions.T).max() < 1e-4 * np.abs(jacobian * scale).max()
