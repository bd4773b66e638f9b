"""`boresight compensate` as a user meets it."""

import csv
import json

import numpy as np
import pytest
from example_files import EXAMPLES


@pytest.fixture
def calibrated(boresight, one_plane, tmp_path):
    assert boresight("calibrate", one_plane.campaign, "-o", "result").code == 0
    rows = (EXAMPLES / "space-arm-one-plane" / "validation.csv").read_text().splitlines()[:8]
    (tmp_path / "program.csv").write_text("".join(",".join(row.split(",")[:6]) + "\n" for row in rows))
    return tmp_path


def read(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def test_a_program_becomes_commands(boresight, calibrated):
    said = boresight("compensate", "result", "program.csv", "-o", "commands.csv")
    assert said.code == 0
    assert "7 poses: 7 reached" in said.out.replace("\n", " ")
    rows = read(calibrated / "commands.csv")
    assert [row["reached"] for row in rows] == ["yes"] * 6 + ["near-singular"] or len(rows) == 7
    before = read(calibrated / "program.csv")
    moved = [abs(float(a["j2"]) - float(b["j2"])) for a, b in zip(rows, before, strict=True)]
    assert 0.0 < max(moved) < 0.2


def test_degrees_and_millimetres_are_the_same_commands(boresight, calibrated):
    boresight("compensate", "result", "program.csv", "-o", "radians.csv")
    radians = read(calibrated / "radians.csv")
    joints = [f"j{n}" for n in range(1, 7)]
    text = ",".join(joints) + "\n"
    for row in read(calibrated / "program.csv"):
        text += ",".join(repr(float(np.degrees(float(row[joint])))) for joint in joints) + "\n"
    (calibrated / "degrees.csv").write_text(text)
    boresight("compensate", "result", "degrees.csv", "-o", "in-degrees.csv", "--angle", "deg", "--length", "mm")
    for one, other in zip(radians, read(calibrated / "in-degrees.csv"), strict=True):
        assert np.radians(float(other["j4"])) == pytest.approx(float(one["j4"]), abs=1e-9)


def test_controller_poses_come_with_quaternions(boresight, calibrated):
    boresight("compensate", "result", "program.csv", "-o", "poses.csv", "--controller-poses")
    row = read(calibrated / "poses.csv")[0]
    assert sum(float(row[q]) ** 2 for q in ("qw", "qx", "qy", "qz")) == pytest.approx(1.0)


def test_poses_with_labels_of_their_own_keep_them(boresight, calibrated):
    (calibrated / "poses.csv").write_text("label,x,y,z\nnear,0.4,0.1,0.5\nfar,5,5,5\n")
    said = boresight("compensate", "result", "poses.csv", "--json")
    summary = json.loads(said.out)
    assert said.code == 2
    assert summary["not_reached_rows"] == [2]
    rows = read(calibrated / "poses-compensated.csv")
    assert [row["label"] for row in rows] == ["near", "far"]
    assert rows[1]["reached"] in ("no", "at-limit")


def test_nothing_is_overwritten_unasked(boresight, calibrated):
    (calibrated / "mine.csv").write_text("precious")
    said = boresight("compensate", "result", "program.csv", "-o", "mine.csv")
    assert said.code == 1
    assert "is there already" in said.err
    assert (calibrated / "mine.csv").read_text() == "precious"
    assert boresight("compensate", "result", "program.csv", "-o", "mine.csv", "--overwrite").code == 0
    assert boresight("compensate", "result", "program.csv", "-o", "program.csv", "--overwrite").code == 1


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("j1,j2\n1,2\n", "there is no column j3, j4, j5, j6"),
        ("a,b\n1,2\n", "expected the joints j1, j2"),
        ("x,y,z\n1,2\n", "line 2: 2 cells; expected 3"),
        ("x,y,z\n1,2,inf\n", "line 2: z: got 'inf'; expected a finite number"),
        ("x,y,z,qw,qx,qy,qz\n1,2,3,1,1,1,1\n", "line 2: the quaternion's length is 2; expected 1"),
        ("qw,qx,qy,qz\n1,0,0,0\n", "orientations but no positions"),
        ("x,y,z\n", "there are no poses in it"),
    ],
)
def test_faults_of_the_poses_are_told(boresight, calibrated, text, message):
    (calibrated / "bad.csv").write_text(text)
    said = boresight("compensate", "result", "bad.csv")
    assert said.code == 1
    assert message in said.err


