"""study.yaml: what it means, and what is said of one that means nothing."""

import shutil
from pathlib import Path

import pytest

from boresight.errors import InputError
from boresight.files import load_study

ROOT = Path(__file__).parents[2]
SHIPPED = sorted((ROOT / "examples" / "studies").glob("*.yaml"))

STUDY = """\
name: mine
seeds: 12
units: {length: mm, angle: deg}
robot: {catalogue: space-arm}
sensor: {type: laser_ranger, noise_std: 0.2, repeats: 10}
targets:
  deck: {type: plane, normal: [0, 1, 4.6], offset: -690}
  wall: {type: plane, normal: [-1, 0.15, 0.2], offset: 1600}
estimate:
  - {parameters: ["*.theta"], within: 1}
  - {parameters: ["*.a"], within: 10}
fixed: [j1.theta]
rows: 40
vary:
  planes: [1, 2, [wall]]
  noise_std: [0.2, 1]
"""


@pytest.fixture
def load(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def loaded(*pairs, **options):
        text = STUDY
        for old, new in pairs:
            assert old in text
            text = text.replace(old, new)
        Path("study.yaml").write_text(text)
        return load_study("study.yaml", **options)

    return loaded


@pytest.fixture
def problems(load):
    def found(*pairs):
        with pytest.raises(InputError) as caught:
            load(*pairs)
        return caught.value.problems

    return found


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_studies_load_under_their_files_name(path):
    study = load_study(path)
    assert study.name == path.stem
    assert len(study.varied) >= 2


def test_there_are_three_shipped_studies():
    assert [path.stem for path in SHIPPED] == ["better-ranger", "how-many-readings", "one-plane-or-three"]


def test_a_study_is_read_in_metres_and_radians(load):
    study = load()
    assert (study.name, study.seeds, study.varied) == ("mine", 12, ("planes", "noise_std"))
    assert len(study.points) == 6
    first = study.points[0]
    assert first.settings.noise_std == pytest.approx(2e-4)
    assert first.settings.rows == 40
    within = {f.parameter: f.within for f in first.freedoms}
    assert within["j2.theta"] == pytest.approx(0.0174532925)
    assert within["j2.a"] == pytest.approx(0.010)
    assert "j1.theta" not in within
    assert [each.label("planes") for each in study.points[::2]] == ["1", "2", "wall"]
    assert list(study.points[4].cell.targets) == ["wall"]


def test_seeds_may_be_asked_for_otherwise(load):
    assert load(seeds=3).seeds == 3


def test_units_change_no_outcome(load):
    metres = load(
        ("length: mm, angle: deg", "length: m, angle: rad"),
        ("0.2, repeats", "0.0002, repeats"),
        ("-690", "-0.69"),
        ("1600", "1.6"),
        ("within: 10", "within: 0.01"),
        ("within: 1}", "within: 0.017453292519943295}"),
        ("[0.2, 1]", "[0.0002, 0.001]"),
    )
    for one, other in zip(metres.points, load().points, strict=True):
        assert one.settings.noise_std == pytest.approx(other.settings.noise_std, rel=1e-12)
        assert [f.within for f in one.freedoms] == pytest.approx([f.within for f in other.freedoms], rel=1e-12)
        first, second = (next(iter(each.cell.targets.values())) for each in (one, other))
        assert first.offset == pytest.approx(second.offset)


def test_without_estimate_every_link_parameter_is_as_wrong_as_usual(load):
    (start, end) = STUDY.index("estimate"), STUDY.index("fixed")
    point = load((STUDY[start:end], "")).points[0]
    within = {f.parameter: f.within for f in point.freedoms}
    assert len(within) == 23  # 24 link parameters, joint 1's theta held
    assert within["j2.beta"] == pytest.approx(0.01)
    assert within["j1.d"] == pytest.approx(0.004)


def test_robots_may_be_varied(load):
    study = load(
        ("fixed: [j1.theta]\n", ""),
        ("robot: {catalogue: space-arm}\n", ""),
        ("vary:\n", "vary:\n  robot: [{catalogue: ur10}, {catalogue: panda}]\n"),
    )
    assert study.varied == ("robot", "planes", "noise_std")
    assert {len(each.cell.arm.joints) for each in study.points} == {6, 7}
    assert all(len(each.freedoms) == 2 * len(each.cell.arm.joints) for each in study.points)


def test_a_pattern_need_not_mean_something_to_every_robot(load):
    robots = "vary:\n  robot: [{catalogue: space-arm}, {catalogue: ur10}]\n"
    held = {
        each.label("robot"): {"j1.theta", "shoulder_pan_joint.theta"} - {f.parameter for f in each.freedoms}
        for each in load(("robot: {catalogue: space-arm}\n", ""), ("vary:\n", robots)).points
    }
    assert held["ur10"] == {"j1.theta"}
    assert held["space-arm"] == {"j1.theta", "shoulder_pan_joint.theta"}


def test_held_parameters_may_be_varied_and_add_up(load):
    study = load(("  planes: [1, 2, [wall]]\n", "  fixed: [[], ['*.a']]\n"))
    free = [{f.parameter for f in each.freedoms} for each in study.points]
    assert [each.label("fixed") for each in study.points[::2]] == ["none", "*.a"]
    assert free[0] - free[2] == {f"j{n}.a" for n in range(1, 7)}
    assert not any("j1.theta" in names for names in free)


def test_a_campaign_may_be_studied_in_its_own_configurations(tmp_path):
    shutil.copytree(ROOT / "examples" / "space-arm-one-plane", tmp_path / "mine")
    (tmp_path / "study.yaml").write_text("seeds: 2\ncampaign: mine/campaign.yaml\nvary: {repeats: [1, 10]}\n")
    study = load_study(tmp_path / "study.yaml")
    assert study.name == "study"
    point = study.points[0]
    assert point.label("rows") == 100
    assert point.bench.joints.shape == (100, 6)
    assert len(point.freedoms) == 25
    (tmp_path / "study.yaml").write_text("seeds: 2\ncampaign: mine/campaign.yaml\nrows: 50\n")
    drawn = load_study(tmp_path / "study.yaml").points[0]
    assert (drawn.bench.joints, drawn.label("rows")) == (None, 50)


def test_a_campaign_of_unknown_frames_cannot_be_studied(tmp_path):
    shutil.copytree(ROOT / "examples" / "ur10-laser-tracker", tmp_path / "mine")
    (tmp_path / "study.yaml").write_text("seeds: 2\ncampaign: mine/campaign.yaml\n")
    with pytest.raises(InputError, match="a study simulates the cell, so it must know its frames"):
        load_study(tmp_path / "study.yaml")


BAD = [
    (
        ("seeds: 12\n", ""),
        "study.yaml, line 1: seeds: this key is missing; expected how many campaigns to simulate of ",
    ),
    (("seeds: 12", "seeds: 0"), "study.yaml, line 2: seeds: got 0; expected a number of at least 1"),
    (("rows: 40", "row: 40"), "study.yaml, line 13: row: unknown key (did you mean rows?); expected one of "),
    (
        ("  noise_std: [0.2, 1]", "  noise: [0.2, 1]"),
        "vary.noise: unknown key (did you mean noise_std?); expected one of ",
    ),
    (("[0.2, 1]", "[]"), "vary.noise_std: got []; expected a list of at least 1"),
    (("[0.2, 1]", "0.2"), "vary.noise_std: got 0.2; expected a list: [first, second]"),
    (("[0.2, 1]", "[0.2, 0.2]"), "vary.noise_std: got [0.2, 0.2]; expected a list without repetitions"),
    (("[0.2, 1]", "[0.2, -1]"), "vary.noise_std[1]: got -1; expected a number above 0"),
    (("[1, 2, [wall]]", "[1, 3]"), "vary.planes[1]: got 3; there are 2 targets: deck, wall"),
    (("[wall]", "[wal]"), "vary.planes[2]: there is no target 'wal' (did you mean wall?); the targets are deck, wall"),
    (("rows: 40", "rows: 40\nplanes: 2"), "expected planes either as one value or under vary, not both"),
    (("rows: 40", "solver: genetic"), "solver: got 'genetic'; expected one of evolution+least-squares, evolution, "),
    (("rows: 40", "strategy: rand/2"), "strategy: got 'rand/2'; expected one of trade-off, "),
    (("rows: 40", "gross_errors: 8"), "gross_errors: got 8; expected a number of at most 0.9"),
    (("robot: {catalogue: space-arm}\n", ""), "expected a robot, such as robot: {catalogue: space-arm}, or a campaign"),
    (("rows: 40", "campaign: c.yaml"), "expected either a campaign, or robot, sensor and targets of the study's own"),
    (("rows: 40", "base: {xyz: unknown}"), "base: got unknown; a study simulates the cell, so it must know its frames"),
    (("fixed: [j1.theta]", 'fixed: ["*"]'), "every parameter is fixed, so there is nothing to calibrate"),
    (("name: mine", "name: a/b"), "name: got 'a/b'; expected a name of visible characters that can be a folder's"),
    (("catalogue: space-arm", "catalogue: space"), "the catalogue has no arm 'space' (did you mean space-arm?)"),
    (('["*.a"]', '["*.b"]'), "estimate[1].parameters[0]: '*.b' is no parameter"),
]


@pytest.mark.parametrize(("pair", "expected"), BAD, ids=lambda given: given if isinstance(given, str) else "")
def test_what_is_wrong_is_told(problems, pair, expected):
    said = problems(pair)
    assert any(expected in problem for problem in said), said


def test_a_robot_that_is_varied_is_told_by_its_place(problems):
    robots = "vary:\n  robot: [{catalogue: ur10}, nope.yaml]\n"
    (said,) = problems(("robot: {catalogue: space-arm}\n", ""), ("vary:\n", robots))
    assert said.startswith("study.yaml, line 14: vary.robot[1]: nope.yaml: there is no such file")


def test_a_grid_beyond_all_measure_is_refused(problems):
    rows = f"[{', '.join(map(str, range(1, 2001)))}]"
    (said,) = problems(("rows: 40\n", ""), ("vary:\n", f"vary:\n  rows: {rows}\n"))
    assert "the grid has 12,000 points; expected at most 10,000" in said
