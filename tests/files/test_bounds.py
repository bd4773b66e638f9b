"""Sizes are bounded before anything is built: what no campaign has is told in one sentence, and at once."""

import time

import pytest

from boresight.errors import InputError
from boresight.files import load_robot, load_study
from boresight.files.campaigns import load_campaign

STUDY = """\
seeds: 2
robot: {catalogue: space-arm}
sensor: {type: laser_ranger, noise_std: 0.0002}
targets:
  deck: {type: plane, normal: [0, 1, 4.6], offset: -0.69}
"""


@pytest.fixture(autouse=True)
def soon():
    began = time.perf_counter()
    yield
    assert time.perf_counter() - began < 10.0


def refusal(function, *arguments, **options):
    with pytest.raises(InputError) as caught:
        function(*arguments, **options)
    (problem,) = caught.value.problems
    return problem


def joints(count):
    return "name: snake\njoints:\n" + "".join(f"- {{name: q{place}, a: 0.1, alpha: 1.5}}\n" for place in range(count))


@pytest.mark.parametrize("count", [65, 1000, 20_000])
def test_joints_of_a_table(folder, count):
    said = refusal(load_robot, folder.write(robot=joints(count)).path / "robot.yaml")
    assert said.endswith("expected a list of at most 64")


def test_a_snake_is_read(folder):
    assert len(load_robot(folder.write(robot=joints(64)).path / "robot.yaml").joints) == 64


def test_joints_of_a_urdf(tmp_path):
    links = "".join(f'<link name="l{k}"/>' for k in range(101))
    chain = "".join(
        f'<joint name="j{k}" type="continuous"><parent link="l{k}"/><child link="l{k + 1}"/></joint>'
        for k in range(100)
    )
    (tmp_path / "a.urdf").write_text(f'<robot name="r">{links}{chain}</robot>')
    assert "more than 64 joints move between l0 and l100" in refusal(load_robot, tmp_path / "a.urdf")


def test_ways_to_take_a_row(folder):
    sensors = "".join(f"  s{k}: {{type: laser_ranger, noise_std: 0.1}}\n" for k in range(30))
    markers = "".join(f"  m{k}: {{}}\n" for k in range(300))
    targets = "".join(f"  t{k}: {{type: plane, normal: [0, 0, 1], offset: 1}}\n" for k in range(300))
    text = f"robot: robot.yaml\nsensors:\n{sensors}markers:\n{markers}targets:\n{targets}"
    folder.write(campaign=text)
    assert refusal(load_campaign, "campaign.yaml") == (
        "campaign.yaml: 30 sensors, 300 markers and 300 targets combine in 2,700,000 ways; expected at most "
        "20,000: leave out what no row uses"
    )


@pytest.mark.parametrize("header", ["j1,j2,range", "j1", "x"])
def test_columns_of_a_table(folder, header):
    folder.write(observations=",".join([header] * 200_000) + "\n")
    count = 200_000 * len(header.split(","))
    said = folder.problem()
    assert said in (
        f"observations.csv, line 1: {count:,} columns; expected at most 10,000",
        "observations.csv, line 1: more than 1,000,000 characters; expected rows of numbers, a line each",
    )


def test_a_line_that_never_ends(folder):
    folder.write(observations="j1,j2,range\n" + "1" * 30_000_000)
    assert folder.problem() == (
        "observations.csv, line 2: more than 1,000,000 characters; expected rows of numbers, a line each"
    )


def test_seeds_of_a_study(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.yaml").write_text(STUDY.replace("seeds: 2", "seeds: 10000000"))
    assert refusal(load_study, "study.yaml") == (
        "study.yaml, line 1: seeds: 1 points with 10,000,000 seeds each are 10,000,000 campaigns; expected at most "
        "2,000,000"
    )
    (tmp_path / "study.yaml").write_text(STUDY)
    assert "expected at most 2,000,000" in refusal(load_study, "study.yaml", seeds=9_000_000)


@pytest.mark.parametrize("size", ["0", "0.0", "1e-300", "-1"])
def test_errors_of_no_size(tmp_path, monkeypatch, size):
    monkeypatch.chdir(tmp_path)
    for text in (f"error_size: {size}\n", f"vary: {{error_size: [1, {size}]}}\n"):
        (tmp_path / "study.yaml").write_text(STUDY + text)
        assert "error_size" in refusal(load_study, "study.yaml")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("repeats: 4", f"repeats: {'9' * 400}"),
        ("noise_std: 0.0002", "noise_std: 1e300"),
        ("within: 0.025", f"within: {'9' * 400}"),
        ("offset: -0.69", "offset: 1e300"),
        ("normal: [0, 1, 4.6]", "normal: [1e308, 1e308, 1e308]"),
        ("targets:", "mount: {xyz: [1e300, 0, 0]}\ntargets:"),
        ("targets:", "base: {rpy: [1e300, 0, 0]}\ntargets:"),
        ("targets:", "joint_noise_std: 1e300\ntargets:"),
        ("targets:", f"gravity: [{'9' * 400}, 0, 0]\ntargets:"),
        ("targets:", 'gravity: "\\UFFFFFFFF"\ntargets:'),
    ],
)
def test_numbers_beyond_all_measure(folder, campaign_with, old, new):
    folder.write(campaign=campaign_with((old, new)))
    assert folder.problems()
