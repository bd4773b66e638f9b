"""A ball in sockets: sockets that nobody measured show no scale, and two that are measured do."""

import math
from dataclasses import replace

import numpy as np
import pytest

from boresight.arm import Arm, Joint
from boresight.calibration import Campaign, Solver, calibrate, inspect, simulate
from boresight.calibration.campaign import Freedom
from boresight.calibration.scale_held import scale_held
from boresight.errors import InputError
from boresight.geometry import Frame, Point
from boresight.sensing import Cell, PointContact
from boresight.synthetic import draw_configurations, perturbed, simulated_readings

QUARTER = math.pi / 2
ARM = Arm(
    "ball-arm",
    (
        Joint("j1", d=0.33, a=0.02, alpha=-QUARTER),
        Joint("j2", d=0.0, a=0.4, alpha=0.3),
        Joint("j3", d=0.12, a=0.03, alpha=-QUARTER),
        Joint("j4", d=0.35, alpha=QUARTER),
        Joint("j5", alpha=-QUARTER),
        Joint("j6", d=0.1, a=0.05, alpha=0.5),
    ),
)
SOCKETS = {
    "s0": Point((0.55, 0.1, 0.25)),
    "s1": Point((0.60, 0.1, 0.25)),
    "s2": Point((0.1, 0.55, 0.45)),
    "s3": Point((0.3, -0.4, 0.1)),
}
CELL = Cell(ARM, PointContact(1e-4), mount=Frame((0.0, 0.0, 0.05)), targets=SOCKETS)
WRONG = {f"{joint.name}.{n}": 0.003 for joint in ARM.joints for n in ("theta", "alpha", "a", "d")}
SOLVER = Solver("least-squares")


def unknown(*owners):
    return frozenset(f"{owner}.{axis}" for owner in owners for axis in "xyz")


@pytest.fixture(scope="module")
def measured():
    """Returns the true cell and what is read of it, 30 contacts a socket, and where it is judged by."""
    truth = perturbed(CELL, WRONG, seed=3)
    joints, target = draw_configurations((CELL, truth), 120, seed=3)
    return truth, simulated_readings(truth, joints, target, seed=3)


def campaign(readings, sockets, unmeasured, **further):
    """Returns a campaign whose sockets at unknown places stand at the origin, as files leave them."""
    at = {name: Point((0.0, 0.0, 0.0)) if name in unmeasured else point for name, point in sockets.items()}
    return Campaign(
        "sockets", replace(CELL, targets=at), readings, unknown=unknown(*unmeasured) | further.pop("also", frozenset()),
        **further,
    )  # fmt: skip


def tool_error(result, truth):
    """Returns how far the tool is off after the best rigid motion [m], and the scale that would fit best."""
    joints = np.random.default_rng(5).uniform(-2.6, 2.6, (200, 6))
    ours, theirs = (cell.poses(joints)[:, :3, 3] for cell in (result, truth))
    a, b = ours - ours.mean(axis=0), theirs - theirs.mean(axis=0)
    left, _, right = np.linalg.svd(a.T @ b)
    turned = a @ left @ np.diag([1.0, 1.0, np.linalg.det(left @ right)]) @ right
    return float(np.sqrt(np.mean(np.sum((turned - b) ** 2, axis=1)))), float(np.sum(turned * b) / np.sum(turned**2))


def test_of_sockets_that_nobody_measured_the_arm_keeps_its_size(measured):
    truth, readings = measured
    result = calibrate(campaign(readings, SOCKETS, tuple(SOCKETS)), SOLVER)
    before, after = tool_error(CELL, truth), tool_error(result.cell, truth)
    assert result.verdict.accepted
    assert result.verdict.accepted_for == "relative"
    assert "j2.a" not in result.free_names
    assert any("j2.a (scale is not seen: contacts with points at unknown places" in note for note in result.notes)
    length = truth.arm.joints[1].a / 0.4
    assert after[1] == pytest.approx(length, abs=1e-3)  # all that is left is what j2.a itself is off by
    assert after[0] < before[0]


def test_two_sockets_that_are_measured_show_the_scale(measured):
    truth, readings = measured
    result = calibrate(campaign(readings, SOCKETS, ("s1", "s3")), SOLVER)
    assert result.verdict.accepted_for == "absolute"
    assert not any("scale is not seen" in note for note in result.notes)
    assert "j2.a" in result.free_names
    left, scale = tool_error(result.cell, truth)
    assert left < 2e-4
    assert scale == pytest.approx(1.0, abs=1e-4)
    for name in ("s1", "s3"):
        np.testing.assert_allclose(result.cell.targets[name].xyz, truth.targets[name].xyz, rtol=0, atol=3e-4)


