"""Nominal tables of known arms as data, each module with its source.

>>> from boresight.arm import catalogue
>>> catalogue.load("ur10").joint_names[0]
'shoulder_pan_joint'
"""

from __future__ import annotations

from importlib import import_module

from boresight.arm.arm import Arm
from boresight.errors import InputError, did_you_mean

_MODULES = {
    "space-arm": "space_arm",
    "puma560": "puma560",
    "ur10": "ur10",
    "panda": "panda",
    "iiwa14": "iiwa14",
    "canadarm2": "canadarm2",
}


def names() -> tuple[str, ...]:
    """Returns the names of the arms that can be loaded."""
    return tuple(_MODULES)


def load(name: str) -> Arm:
    """Returns the nominal arm of that name.

    Raises:
        InputError: no such arm; the text lists those there are.
    """
    if name not in _MODULES:
        known = ", ".join(_MODULES)
        raise InputError(f"the catalogue has no arm '{name}'{did_you_mean(name, _MODULES)}; it has {known}")
    arm: Arm = import_module(f"{__name__}.{_MODULES[name]}").ARM
    return arm