def test_a_folder_that_is_no_result_is_refused(boresight, calibrated):
    said = boresight("compensate", "resul", "program.csv")
    assert said.code == 1
    assert "did you mean result?" in said.err
    document = json.loads((calibrated / "result" / "result.json").read_text())
    document["verdict"]["accepted"] = False
    (calibrated / "result" / "result.json").write_text(json.dumps(document))
    said = boresight("compensate", "result", "program.csv")
    assert said.code == 1
    assert "rejected" in said.err
    (calibrated / "result" / "result.json").write_text("[]")
    assert "expected boresight-result" in boresight("compensate", "result", "program.csv").err


def test_rotation_vectors_are_the_same_orientations_as_quaternions(boresight, calibrated):
    turn = np.array([0.3, -0.2, 0.5])
    angle = np.linalg.norm(turn)
    q = np.array([np.cos(angle / 2), *(np.sin(angle / 2) * turn / angle)])
    (calibrated / "vectors.csv").write_text("x,y,z,rx,ry,rz\n0.4,0.1,0.5,0.3,-0.2,0.5\n")
    (calibrated / "quaternions.csv").write_text(
        "x,y,z,qw,qx,qy,qz\n0.4,0.1,0.5," + ",".join(map(repr, q.tolist())) + "\n"
    )
    rows = []
    for name in ("vectors", "quaternions"):
        assert boresight("compensate", "result", f"{name}.csv", "-o", f"{name}-out.csv").code == 0
        rows.append([float(read(calibrated / f"{name}-out.csv")[0][f"j{n}"]) for n in range(1, 7)])
    np.testing.assert_allclose(rows[0], rows[1], atol=1e-7)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            "j1,j2,j3,j4,j5,j6\n0,-90,90,-90,-90,0\n",
            "too much for radians; if the file is in degrees, say --angle",
        ),
        ("x,y,z\n400,200,300\n", "if they are in mm, say --length mm"),
        ("x,y,z,rx,ry,rz\n0.4,0.2,0.3,0,180,0\n", "up to 180 rad long, more than a turn; if it is in degrees"),
        ("x,y,z,roll,pitch,yaw\n0.4,0.2,0.3,0,1,0\n", "'roll', 'pitch', 'yaw' looks like an orientation"),
        ("x,y,z,A,B,C\n0.4,0.2,0.3,0,1,0\n", "expected a quaternion qw, qx, qy, qz, or a rotation vector rx, ry, rz"),
        ("x,y,z,rx,ry,rz,qw,qx,qy,qz\n0.4,0.2,0.3,0,1,0,1,0,0,0\n", "expected one or the other"),
        ("x,y,z\n0.4,0.2,1_0\n", "z: got '1_0'; expected a finite number"),
    ],
)
def test_what_cannot_be_meant_so_is_refused(boresight, calibrated, text, told):
    (calibrated / "poses.csv").write_text(text)
    said = boresight("compensate", "result", "poses.csv", "-o", "out.csv")
    assert (said.code, said.out) == (1, "")
    assert told in said.err
    assert not (calibrated / "out.csv").exists()


def test_columns_that_are_handed_on_and_orientations_left_free_are_told(boresight, calibrated):
    (calibrated / "poses.csv").write_text("X;Y;Z;note\n0,4;0,1;0,5;here\n")
    said = " ".join(boresight("compensate", "result", "poses.csv", "-o", "out.csv").out.split())
    assert (
        "separated by semicolons; columns are read as the names that are known: X as x, Y as y, Z as z; numbers" in said
    )
    assert "there are positions and no orientations, which are left free" in said
    assert "columns that mean nothing here are handed on as they are: note" in said
    assert read(calibrated / "out.csv")[0]["note"] == "here"
