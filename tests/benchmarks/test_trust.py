"""The benchmark of silently wrong results: its kinematics against MuJoCo, its judgement, and a run of two scenarios."""

from types import SimpleNamespace

import mujoco
import numpy as np
import pytest
from benchmarks.trust import campaign_files, case, cell, claims, judging, kinematics, scenarios
from benchmarks.trust.arms import ARMS, arm_of
from benchmarks.trust.configurations import anywhere
from benchmarks.trust.scenario import TILTED
from benchmarks.trust.truth import AS_PRIOR, true_arm

from benchmarks import trust
from boresight.files import load_campaign

MASS = 3.0


def wrong_cell(name, seed=0):
    """A cell of an arm as wrong as arms come, with base and mount away from the identity."""
    random = np.random.default_rng(seed)
    arm = true_arm(arm_of(name), AS_PRIOR, 1.0, (), random)
    base = kinematics.frame((0.1, -0.2, 0.3), (0.2, -0.1, 1.5))
    mount = kinematics.frame((0.05, 0.02, 0.08), (0.25, -0.3, 0.4))
    return cell.Cell(arm, base, mount, TILTED, mass=MASS), anywhere(cell.Cell(arm), 20, random)


def in_mujoco(of):
    """The same in MuJoCo: a body for each axis, one with all the mass at each link's end, a site at the sensor."""
    spec = mujoco.MjSpec()
    for name, plane in of.planes.items():
        quat = np.zeros(4)
        mujoco.mju_quatZ2Vec(quat, plane.normal)
        kind = mujoco.mjtGeom.mjGEOM_PLANE
        spec.worldbody.add_geom(name=name, type=kind, size=[9, 9, 1], pos=-plane.offset * plane.normal, quat=quat)
    body = spec.worldbody.add_body(pos=of.base[:3, 3], quat=quaternion(of.base[:3, :3]))
    arm = of.arm
    for k, kind in enumerate(arm.types):
        axis = body.add_body(mass=1e-12, inertia=[1e-12] * 3, explicitinertial=True)
        joint = mujoco.mjtJoint.mjJNT_HINGE if kind == "r" else mujoco.mjtJoint.mjJNT_SLIDE
        axis.add_joint(type=joint, axis=[0, 0, 1])
        turn = axis.add_body(quat=[np.cos(arm.theta[k] / 2), 0, 0, np.sin(arm.theta[k] / 2)])
        turn.mass, turn.inertia, turn.explicitinertial = 1e-12, [1e-12] * 3, True
        tilt = [np.cos(arm.alpha[k] / 2), np.sin(arm.alpha[k] / 2), 0, 0]
        end = turn.add_body(pos=[arm.a[k], 0, arm.d[k]], quat=tilt)
        end.mass, end.ipos, end.inertia, end.explicitinertial = MASS, [0, 0, 0], [1e-12] * 3, True
        body = end.add_body(quat=[np.cos(arm.beta[k] / 2), 0, np.sin(arm.beta[k] / 2), 0])
        body.mass, body.inertia, body.explicitinertial = 1e-12, [1e-12] * 3, True
    body.add_site(name="sensor", pos=of.mount[:3, 3], quat=quaternion(of.mount[:3, :3]))
    return spec.compile()


def quaternion(rotation):
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, rotation.ravel())
    return quat


@pytest.mark.parametrize("name", ARMS)
def test_poses_torques_and_ranges_equal_mujoco(name):
    of, joints = wrong_cell(name)
    model = in_mujoco(of)
    data = mujoco.MjData(model)
    place, turn = of.poses(joints)
    sagged = cell.Cell(of.arm, of.base, of.mount, give=1.0, mass=MASS)._sagged(joints)
    turns = of.arm.revolute
    distances = [cell.ranges(of, joints, np.full(len(joints), k))[0] for k in range(len(of.planes))]
    hits = 0
    for row, q in enumerate(joints):
        data.qpos[:] = q
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(data.site("sensor").xpos, place[row], atol=1e-9)
        np.testing.assert_allclose(data.site("sensor").xmat.reshape(3, 3), turn[row], atol=1e-9)
        np.testing.assert_allclose(-data.qfrc_bias[turns], sagged[row, turns], atol=1e-6)
        for k, plane in enumerate(of.planes):
            model.geom_group[:] = 1
            model.geom_group[model.geom(plane).id] = 0
            mask = np.array([1, 0, 0, 0, 0, 0], dtype=np.uint8)
            found = mujoco.mj_ray(model, data, place[row], turn[row, :, 2].copy(), mask, 1, -1, np.zeros(1, np.int32))
            if found > 0.0:
                hits += 1
                assert found == pytest.approx(distances[k][row], abs=1e-8)
    assert hits


def test_a_wavy_plate_is_met_where_it_is():
    of, joints = wrong_cell("space arm")
    wavy = cell.Cell(of.arm, of.base, of.mount, of.planes, waviness=1e-3)
    target = np.zeros(len(joints), dtype=int)
    distance, cosine = cell.ranges(wavy, joints, target)
    place, turn = wavy.poses(joints)
    met = (distance > 0.0) & (np.abs(cosine) > 0.4)
    points = (place + distance[:, None] * turn[:, :, 2])[met]
    normal = np.tile(of.planes["deck"].normal, (len(points), 1))
    assert len(points)
    np.testing.assert_allclose(
        points @ normal[0] + of.planes["deck"].offset, cell.waves_on(normal, points, wavy), atol=1e-8
    )


