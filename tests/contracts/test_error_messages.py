"""The texts of the errors that people meet most, pinned."""

import pytest

from boresight.arm import catalogue
from boresight.errors import InputError
from boresight.files import load_campaign

ROBOT = "name: two\njoints:\n  - {name: j1, d: 0.3, alpha: -1.5}\n  - {name: j2, a: 0.4}\n"
CAMPAIGN = """\
robot: robot.yaml
sensor: {type: laser_ranger, noise_std: 0.0002}
targets:
  deck: {type: plane, normal: [0, 1, 4.6], offset: -0.69}
observations: observations.csv
"""
OBSERVATIONS = "j1,j2,range\n0.1,0.2,0.3\n0.2,0.3,0.4\n"

PINNED = [
    (
        "campaign.yaml",
        ("deck: {type: plane", "deck: {typ: plane"),
        [
            "campaign.yaml, line 4: targets.deck.type: this key is missing; expected plane or point",
            "campaign.yaml, line 4: targets.deck.typ: unknown key (did you mean type?); "
            "expected one of type, normal, offset, normal_std, offset_std, flatness",
        ],
    ),
    (
        "campaign.yaml",
        ("laser_ranger", "laser_rangr"),
        [
            "campaign.yaml, line 2: sensor.type: got 'laser_rangr' (did you mean laser_ranger?); "
            "expected one of laser_ranger, draw_wire, position, pose, plane_contact, point_contact, distances"
        ],
    ),
    (
        "campaign.yaml",
        ("[0, 1, 4.6]", "[0, 0, 0]"),
        [
            "campaign.yaml, line 4: targets.deck.normal: got [0.0, 0.0, 0.0]; "
            "expected a direction, which is not zero and not beyond all measure"
        ],
    ),
    (
        "campaign.yaml",
        ("observations: observations.csv", "observations: observation.csv"),
        [
            "campaign.yaml, line 5: observations: observation.csv: there is no such file "
            "(did you mean observations.csv?); expected a CSV or Parquet file"
        ],
    ),
    (
        "campaign.yaml",
        ("robot: robot.yaml", "robot: {catalogue: puma}"),
        [
            "campaign.yaml, line 1: robot: the catalogue has no arm 'puma' (did you mean puma560?); "
            "expected one of space-arm, puma560, ur10, panda, iiwa14, canadarm2"
        ],
    ),
    (
        "campaign.yaml",
        ("observations: observations.csv", "observations: observations.csv\nfixed: [j3.theta]"),
        [
            "campaign.yaml, line 6: fixed[0]: 'j3.theta' is no parameter (did you mean j2.theta?); "
            "expected names such as j1.theta, j1.d, j1.a or *.theta, of base, j1, j2, mount, deck, sensor"
        ],
    ),
    (
        "robot.yaml",
        ("a: 0.4", "a: long"),
        ["robot.yaml, line 4: joints[1].a: got 'long'; expected a number"],
    ),
    (
        "observations.csv",
        ("0.2,0.3,0.4", "0.2,O.3,0.4"),
        ["observations.csv, line 3: j2: got 'O.3'; expected a number, or an empty cell where there is none"],
    ),
    (
        "observations.csv",
        ("0.2,0.3,0.4", "0.2,0.3"),
        ["observations.csv, line 3: 2 cells; expected 3, as in the header"],
    ),
]


@pytest.mark.parametrize(("file", "spoiled", "problems"), PINNED)
def test_the_text_of_an_error_is_as_pinned(tmp_path, monkeypatch, file, spoiled, problems):
    monkeypatch.chdir(tmp_path)
    for name, text in (("robot.yaml", ROBOT), ("campaign.yaml", CAMPAIGN), ("observations.csv", OBSERVATIONS)):
        if name == file:
            assert spoiled[0] in text
            text = text.replace(*spoiled)
        (tmp_path / name).write_text(text)
    with pytest.raises(InputError) as caught:
        load_campaign("campaign.yaml")
    assert list(caught.value.problems) == problems


def test_an_arm_that_the_catalogue_lacks_lists_those_it_has():
    with pytest.raises(InputError) as caught:
        catalogue.load("ur5")
    assert str(caught.value) == (
        "the catalogue has no arm 'ur5' (did you mean ur10?); it has space-arm, puma560, ur10, panda, iiwa14, canadarm2"
    )
