"""What a campaign could know: ranks of the paper, defaults, and that no reading's value matters."""

from dataclasses import replace

import numpy as np
import pytest

from boresight.arm import Joint, catalogue
from boresight.calibration import Campaign, Freedom, inspect
from boresight.errors import InputError
from boresight.geometry import Plane
from boresight.sensing import Cell, LaserRanger, Position

ARM = catalogue.load("space-arm")
PLANES = {
    "deck": Plane.of((0.0, 1.0, 4.6), -0.69),
    "wall": Plane.of((-1.0, 0.15, 0.2), 1.6),
    "corner": Plane.of((0.1, -1.0, 0.15), 1.7),
}
LINKS = [f"j{i}.{n}" for i in range(1, 7) for n in ("theta", "d", "a", "alpha") if (i, n) != (2, "d")] + ["j2.beta"]
FRAMES = frozenset(f"{f}.{n}" for f in ("base", "mount") for n in ("x", "y", "z", "roll", "pitch", "yaw"))


def cell(planes=1, arm=ARM):
    return Cell(arm, LaserRanger(2e-4, 10), targets=dict(list(PLANES.items())[:planes]))


def campaign(names=None, planes=1, **more):
    freedoms = None if names is None else tuple(Freedom(name, 0.02, 0.01) for name in names)
    return Campaign("rehearsal", cell(planes), freedoms=freedoms, **more)


def test_24_link_and_2_plane_parameters_have_rank_25():
    found = inspect(campaign([*LINKS, "deck.normal_x", "deck.normal_z"]))
    assert (len(found.free), found.rank, found.everett) == (26, 25, 30)
    assert [each.parameters for each in found.unseen] == [("j1.theta", "deck.normal_x")]


@pytest.mark.parametrize(("planes", "seen"), [(1, 26), (2, 28), (3, 29)])
def test_one_two_and_three_planes_could_see_26_28_and_29(planes, seen):
    assert inspect(campaign(LINKS, planes)).arm_rank == seen


def test_flat_plane_sees_21_of_24():
    flat = replace(cell(), targets={"deck": Plane.of((0.0, 0.0, 1.0), -0.15)})
    found = inspect(replace(campaign(LINKS), cell=flat))
    assert found.rank == 21
    assert found.unseen[0].parameters == ("j1.theta", "j1.a", "j3.d")


def test_default_leaves_out_d_of_parallel_axes():
    found = inspect(campaign())
    assert found.rank == len(found.free) == 24
    assert [(out.parameter, out.reason) for out in found.left_out] == [
        ("j2.d", "parallel to j3's axis: beta stands in")
    ]


def test_default_with_unknown_frames_says_which_frame_stands_for_which_link():
    found = inspect(campaign(planes=3, unknown=FRAMES))
    reasons = {out.parameter: out.reason for out in found.left_out}
    assert reasons["j1.theta"] == "changes no reading that base.yaw does not explain"
    assert [each.parameters for each in found.unseen] == [("mount.yaw",)]
    assert any("identity" in warning for warning in found.warnings)
    assert next(p for p in found.predictions if p.parameter == "mount.yaw").std == np.inf


def test_asked_for_rows_are_drawn_and_the_seed_decides_them():
    first, again, other = (inspect(campaign(LINKS), rows=40, seed=seed) for seed in (1, 1, 2))
    assert first.drawn
    assert first.rows == 40
    assert first == again
    assert first.condition != other.condition


def test_fewer_values_than_parameters_are_warned_of():
    found = inspect(campaign(LINKS), rows=10)
    assert found.rank == 10
    assert any("10 readings cannot tell 24 parameters" in warning for warning in found.warnings)


def test_predicted_accuracy_scales_with_noise():
    quiet = inspect(campaign(LINKS, 3))
    loud = inspect(replace(campaign(LINKS, 3), cell=replace(cell(3), sensor=LaserRanger(4e-4, 10))))
    ratios = [b.std / a.std for a, b in zip(quiet.predictions, loud.predictions, strict=True)]
    assert ratios == pytest.approx([2.0] * len(ratios), rel=1e-3)


def test_noise_makes_parameters_hardly_seen():
    found = inspect(replace(campaign(LINKS), cell=replace(cell(), sensor=LaserRanger(5e-3))), rows=40)
    assert found.rank == 24
    assert found.hardly
    assert any(p.source == "prior" for p in found.predictions)


def test_slides_and_trackers_are_inspected_too():
    slide = Joint("rail", "prismatic", alpha=-np.pi / 2, limits=(-0.5, 0.5))
    arm = replace(ARM, joints=(slide, *ARM.joints), convention="modified-dh")
    found = inspect(Campaign("tracker", Cell(arm, Position(1e-4))))
    assert found.everett == 32
    assert found.rank == len(found.free)


def test_everything_fixed_is_an_error():
    with pytest.raises(InputError, match="nothing to inspect"):
        inspect(campaign(["j1.a"], fixed=frozenset({"j1.a"})))


def test_seven_axes_and_three_planes_could_see_33_of_34():
    found = inspect(Campaign("seven", cell(3, catalogue.load("iiwa14"))))
    assert (found.everett, found.arm_rank) == (34, 33)
