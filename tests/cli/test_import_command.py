"""`boresight import`: observations out of ROS bags and of other tools' CSV files."""

import json
import shutil

import numpy as np
import pytest
from example_files import EXAMPLES

import ros_bags as bags
from boresight.files import load_campaign, load_robot

QUICK = ("--solver", "least-squares")


@pytest.fixture
def run(tmp_path):
    """A bag in the folder, and where its arm stopped."""
    script, at = bags.run(8, lost=range(10, 30))
    script.write(tmp_path / "run")
    return at


def test_a_bag_becomes_observations(boresight, run, tmp_path):
    said = boresight("import", "run")
    assert (said.code, said.err) == (0, "")
    assert said.out.splitlines()[:2] == [
        "8 rows out of run.",
        "  1520 joint states, 760 readings: joints /joint_states, range /ranger.",
    ]
    assert "  Readings without a value: 20 (+Inf: nothing in range)." in said.out.splitlines()
    assert said.out.splitlines()[-1] == "Files: observations.csv"
    table = np.genfromtxt(tmp_path / "observations.csv", delimiter=",", names=True, skip_header=1)
    np.testing.assert_allclose(np.stack([table["j1"], table["j2"]], axis=1), run, atol=1e-5)


def test_json_says_the_same_to_programs(boresight, run):
    said = boresight("import", "run", "-o", "mine.csv", "--json", "--target", "deck")
    found = json.loads(said.out)
    assert found["rows"] == 8
    assert found["joints"] == ["j1", "j2"]
    assert found["topics"]["/ranger"] == {"type": "sensor_msgs/msg/Range", "messages": 760}
    assert found["set_aside"] == {"+Inf: nothing in range": 20}
    assert found["scatter_m"][0] == pytest.approx(2e-4, rel=0.1)
    assert found["output"] == "mine.csv"


def test_nothing_is_overwritten_without_a_word(boresight, run, tmp_path):
    (tmp_path / "observations.csv").write_text("mine")
    said = boresight("import", "run")
    assert (said.code, said.err) == (
        1,
        "Error: observations.csv: is there already; name another file with -o, or say --overwrite\n",
    )
    assert (tmp_path / "observations.csv").read_text() == "mine"
    assert boresight("import", "run", "--overwrite").code == 0


def test_a_truncated_bag_gives_its_rows_and_a_warning(boresight, run, tmp_path):
    file = tmp_path / "run" / "run.mcap"
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    said = boresight("import", "run/run.mcap")
    assert said.code == 0
    assert "Warning: run/run.mcap: it ends in the middle of a chunk; " in said.out


def test_a_bag_whose_topics_are_not_clear_is_an_error_in_one_line(boresight, tmp_path):
    script, _ = bags.run(3)
    script.say(bags.T0, "/other", bags.range_message(bags.T0, 1.0))
    script.write(tmp_path / "run")
    said = boresight("import", "run")
    assert said.code == 1
    assert said.err.startswith(
        "Error: run: there are 2 topics of sensor_msgs/msg/Range; name one of them: range: /other"
    )
    assert boresight("import", "run", "--range", "/ranger").code == 0


def test_the_shipped_bag_becomes_the_campaigns_own_readings(boresight, tmp_path):
    shutil.copytree(EXAMPLES / "ros-bag", tmp_path / "mine")
    said = boresight("import", "mine/run", "--robot", "mine/arm.urdf", "-o", "mine/observations.csv")
    assert said.code == 0
    out_of_the_bag = load_campaign(tmp_path / "mine" / "campaign.yaml").readings
    text = (tmp_path / "mine" / "campaign.yaml").read_text()
    block = "{bag: run, joints: /joint_states, range: /ranger/range, targets: /ranger/target}"
    assert block in text
    (tmp_path / "mine" / "campaign.yaml").write_text(text.replace(block, "observations.csv"))
    imported = load_campaign(tmp_path / "mine" / "campaign.yaml").readings
    for part in ("joints", "values", "std", "target", "line"):
        np.testing.assert_array_equal(getattr(imported, part), getattr(out_of_the_bag, part))


def test_a_campaign_of_a_bag_can_be_rehearsed(boresight, tmp_path):
    shutil.copytree(EXAMPLES / "ros-bag", tmp_path / "mine")
    assert boresight("simulate", "mine/campaign.yaml", "-o", "rehearsal").code == 0
    assert (tmp_path / "rehearsal" / "observations.csv").exists()
    assert boresight("calibrate", "rehearsal/campaign.yaml", *QUICK).code == 0


def test_a_campaign_of_a_bag_can_be_inspected(boresight):
    assert boresight("inspect", EXAMPLES / "ros-bag" / "campaign.yaml").code == 0


def test_figarohs_file_becomes_observations(boresight, tmp_path):
    (tmp_path / "figaroh.csv").write_text("x1,y1,z1,a,b\n0.1,0.2,0.3,1.1,1.2\n")
    said = boresight("import", "figaroh.csv")
    assert said.code == 0
    assert (tmp_path / "observations.csv").read_text() == "x,y,z,a,b\n0.1,0.2,0.3,1.1,1.2\n"
    assert said.out.splitlines() == ["1 row out of figaroh.csv.", "  The file is FIGAROH's.", "Files: observations.csv"]


