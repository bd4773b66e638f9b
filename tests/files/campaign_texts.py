"""The texts of a small campaign, to be spoiled by the tests."""

ROBOT = """\
name: two
units: {length: mm, angle: deg}
joints:
  - {name: j1, d: 300, alpha: -90, limits: [-170, 170]}
  - {name: j2, a: 400}
"""

CAMPAIGN = """\
robot: robot.yaml
sensor: {type: laser_ranger, noise_std: 0.0002, repeats: 4}
targets:
  deck: {type: plane, normal: [0, 1, 4.6], offset: -0.69}
observations: observations.csv
estimate:
  - {parameters: ["*.theta"], within: 0.025}
fixed: [j1.theta]
"""

OBSERVATIONS = "j1,j2,range\n0.1,0.2,0.3\n0.2,0.3,0.4\n"


def swapped(text, *pairs):
    """The text with each `old` replaced by `new`; every old one has to be there."""
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return text
