"""Numbers in another unit are refused before any fit, by file and key; cells of every size that can be built pass."""

import csv
import re
from pathlib import Path

import numpy as np
import pytest

from boresight.errors import InputError
from boresight.files.campaigns import load_campaign

EXAMPLE = Path(__file__).parents[2] / "examples" / "space-arm-one-plane"
LINKS = {"j1.d": 0.35, "j2.a": 0.45, "j3.d": 0.15, "j4.d": 0.4, "j6.d": 0.12, "j6.a": 0.06}
ALPHA = {"j1": -90.0, "j2": 0.0, "j3": 90.0, "j4": -90.0, "j5": 90.0, "j6": 30.0}
PLANE = (0.0, 0.212429644331, 0.977176363923, -0.146576454588)


def observations():
    with (EXAMPLE / "observations.csv").open() as file:
        return list(csv.DictReader(file))


def write(
    folder,
    *,
    lengths=1.0,
    links=None,
    alpha=None,
    robot_units="{length: m, angle: deg}",
    units="{length: m, angle: rad}",
    offset=PLANE[3],
    extra="",
    ranges=1.0,
    joints=1.0,
    first="",
):
    """A campaign of the example's arm, all lengths times `lengths`, in files of their own."""
    links, alpha = {**LINKS, **(links or {})}, {**ALPHA, **(alpha or {})}
    rows = [
        f"  - {{name: {j}, d: {lengths * links.get(f'{j}.d', 0.0)}, a: {lengths * links.get(f'{j}.a', 0.0)}, "
        f"alpha: {alpha[j]}, limits: [-170, 170]}}"
        for j in ALPHA
    ]
    (folder / "robot.yaml").write_text("\n".join([f"name: arm\nunits: {robot_units}\njoints:", first, *rows]) + "\n")
    (folder / "campaign.yaml").write_text(
        f"robot: robot.yaml\nunits: {units}\nsensor: {{type: laser_ranger, noise_std: {2e-4 * lengths}}}\n"
        f"targets: {{deck: {{type: plane, normal: {list(PLANE[:3])}, offset: {lengths * offset}}}}}\n"
        f"observations: observations.csv\n{extra}\n"
    )
    names = [*(["rail"] if first else []), *ALPHA]
    lines = [",".join([*names, "range", "target"])]
    for row in observations():
        q = [*(["0.5"] if first else []), *(str(joints * float(row[j])) for j in ALPHA)]
        lines.append(",".join([*q, str(ranges * lengths * float(row["range"])), "deck"]))
    (folder / "observations.csv").write_text("\n".join(lines) + "\n")
    return folder / "campaign.yaml"


@pytest.mark.parametrize(
    ("slip", "words"),
    [
        (
            {"ranges": 1e3},
            r"observations\.csv: range: got .* before an arm that reaches 1\.3\d* m; is it in another unit",
        ),
        ({"ranges": 1e-3}, r"observations\.csv: range: got .* is it in another unit"),
        ({"links": {"j2.a": 450}}, r"robot\.yaml: j2\.a: got 450 m, 417 times all other links together"),
        ({"links": {"j6.d": 120}}, r"robot\.yaml: j6\.d: got 120 m, 85 times"),
        ({"links": {"j2.a": 1e9}}, r"robot\.yaml: j2\.a: got 1e\+09 m"),
        (
            {"alpha": {"j1": -1.5708}},
            r"robot\.yaml: j1\.alpha: got -1\.5708 degrees, which is a right angle in radians",
        ),
        ({"robot_units": "{length: m}"}, r"j1\.alpha: got -90 radians, more than a turn; .* Say units: \{angle: deg\}"),
        (
            {"robot_units": "{length: mm, angle: deg}"},
            r"d and a, read in millimetres, make an arm that reaches 0\.0013",
        ),
        ({"extra": "base: {xyz: [100, 200, 300]}"}, r"is base\.xyz in another unit than `units:` says"),
        ({"extra": "mount: {xyz: [0, 0, 50]}"}, r"mount\.xyz: the sensor sits 50 m from the flange of an arm"),
        ({"extra": "mount: {xyz: [1e300, 0, 0]}"}, r"mount\.xyz: got .*; expected numbers of at most 1e\+09"),
        ({"offset": -146.6}, r"is targets\.deck\.offset in another unit than `units:` says"),
        ({"joints": 180 / np.pi}, r"reads up to .*, too much for radians and within its limits as degrees"),
        ({"units": "{length: m, angle: deg}"}, r"as radians they fit: say units: \{angle: rad\} in the campaign"),
    ],
)
def test_a_number_in_another_unit_is_refused(tmp_path, slip, words):
    path = write(tmp_path, **slip)
    with pytest.raises(InputError) as caught:
        load_campaign(path)
    assert re.search(words, str(caught.value)), str(caught.value)