def test_leicas_export_needs_joints_and_takes_them_from_a_file(boresight, tmp_path):
    (tmp_path / "leica.csv").write_text("X [mm],Y [mm],Z [mm],U(95) [mm]\n100,200,300,0.02\n")
    said = boresight("import", "leica.csv")
    assert said.code == 1
    assert said.err.startswith("Error: leica.csv: a tracker's export has no joints; name their file: --joint-file")
    (tmp_path / "joints.csv").write_text("a,b\n1.1,1.2\n")
    said = boresight("import", "leica.csv", "--joint-file", "joints.csv")
    assert (said.code, said.err) == (0, "")
    assert (tmp_path / "observations.csv").read_text() == "a,b,x,y,z,std\n1.1,1.2,0.1,0.2,0.3,1e-05\n"


def test_a_file_that_is_in_no_dialect_is_refused(boresight, tmp_path):
    (tmp_path / "mine.csv").write_text("j1,range\n1,2\n")
    said = boresight("import", "mine.csv")
    assert said.code == 1
    assert "the columns are neither FIGAROH's (x1, y1, z1, joints) nor Leica's" in said.err


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--still-speed", "0"], "Error: --still-speed: expected a speed above 0, got 0\n"),
        (["--still-time", "nan"], "Error: --still-time: expected seconds above 0, got nan\n"),
        (["--settle", "-1"], "Error: --settle: expected seconds, 0 or more, got -1\n"),
        (["--time-offset", "inf"], "Error: --time-offset: expected seconds, got inf\n"),
    ],
)
def test_an_option_that_makes_no_sense_is_refused(boresight, run, options, told):
    said = boresight("import", "run", *options)
    assert (said.code, said.err) == (1, told)


@pytest.mark.parametrize("name", ["nothing", "nothing.mcap", "nothing.csv"])
def test_a_source_that_is_not_there(boresight, name):
    said = boresight("import", name)
    assert said.code == 1
    assert f"{name}: there is no such file" in said.err


def test_the_robot_of_the_shipped_bag_loads():
    assert load_robot(EXAMPLES / "ros-bag" / "arm.urdf").joint_names == ("j1", "j2", "j3", "j4", "j5", "j6")


TWO_TIPS = (
    '<link name="camera"/><joint name="of_camera" type="fixed"><parent link="base_link"/><child link="camera"/></joint>'
)


def test_a_urdf_with_several_tips_gives_the_joints_that_the_log_has(boresight, tmp_path):
    text = (EXAMPLES / "ros-bag" / "arm.urdf").read_text()
    (tmp_path / "tips.urdf").write_text(text.replace("</robot>", TWO_TIPS + "</robot>"))
    source = EXAMPLES / "ros-bag" / "run"
    headers = []
    for options in (["--robot", "tips.urdf"], ["--robot", "tips.urdf", "--tip", "ranger"]):
        assert boresight("import", source, *options, "-o", "out.csv", "--overwrite").code == 0
        headers.append((tmp_path / "out.csv").read_text().splitlines()[1])
    assert headers[0] == headers[1]
    assert headers[0].startswith("j1,j2,j3,j4,j5,j6,range")


def test_a_campaign_names_the_joints_too(boresight, tmp_path):
    campaign = EXAMPLES / "ros-bag" / "campaign.yaml"
    assert boresight("import", EXAMPLES / "ros-bag" / "run", "--campaign", campaign, "-o", "out.csv").code == 0
    assert "gripper" not in (tmp_path / "out.csv").read_text()


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--tip", "ranger"], "--base and --tip are links of a URDF; name it: --robot arm.urdf"),
        (["--campaign", "c.yaml", "--tip", "x"], "--campaign names the robot; leave out --robot, --base and --tip"),
    ],
)
def test_options_that_exclude_each_other_are_told(boresight, options, told):
    said = boresight("import", EXAMPLES / "ros-bag" / "run", *options)
    assert (said.code, said.err) == (1, f"Error: {told}\n")


def test_figarohs_own_time_column_and_joints_of_others_need_nothing(boresight, tmp_path):
    rows = "".join(f"{k},0.1,0.2,{0.1 * k},{0.1 * k},{0.2 * k},7\n" for k in range(4))
    (tmp_path / "measured.csv").write_text("t,x1,y1,z1,j1,j2,head\n" + rows)
    (tmp_path / "robot.yaml").write_text("name: two\njoints: [{name: j1, d: 0.3, alpha: 1.57}, {name: j2, a: 0.4}]\n")
    said = boresight("import", "measured.csv", "--robot", "robot.yaml")
    assert said.code == 0
    assert (tmp_path / "observations.csv").read_text().splitlines()[0] == "time,x,y,z,j1,j2"
    assert "columns without a meaning here: head" in said.out
