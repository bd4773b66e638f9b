"""Lengths too short to have a direction are set aside and told, unless the sensor's zero is estimated."""

import pytest

WIRE = """\
robot: robot.yaml
units: {length: mm, angle: deg}
sensor: {type: draw_wire, noise_std: 0.2}
targets:
  post: {type: point, position: [1000, 0, 500]}
observations: observations.csv
"""

ROWS = "j1,j2,distance\n10,20,1500\n10,30,0\n20,30,-3\n20,40,0.5\n25,40,0.7\n30,10,1400\n"


def lines(campaign):
    return [row.line for row in campaign.set_aside]


def test_a_wire_no_longer_than_its_noise_is_set_aside(folder):
    campaign = folder.write(campaign=WIRE, observations=ROWS).load()
    assert lines(campaign) == [3, 4, 5]
    assert [row.line for row in campaign.set_aside] == [3, 4, 5]
    assert campaign.set_aside[2].reason == (
        "a distance of 0.5 is not above 3 standard deviations of 0.2 mm, so it has no direction"
    )
    assert campaign.readings.line.tolist() == [2, 6, 7]


def test_of_held_out_rows_too(folder):
    text = WIRE + "validation: validation.csv\n"
    held_out = {"validation.csv": ROWS}
    campaign = folder.write(campaign=text, observations="j1,j2,distance\n10,20,1500\n", **held_out).load()
    assert [(row.file, row.line) for row in campaign.set_aside] == [
        ("validation.csv", 3),
        ("validation.csv", 4),
        ("validation.csv", 5),
    ]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("noise_std: 0.2}", "noise_std: 0.2, offset_per: session}"),
        ("targets:", "estimate: [{parameters: [sensor.bias], within: 20}]\ntargets:"),
    ],
)
def test_a_wire_of_unknown_zero_may_read_anything(folder, old, new):
    rows = ROWS.replace("distance\n", "distance,session\n").replace("0\n", "0,a\n").replace("3\n", "3,a\n")
    rows = rows.replace("0.5\n", "0.5,a\n").replace("0.7\n", "0.7,a\n")
    campaign = folder.write(campaign=WIRE.replace(old, new), observations=rows).load()
    assert campaign.set_aside == ()
    assert len(campaign.readings) == 6


def test_where_nothing_is_left_a_contact_is_suggested(folder):
    said = folder.write(campaign=WIRE, observations="j1,j2,distance\n10,20,0\n30,20,0\n").problem()
    assert said == (
        "observations.csv: none of its rows can be used; the first, on line 2: a distance of 0 is not above 3 standard "
        "deviations of 0.2 mm, so it has no direction. A ball that sits in a socket, or a tip on a point, is "
        "`type: point_contact`, which reads nothing"
    )


def test_distances_between_positions_that_are_one(folder):
    text = WIRE.replace("draw_wire", "distances").replace(
        "targets:\n  post: {type: point, position: [1000, 0, 500]}\n", ""
    )
    rows = "j1,j2,x,y,z\n10,20,500,0,300\n40,20,500,200,300\n10,20,500,0,300.1\n10,50,400,0,600\n"
    campaign = folder.write(campaign=text, observations=rows).load()
    assert lines(campaign) == [2]
    assert campaign.readings.line.tolist() == [3]


def test_configurations_alone_are_kept(folder):
    campaign = folder.write(campaign=WIRE, observations="j1,j2\n10,20\n30,20\n").load()
    assert len(campaign.readings) == 2