def test_an_arm_in_millimetres_that_says_nothing_of_it_is_refused_whole(tmp_path):
    path = write(tmp_path, lengths=1e3)
    with pytest.raises(InputError, match=r"reaches 1328 m; are they in millimetres\? Say units: \{length: mm\}"):
        load_campaign(path)


def test_positions_far_from_what_the_arm_can_reach_are_refused(tmp_path):
    path = write(tmp_path)
    campaign = load_campaign(path)
    ends = campaign.cell.poses(campaign.readings.joints)[:, :3, 3]
    path.write_text(
        "robot: robot.yaml\nsensor: {type: position, noise_std: 1e-4}\nbase: {xyz: unknown, rpy: unknown}\n"
    )
    for factor, refused in ((1.0, False), (1e3, True), (1e-3, True)):
        lines = [",".join([*ALPHA, "x", "y", "z"])]
        rows = zip(campaign.readings.joints, factor * (ends + np.array([5.0, -3.0, 1.0])), strict=True)
        lines += [",".join(map(str, (*q, *p))) for q, p in rows]
        (tmp_path / "positions.csv").write_text("\n".join(lines) + "\n")
        path.write_text(path.read_text().partition("observations")[0] + "observations: positions.csv\n")
        if refused:
            with pytest.raises(InputError, match=r"x, y, z: got positions .* are they in another unit"):
                load_campaign(path)
        else:
            load_campaign(path)


RAIL = "  - {name: rail, type: prismatic, alpha: 90, limits: [0, 60]}"


@pytest.mark.parametrize(
    "cell",
    [
        {"lengths": 0.08},
        {"lengths": 8.0},
        {"lengths": 20.0},
        {"extra": "mount: {xyz: [0, 0, 2.5]}"},
        {"first": RAIL},
        {"lengths": 1e3, "robot_units": "{length: mm, angle: deg}", "units": "{length: mm, angle: rad}"},
        {"extra": "base: {xyz: unknown, rpy: unknown}", "offset": 45.0},
        {"ranges": 20.0, "extra": "mount: {xyz: unknown, rpy: unknown}"},
        {"links": {"j2.a": 12.0}},
        {"alpha": {"j6": 1.6}},
    ],
    ids=str,
)
def test_cells_of_every_size_pass(tmp_path, cell):
    load_campaign(write(tmp_path, **cell))


def test_repeats_of_one_posture_pass(tmp_path):
    path = write(tmp_path)
    path.write_text("robot: robot.yaml\nsensor: {type: position, noise_std: 1e-4}\nobservations: positions.csv\n")
    random = np.random.default_rng(0)
    lines = [",".join([*ALPHA, "x", "y", "z"])]
    for _ in range(20):
        joints, position = random.normal(0.5, 1e-6, 6), random.normal(0.4, 2e-4, 3)
        lines.append(",".join(map(str, (*joints, *position))))
    (tmp_path / "positions.csv").write_text("\n".join(lines) + "\n")
    load_campaign(path)


