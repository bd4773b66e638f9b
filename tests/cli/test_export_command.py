"""`boresight export` as people and programs call it."""

import json
from pathlib import Path

import numpy as np
import pytest

from boresight.arm.screws import Screw, Screws
from boresight.files import load_robot
from boresight.report.stored import load_result

FORMATS = ("urdf", "dh", "ur-kinematics", "ur-calibration-conf", "pal", "json")


@pytest.fixture
def result(boresight, example, tmp_path):
    """Calibrates an example and returns its folder."""

    def calibrated(name="urdf-arm"):
        files = example(name)
        said = boresight("calibrate", files.campaign, "--solver", "least-squares", "-o", "result")
        assert said.code == 0, said.err
        return tmp_path / "result"

    return calibrated


def poses(robot, **ends):
    return load_robot(robot, **ends).forward_kinematics(np.random.default_rng(1).uniform(-2.0, 2.0, (20, 6)))


def test_a_urdf_comes_back_to_the_byte(boresight, result):
    folder = result()
    said = boresight("export", folder, "--to", "urdf", "-o", "mine.urdf")
    assert (said.code, said.out) == (0, "")
    assert said.err.endswith("Wrote mine.urdf\n")
    assert (folder.parent / "mine.urdf").read_bytes() == (folder / "robot-calibrated.urdf").read_bytes()


@pytest.mark.parametrize("to", FORMATS)
def test_every_format_is_printed_or_written_alike(boresight, result, to):
    folder = result()
    printed = boresight("export", folder, "--to", to)
    written = boresight("export", folder, "--to", to, "-o", "file")
    assert printed.code == written.code == 0
    assert printed.out.encode() == (folder.parent / "file").read_bytes()


def test_every_form_of_a_urdf_arm_moves_the_same(boresight, result):
    folder = result()
    expected = poses(folder / "robot-calibrated.yaml")
    boresight("export", folder, "--to", "urdf", "-o", "a.urdf")
    boresight("export", folder, "--to", "dh", "-o", "a.yaml")
    boresight("export", folder, "--to", "dh", "--convention", "modified-dh", "-o", "b.yaml")
    for robot, ends in (("a.urdf", {"tip": "ranger"}), ("a.yaml", {}), ("b.yaml", {})):
        np.testing.assert_allclose(poses(robot, **ends), expected, rtol=0, atol=1e-12)
    assert load_robot("b.yaml").convention == "modified-dh"


def test_json_holds_every_form(boresight, result):
    folder = result()
    found = json.loads(boresight("export", folder, "--to", "json").out)
    assert found["schema"] == "boresight-arm/1"
    assert found["accepted"] is True
    (origin, *_) = found["urdf_origins"]
    assert origin["joint"] == "turn"
    assert origin["nominal"]["xyz"] == [0.0, 0.0, 0.35]
    form = found["identified"]["product_of_exponentials"]
    screws = tuple(
        Screw(j["name"], "revolute", tuple(j["w"]), tuple(np.cross(j["w"], j["v"]).tolist()), (-1.0, 1.0))
        for j in form["joints"]
    )
    joints = np.random.default_rng(1).uniform(-2.0, 2.0, (20, 6))
    theirs = Screws("json", screws, np.array(form["home"])).forward_kinematics(joints)
    np.testing.assert_allclose(theirs, poses(folder / "robot-calibrated.yaml"), rtol=0, atol=1e-12)


def test_a_table_becomes_a_urdf_of_its_own(boresight, result):
    folder = result("space-arm-three-planes")
    boresight("export", folder, "--to", "urdf", "-o", "new.urdf")
    np.testing.assert_allclose(poses("new.urdf"), poses(folder / "robot-calibrated.yaml"), rtol=0, atol=1e-12)
    assert "calibrated by Boresight (accepted)" in (folder.parent / "new.urdf").read_text()


def test_pal_deltas_added_to_the_urdf_give_the_calibrated_urdf(boresight, result, tmp_path):
    folder = result()
    text = boresight("export", folder, "--to", "pal").out
    deltas = dict(line.split(": ") for line in text.splitlines() if line.startswith("    "))
    deltas = {key.strip(): float(value) for key, value in deltas.items()}
    origins = {joint["joint"]: joint for joint in json.loads((folder / "result.json").read_text())["urdf"]["origins"]}
    assert len(deltas) == 6 * 7  # six moving joints and the ranger's
    for name in ("turn", "elbow", "ranger_mount"):
        was, now = ([*origins[name][key]["xyz"], *origins[name][key]["rpy"]] for key in ("nominal", "identified"))
        axes = ("dx", "dy", "dz", "droll", "dpitch", "dyaw")
        added = [a + deltas[f"{name}_{axis}"] for a, axis in zip(was, axes, strict=True)]
        assert added == pytest.approx(now, abs=1e-15)


def test_a_table_in_csv(boresight, result):
    folder = result()
    boresight("export", folder, "--to", "dh", "-o", "table.csv")
    header, first, *_ = (folder.parent / "table.csv").read_text().splitlines()
    assert header == "joint,type,theta_rad,d_m,a_m,alpha_rad,beta_rad"
    assert first.startswith("turn,revolute,")


