"""A key that means something only beside another, or only in another kind of block, is refused alone."""

import pytest

from boresight.errors import InputError
from boresight.files.campaigns import load_campaign
from boresight.files.studies import load_study

STUDY = """\
seeds: 2
robot: {catalogue: space-arm}
sensor: {type: laser_ranger, noise_std: 0.0002}
targets:
  deck: {type: plane, normal: [0, 1, 4.6], offset: -0.69}
"""


@pytest.mark.parametrize("key", ["range: /ranger", "joints: /j", "time_offset: 0.1", "settle: 0.5", "targets: /t"])
@pytest.mark.parametrize("named", ["observations", "validation"])
def test_keys_of_a_bag_beside_a_csv_file(folder, campaign_with, key, named):
    text = campaign_with(("observations: observations.csv\n", f"{named}: {{file: observations.csv, {key}}}\n"))
    folder.write(campaign=text)
    line = 1 + text.splitlines().index(f"{named}: {{file: observations.csv, {key}}}")
    assert folder.problem() == (
        f"campaign.yaml, line {line}: {named}: {key.split(':')[0]} beside 'observations.csv', which is no ROS bag; "
        "these keys choose and cut what a bag holds: leave them out, or name a bag"
    )


def test_a_file_in_a_block_of_its_own_is_read(folder, campaign_with):
    folder.write(campaign=campaign_with(("observations: observations.csv", "observations: {file: observations.csv}")))
    assert len(folder.load().readings) == 2


def test_the_standard_deviation_of_a_position_that_is_unknown(folder, campaign_with):
    anchor = "targets:\n  anchor: {type: point, position: unknown, position_std: 0.1}\n"
    folder.write(campaign=campaign_with(("targets:\n", anchor)))
    assert folder.problem() == (
        "campaign.yaml, line 4: targets.anchor: expected no position_std beside position: unknown; state a position "
        "and its position_std, or neither"
    )


def test_gravitys_terms_where_there_is_no_gravity(folder, campaign_with):
    folder.write(campaign=campaign_with(("targets:", "gravity: off\nbeyond: [gravity]\ntargets:")))
    assert folder.problem() == (
        "campaign.yaml, line 1: expected beyond without gravity beside gravity: off, or a direction of gravity"
    )
    folder.write(campaign=campaign_with(("targets:", "gravity: off\nbeyond: [harmonics]\ntargets:")))
    assert load_campaign("campaign.yaml").beyond == ("harmonics",)


@pytest.fixture
def study(tmp_path, monkeypatch):
    """Returns the fault of a study with a text swapped."""
    monkeypatch.chdir(tmp_path)

    def fault(old, new):
        assert old in STUDY
        (tmp_path / "study.yaml").write_text(STUDY.replace(old, new))
        with pytest.raises(InputError) as caught:
            load_study("study.yaml")
        (problem,) = caught.value.problems
        return problem

    return fault


@pytest.mark.parametrize("key", ["strategy: rand/1", "population: 50", "generations: 9", "patience: 3"])
def test_evolutions_settings_beside_least_squares(study, key):
    name = key.split(":")[0]
    if name == "strategy":
        key = "strategy: trade-off"
    said = (
        f"study.yaml, line 1: expected a solver with evolution beside {name}, which least squares does not have: "
        "solver: evolution+least-squares"
    )
    assert study("seeds: 2", f"seeds: 2\n{key}") == said
    assert study("seeds: 2", f"seeds: 2\nsolver: least-squares\n{key}") == said


def test_evolutions_settings_beside_evolution(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for solver in ("solver: evolution", "vary: {solver: [least-squares, evolution+least-squares]}"):
        (tmp_path / "study.yaml").write_text(STUDY + f"population: 50\n{solver}\n")
        assert load_study("study.yaml").points


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ("noise_std: 0.0002", "noise_std: 0.0002, bias_std: 0.001", "bias_std"),
        ("noise_std: 0.0002", "noise_std: 0.0002, scale_std: 0.001", "scale_std"),
        ("noise_std: 0.0002", "noise_std: 0.0002, offset_per: session", "offset_per"),
        ("offset: -0.69", "offset: -0.69, flatness: 0.001", "flatness"),
        ("offset: -0.69", "offset: -0.69, normal_std: 0.001", "normal_std"),
        ("targets:", "base: {xyz_std: 0.001}\ntargets:", "xyz_std"),
        ("targets:", "mount: {rpy_std: 0.001}\ntargets:", "rpy_std"),
    ],
)
def test_what_a_study_does_not_heed(study, old, new, key):
    assert f"expected no {key} in a study, whose errors are those of estimate" in study(old, new)
