"""A grid is the product of what is varied; a point's key is its content."""

from dataclasses import replace

import pytest
from small_studies import bench, planes, point, settings, small_study

from boresight.errors import InputError
from boresight.geometry import Plane
from boresight.studies import Bench, Chosen, Point, grid


def test_a_grid_is_the_product_of_its_axes():
    axes = {"rows": (30, 45), "noise_std": (1e-4, 2e-4, 4e-4)}
    study = small_study(5, axes)
    found = [(each.settings.rows, each.settings.noise_std) for each in study.points]
    assert found == [(30, 1e-4), (30, 2e-4), (30, 4e-4), (45, 1e-4), (45, 2e-4), (45, 4e-4)]
    assert study.varied == ("rows", "noise_std")
    assert len(study) == 30 == len({(each.key, seed) for each, seed in study.runs()})


def test_a_strategy_means_nothing_to_least_squares():
    study = small_study(1, {"solver": ("least-squares", "evolution"), "strategy": ("trade-off", "rand/1", "best/1")})
    found = [(each.label("solver"), each.label("strategy")) for each in study.points]
    assert found == [("least-squares", None), *(("evolution", name) for name in ("trade-off", "rand/1", "best/1"))]


def test_seeds_advance_together_over_the_grid():
    runs = list(small_study(20).runs())
    assert {seed for _, seed in runs[:16]} == set(range(8))
    assert len({each.key for each, _ in runs[:16]}) == 2


def test_planes_that_are_not_used_are_not_there():
    one = point(planes=planes(1))
    assert list(one.cell.targets) == ["deck"]
    without = point(planes=Chosen("walls", ("wall_x", "wall_y")))
    assert "deck.normal_x" in {f.parameter for f in one.freedoms}
    assert "deck.normal_x" not in {f.parameter for f in without.freedoms}


def test_the_sensor_has_the_points_noise_and_repeats():
    sensor = point(noise_std=5e-4, repeats=3).cell.sensor
    assert (sensor.noise_std, sensor.repeats) == (5e-4, 3)


def test_fixed_parameters_are_not_free():
    held = point(fixed=Chosen("j1.*", ("j1.theta", "j1.d")))
    assert {f.parameter for f in point().freedoms} - {f.parameter for f in held.freedoms} == {"j1.theta", "j1.d"}


def test_error_size_scales_errors_box_and_priors_but_leans_no_plane_over():
    usual, large = ({f.parameter: f for f in point(error_size=size).freedoms} for size in (1.0, 5.0))
    assert large["j3.theta"].within == pytest.approx(5 * usual["j3.theta"].within)
    assert large["j3.theta"].prior_std == pytest.approx(5 * usual["j3.theta"].prior_std)
    assert large["deck.normal_x"].within == pytest.approx(0.02)


DIFFERENT = [
    {"rows": 41},
    {"noise_std": 3e-4},
    {"repeats": 9},
    {"gross_errors": 0.1},
    {"error_size": 2.0},
    {"validation_rows": 19},
    {"solver": "evolution"},
    {"planes": planes(2)},
    {"fixed": Chosen("any", ("j1.theta",))},
]


@pytest.mark.parametrize("change", DIFFERENT, ids=lambda change: next(iter(change)))
def test_a_key_changes_with_every_setting_that_changes_an_outcome(change):
    assert point(**change).key != point().key


def test_a_key_changes_with_the_cell():
    shifted = bench().cell
    shifted = replace(shifted, targets={**shifted.targets, "deck": Plane.of((0.0, 1.0, 4.6), -0.7)})
    assert Point("space-arm", replace(bench(), cell=shifted), settings()).key != point().key


def test_a_key_is_the_same_for_what_only_words_tell_apart():
    assert Point("other", bench(), settings()).key == point().key
    assert point(planes=Chosen("all", ("deck", "wall_x", "wall_y"))).key == point().key
    assert point(generations=7, population=9).key == point().key  # least squares has neither


def test_keys_stay_what_they_were():
    # A change here throws away everybody's stored runs: raise RUN_FORMAT only where outcomes changed.
    assert point().key == "df7590fd2c4115ff733e06a3"


def test_nothing_to_estimate_is_an_error():
    with pytest.raises(InputError, match="nothing to calibrate"):
        grid({"space-arm": Bench(bench().cell, ())}, {}, settings())
