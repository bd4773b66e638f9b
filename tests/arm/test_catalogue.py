import importlib
import math
import pkgutil

import numpy as np
import pytest

from boresight.arm import catalogue
from boresight.errors import InputError


@pytest.mark.parametrize("name", catalogue.names())
def test_arm_is_loaded_under_its_own_name(name):
    arm = catalogue.load(name)
    assert arm.name == name
    assert len(set(arm.joint_names)) == len(arm.joints)
    assert np.all(arm.limits[:, 0] < arm.limits[:, 1])


def test_every_arm_of_the_folder_is_named_and_states_its_source():
    modules = {module.name for module in pkgutil.iter_modules(catalogue.__path__)} - {"tables"}
    assert len(modules) == len(catalogue.names())
    for module in modules:
        loaded = importlib.import_module(f"{catalogue.__name__}.{module}")
        assert "Source:" in loaded.__doc__
        assert loaded.ARM.name in catalogue.names()


def test_unknown_arm_names_the_nearest_and_lists_all():
    with pytest.raises(InputError, match=r"no arm 'puma650' \(did you mean puma560\?\); it has space-arm, puma560"):
        catalogue.load("puma650")


@pytest.mark.parametrize(
    ("name", "position"),
    [
        ("space-arm", (0.51, 0.15, 0.87)),
        ("puma560", (0.4521, -0.15005, 0.4318)),
        ("ur10", (-1.1843, -0.256141, 0.0116)),
        ("panda", (0.088, 0.0, 0.926)),
        ("iiwa14", (0.0, 0.0, 1.306)),
        ("canadarm2", (1.6134, 0.0, 16.9378)),
    ],
)
def test_tool_at_zero_readings_stands_where_the_drawing_has_it(name, position):
    arm = catalogue.load(name)
    pose = arm.forward_kinematics(np.zeros((1, len(arm.joints))))[0]
    np.testing.assert_allclose(pose[:3, 3], position, rtol=0, atol=1e-12)


def test_panda_limits_are_the_printed_radians():
    limits = catalogue.load("panda").limits
    assert math.isclose(limits[3, 0], -3.0718, rel_tol=1e-14)
    assert math.isclose(limits[5, 1], 3.7525, rel_tol=1e-14)