def test_what_is_asked_for_leaves_the_scale_out_too(measured):
    truth, readings = measured
    asked = tuple(Freedom(name, 0.02, 0.01) for name in WRONG if name not in ("j1.d", "j1.theta", "j6.alpha"))
    result = calibrate(campaign(readings, SOCKETS, tuple(SOCKETS), freedoms=asked), SOLVER)
    assert "j2.a" not in result.free_names
    assert any("j2.a (scale is not seen" in note for note in result.notes)
    assert tool_error(result.cell, truth)[1] == pytest.approx(truth.arm.joints[1].a / 0.4, abs=1e-3)


def test_a_length_beside_others_that_are_known_is_seen(measured):
    _, readings = measured
    names = ("s0.x", "s0.y", "s0.z", "j2.a", "j3.theta")
    assert scale_held(CELL, readings, names) is None
    every = (*unknown(*SOCKETS), *WRONG)
    assert scale_held(CELL, readings, every) == "j2.a"


def test_a_tip_that_nobody_measured_is_found_by_turning_about_a_point(measured):
    _, readings = measured
    asked = campaign(readings, SOCKETS, tuple(SOCKETS), also=unknown("mount"), freedoms=())
    result = calibrate(replace(asked, cell=replace(asked.cell, mount=Frame())), SOLVER)
    np.testing.assert_allclose(result.cell.mounts["mount"].xyz, (0.0, 0.0, 0.05), rtol=0, atol=5e-3)
    for name in SOCKETS:
        np.testing.assert_allclose(result.cell.targets[name].xyz, SOCKETS[name].xyz, rtol=0, atol=0.02)


def test_a_base_that_nothing_ties_to_the_world_is_refused(measured):
    _, readings = measured
    every = frozenset(f"base.{n}" for n in ("x", "y", "z", "roll", "pitch", "yaw"))
    with pytest.raises(InputError, match="every reading is a contact of these points: nothing ties the base to the"):
        calibrate(campaign(readings, SOCKETS, tuple(SOCKETS), also=every), SOLVER)


def test_a_base_is_found_by_sockets_that_are_measured(measured):
    truth, readings = measured
    every = frozenset(f"base.{n}" for n in ("x", "y", "z", "roll", "pitch", "yaw"))
    moved = Frame((0.5, -0.3, 0.2), (0.1, -0.2, 2.0))
    turn, shift = moved.matrix[:3, :3], np.array(moved.xyz)
    there = {name: Point(tuple(float(v) for v in turn @ point.xyz + shift)) for name, point in SOCKETS.items()}
    result = calibrate(campaign(readings, there, ("s3",), also=every), SOLVER)
    np.testing.assert_allclose(result.cell.base.matrix, moved.matrix, rtol=0, atol=0.02)
    assert tool_error(result.cell, truth)[0] < 5e-4


def test_inspect_says_that_scale_is_unseen(measured):
    _, readings = measured
    planned = campaign(readings, SOCKETS, tuple(SOCKETS))
    assert any(out.parameter == "j2.a" and "scale is not seen" in out.reason for out in inspect(planned).left_out)


def test_simulated_contacts_touch_their_points():
    truth = perturbed(CELL, WRONG, seed=4)
    joints, target = draw_configurations((CELL, truth), 40, seed=4)
    readings = simulated_readings(truth, joints, target, seed=4)
    assert not readings.values.any()
    off = truth.predict(readings.joints, readings.target)
    assert 0.5e-4 < float(np.sqrt(np.mean(off**2))) < 2e-4  # the noise is in where the arm stands


def test_points_out_of_reach_are_told():
    far = replace(CELL, targets={"far": Point((9.0, 0.0, 0.0))})
    with pytest.raises(InputError, match="hardly any configuration within the joints' limits touches point 'far'"):
        draw_configurations((far, far), 10, seed=1)


def test_a_campaign_of_sockets_at_unknown_places_is_rehearsed(measured):
    planned = campaign(None, SOCKETS, tuple(SOCKETS))
    rehearsed = simulate(planned, rows=120, seed=2)
    result = calibrate(replace(planned, readings=rehearsed.readings, validation=rehearsed.validation), SOLVER)
    assert result.verdict.accepted
    for name in SOCKETS:
        expected = rehearsed.truth.targets[name].xyz
        assert math.dist(result.cell.targets[name].xyz, expected) < 0.02
    assert any("scale is not seen" in out.reason for out in inspect(planned).left_out)