def test_another_makers_block_has_the_urdfs_own_origins(boresight, result):
    folder = result()
    said = boresight("export", folder, "--to", "ur-kinematics")
    assert "  elbow:\n    x: " in said.out
    assert said.err.startswith("The fixed joint ranger_mount is new too, and not in this format: xyz [0.0599")


def test_nothing_is_overwritten_unasked(boresight, result):
    folder = result()
    (folder.parent / "mine").write_text("mine")
    said = boresight("export", folder, "--to", "dh", "-o", "mine")
    assert (said.code, (folder.parent / "mine").read_text()) == (1, "mine")
    assert said.err == "Error: mine: is there already; nothing is overwritten without --overwrite\n"
    assert boresight("export", folder, "--to", "dh", "-o", "mine", "--overwrite").code == 0
    assert (folder.parent / "mine").read_text().startswith("# urdf-arm, calibrated by Boresight")


def test_a_rejected_result_is_exported_only_when_told_to(boresight, one_plane, tmp_path):
    one_plane.shuffle_ranges()
    assert boresight("calibrate", one_plane.campaign, "--solver", "least-squares", "-o", "bad").code == 2
    said = boresight("export", "bad", "--to", "dh")
    assert (said.code, said.out) == (1, "")
    assert said.err.startswith("Error: bad: this result was rejected. ")
    assert said.err.endswith("To export it all the same, add --even-if-rejected\n")
    said = boresight("export", "bad", "--to", "dh", "--even-if-rejected")
    assert said.code == 0
    assert "(REJECTED: do not use it for work)" in said.out.splitlines()[0]
    assert said.err == "Warning: bad was rejected; do not use this arm for work.\n"


def test_what_a_format_cannot_hold_is_told(boresight, result):
    folder = result("space-arm-three-planes")
    said = boresight("export", folder, "--to", "pal")
    assert said.code == 1
    assert "this format holds changes of a URDF's origins, and the arm came as a table" in said.err
    said = boresight("export", folder, "--to", "urdf", "--convention", "modified-dh")
    assert said.err == "Error: --convention: it is for --to dh, and this is --to urdf\n"


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        (None, None, "holds no result.json; expected the folder that boresight calibrate wrote"),
        ("result.json", "{", "result.json: not valid JSON"),
        ("result.json", "[]", "result.json: schema nothing; expected boresight-result/1"),
        ("result.json", '{"schema": "boresight-result/9"}', "schema 'boresight-result/9'; expected boresight-result/1"),
        (
            "result.json",
            '{"schema": "boresight-result/1"}',
            "result.json: not a result of this version of Boresight: name is missing",
        ),
    ],
)
def test_a_folder_that_is_no_result_is_told(boresight, tmp_path, name, content, said):
    (tmp_path / "folder").mkdir()
    if name:
        (tmp_path / "folder" / name).write_text(content)
    done = boresight("export", "folder", "--to", "json")
    assert done.code == 1
    assert said in done.err


def test_a_result_without_a_urdf_leaves_none_of_an_earlier_one(boresight, result, example):
    folder = result()
    assert (folder / "robot-calibrated.urdf").exists()
    boresight("calibrate", example("flat-plane").campaign, "--solver", "least-squares", "-o", folder)
    assert not (folder / "robot-calibrated.urdf").exists()


@pytest.fixture
def bent(boresight, example):
    """The result of an arm that gives way under gravity."""
    assert boresight("calibrate", example("panda").campaign, "-o", "bent", "--generations", 5).code == 0
    return load_result(Path("bent"))


def test_what_turns_joints_beside_their_readings_is_exported_or_said_to_be_missing(boresight, bent):
    assert bent.identified.is_bent
    assert not bent.nominal.is_bent
    whole = boresight("export", "bent", "--to", "dh")
    assert "sag:" in whole.out
    assert "geometry alone" not in whole.err
    frames = json.loads(boresight("export", "bent", "--to", "json").out)["frames"]
    assert "`base` was estimated too and is not in this format: it stands in the world at xyz" in whole.err
    assert frames["base"]["stated"] is None
    assert json.loads(boresight("export", "bent", "--to", "json").out)["beyond_geometry"]["joints"]["panda_joint2"]
    for to in ("urdf", "dh --convention standard-dh"):
        said = boresight("export", "bent", "--to", *to.split())
        assert said.code == 0
        assert "This format holds the geometry alone" in said.err
        assert "sag:" not in said.out


def test_a_bent_arm_exported_without_its_bends_moves_as_the_rigid_one(boresight, bent):
    boresight("export", "bent", "--to", "dh", "--convention", "standard-dh", "-o", "rigid.yaml")
    joints = np.random.default_rng(0).uniform(-1.5, -0.2, (50, 7))
    exported = load_robot("rigid.yaml").forward_kinematics(joints)
    assert np.abs(exported - bent.identified.rigid.forward_kinematics(joints)).max() < 1e-11