@pytest.mark.parametrize(
    ("accepted", "ratio", "named", "outcome"),
    [
        (True, 0.9, False, "covered"),
        (True, 0.9, True, "covered"),
        (True, 1.5, False, "wide"),
        (True, 2.1, False, "SILENT"),
        (True, 9.0, True, "named"),
        (False, 9.0, False, "rejected"),
    ],
)
def test_outcomes(accepted, ratio, named, outcome):
    assert judging.outcome_of(accepted, ratio, named) == outcome


def test_a_rigid_motion_is_no_relative_error():
    random = np.random.default_rng(1)
    points = random.normal(size=(50, 3))
    T = kinematics.frame((0.3, -1.0, 2.0), (0.4, -0.2, 2.5))
    moved = points @ T[:3, :3].T + T[:3, 3]
    errors = judging.position_errors(moved, points)
    assert judging.rms(errors["absolute"]) > 1.0
    assert judging.rms(errors["relative"]) < 1e-12
    mirrored = judging.position_errors(points * [1, 1, -1], points)
    assert judging.rms(mirrored["relative"]) > 0.1


def result(explanations=(), warnings=(), **more):
    joints = np.zeros((4, 6))
    pose = SimpleNamespace(joints=joints, position_95=np.full(4, 1e-3), orientation_95=np.full(4, 1e-3))
    return SimpleNamespace(
        verdict=SimpleNamespace(accepted=True, reasons=("Held-out error fell.",), **more.pop("verdict", {})),
        in_workspace=pose,
        cell=SimpleNamespace(poses=lambda joints: np.tile(np.eye(4), (len(joints), 1, 1))),
        explanations=tuple(SimpleNamespace(effect=effect) for effect in explanations),
        warnings=warnings,
        **more,
    )


def test_a_result_is_judged_by_what_it_is_accepted_for():
    assert claims.claims_of(result()).accuracy == "absolute"
    both = {
        name: SimpleNamespace(
            pose=SimpleNamespace(joints=np.ones((4, 6)), position_95=np.full(4, r), orientation_95=np.full(4, r))
        )
        for name, r in (("absolute", 2.0), ("relative", 3.0))
    }
    told = claims.claims_of(result(accuracy=SimpleNamespace(**both), verdict={"accepted_for": "relative"}))
    assert told.accuracy == "relative"
    assert np.all(told.radius == 3.0)
    assert np.all(told.joints == 1.0)


def test_a_cause_is_named_among_the_first_three_or_in_words():
    fault = scenarios.SCENARIOS["ranges 2 mm long"].fault

    def named(**what):
        return claims.claims_of(result(**what)).names(fault.effects, fault.words)

    assert named(explanations=("deck.offset", "sensor.bias")) == ("sensor.bias",)
    assert named(explanations=("a", "b", "c", "sensor.bias")) == ()
    assert named(warnings=("sensor.bias = 2.0 ± 0.1 mm explains the residuals",))
    assert not named(warnings=("The arm moves in ways this model does not have; bias may explain it.",))


@pytest.mark.parametrize("name", ["level plane and wall, gantry", "base and mount unknown", "two planes, estimated"])
def test_nominal_poses_of_the_written_files_equal_the_packages(name, tmp_path):
    drawn = case.draw(scenarios.SCENARIOS[name], 3)
    campaign = load_campaign(campaign_files.write_campaign(drawn, tmp_path), need_readings=True)
    joints = drawn.observations.joints[:5]
    known = cell.Cell(drawn.stated.arm)
    poses = campaign.cell.arm.forward_kinematics(joints)
    np.testing.assert_allclose(poses[:, :3, 3], known.poses(joints)[0], atol=1e-9)
    np.testing.assert_allclose(poses[:, :3, :3], known.poses(joints)[1], atol=1e-9)
    assert len(campaign.readings) == len(drawn.observations.joints)


@pytest.mark.long
def test_every_scenario_can_be_drawn_and_loaded(tmp_path):
    for scenario in scenarios.SCENARIOS.values():
        drawn = case.draw(scenario, 0)
        assert len(drawn.observations.values) == scenario.rows
        assert campaign_files.write_campaign(drawn, tmp_path).exists()


def test_two_scenarios_run_and_are_not_run_again(tmp_path, monkeypatch):
    asked = {"scenarios": "SCARA|ranges 2 mm long", "workers": 1, "records": tmp_path / "runs.jsonl"}
    report = trust.run(True, **asked)
    assert [row[0] for table in report.tables for row in table.rows] == ["SCARA", "ranges 2 mm long"]
    runs = report.values["runs"]
    assert all(run["outcome"] in judging.OUTCOMES for run in runs)
    assert all(run["ratio"] == pytest.approx(run["error"] / run["claimed"]) for run in runs)
    monkeypatch.setattr(trust, "run_one", lambda task: pytest.fail("a run that is on file"))
    assert trust.run(True, **asked).tables == report.tables


def test_names_that_match_nothing_are_an_error():
    with pytest.raises(Exception, match=r"--scenarios nothing: no scenario matches"):
        trust.run(True, scenarios="nothing")