LINK = "  - {{name: {}, d: {}, a: {}, alpha: {}, limits: [-3, 3]}}"
SLIDE = "  - {{name: {}, type: prismatic, d: {}, alpha: {}, limits: [{}, {}]}}"
SMALL = [LINK.format("j1", 0.1, 0.1, 1.5708), LINK.format("j2", 0.0, 0.1, 0), LINK.format("j3", 0.05, 0.0, 1.5708)]
ARMS = {
    "small arm on 30 m": [SLIDE.format("rail", 0, 1.5708, 0, 30), *SMALL],
    "its zero in the middle": [SLIDE.format("rail", 30, 1.5708, -30, 30), *SMALL],
    "a part of the rail far out": [SLIDE.format("rail", 0, 1.5708, 40, 60), *SMALL],
    "gantry": [SLIDE.format(n, 0, 1.5708, 0, most) for n, most in (("x", 40), ("y", 12), ("z", 3))],
    "small gantry": [SLIDE.format(n, 0, 1.5708, 0, 0.05) for n in "xyz"],
    "gantry with wrist": [
        *(SLIDE.format(n, 0, 1.5708, 0, most) for n, most in (("x", 60), ("y", 20), ("z", 5))),
        LINK.format("j1", 0.1, 0.0, 1.5708),
        LINK.format("j2", 0.0, 0.05, 0),
    ],
    "SCARA with a long stroke": [
        LINK.format("j1", 0.3, 0.3, 0),
        LINK.format("j2", 0, 0.25, 0),
        SLIDE.format("z", 0, 0, -4, 4),
    ],
    "0.1 m arm": [LINK.format("j1", 0.02, 0.04, 1.5708), LINK.format("j2", 0, 0.04, 0), LINK.format("j3", 0.01, 0, 0)],
    "60 m crane": [
        LINK.format("slew", 50, 0, 0),
        SLIDE.format("trolley", 0, 1.5708, 2, 60),
        SLIDE.format("hoist", 0, 0, 0, 50),
    ],
    "60 m boom": [
        LINK.format("slew", 0, 0.5, 1.5708),
        LINK.format("luff", 0, 60, 0),
        SLIDE.format("hoist", 0, 0, 0, 45),
    ],
    "slide without limits": [SLIDE.format("rail", 0, 1.5708, -1e6, 1e6), *SMALL],
}


def write_arm(folder, joints, *, scale=1.0, ranges=1.0, column=None):
    """A campaign of an arm with readings of a short-range sensor and of one that looks through the hall."""
    (folder / "robot.yaml").write_text("name: arm\njoints:\n" + "\n".join(joints) + "\n")
    (folder / "campaign.yaml").write_text(
        "robot: robot.yaml\nsensor: {type: laser_ranger, noise_std: 1e-4}\nbase: {xyz: unknown, rpy: unknown}\n"
        "targets: {deck: {type: plane, normal: [0, 0, 1], offset: 0}}\nobservations: observations.csv\n"
    )
    names = [re.search("name: ([a-z0-9]+)", joint)[1] for joint in joints]
    highest = [min(float(joint.rstrip("]}").rpartition(",")[2]), 30.0) for joint in joints]
    random, lines = np.random.default_rng(0), [",".join([*names, "range"])]
    for _ in range(20):
        q = random.uniform(0.1, 1.0, len(names)) * highest * np.where(np.array(names) == column, scale, 1.0)
        lines.append(",".join(map(str, (*q, ranges * random.uniform(0.5, 1.0)))))
    (folder / "observations.csv").write_text("\n".join(lines) + "\n")
    return folder / "campaign.yaml"


@pytest.mark.parametrize("ranges", [0.05, 20.0])
@pytest.mark.parametrize("arm", ARMS)
def test_small_arms_on_long_slides_pass(tmp_path, arm, ranges):
    small = arm in ("small gantry", "0.1 m arm")
    load_campaign(write_arm(tmp_path, ARMS[arm], ranges=ranges / 10 if small else ranges))


def test_what_no_slide_explains_is_refused(tmp_path):
    rail = SLIDE.format("rail", 0, 1.5708, 0, 30)
    slips = {
        r"j2\.a: got 431\.8 m, 1,\d\d\d times": [rail, SMALL[0], LINK.format("j2", 0, 431.8, 0), SMALL[2]],
        r"rail\.d: got 30000 m": [SLIDE.format("rail", 30000, 1.5708, 0, 30), *SMALL],
        r"make an arm that reaches .* are they in metres": [
            SLIDE.format("rail", 0, 0, 0, 5e-3),
            LINK.format("j1", 2e-4, 3e-4, 0),
        ],
    }
    for words, joints in slips.items():
        with pytest.raises(InputError, match=words):
            load_campaign(write_arm(tmp_path, joints))


def test_a_slide_in_millimetres_is_refused_by_its_limits(tmp_path):
    path = write_arm(tmp_path, ARMS["small arm on 30 m"], scale=1e3, column="rail")
    with pytest.raises(
        InputError, match=r"joint rail reads up to \d+.* m, far beyond its limits 0 to 30 m, .*`rail \[mm\]`"
    ):
        load_campaign(path)
    write_arm(tmp_path, ARMS["small arm on 30 m"], scale=1.5, column="rail")  # a careless limit
    load_campaign(path)
