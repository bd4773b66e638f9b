"""Calibrate a robot arm with a laser distance sensor and a flat plate, and be told how far to trust the result.

The same verbs as the command line, on immutable values:

    campaign = boresight.load_campaign("campaign.yaml")
    result = boresight.calibrate(campaign)
    boresight.write_result(result, Path("result"), boresight.__version__)

Names are imported when first used, so that `boresight --help` does not wait for compilers and solvers.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_HOME = {
    "Arm": "boresight.arm",
    "BoresightError": "boresight.errors",
    "Campaign": "boresight.calibration",
    "Cell": "boresight.sensing",
    "Compensation": "boresight.compensation",
    "InputError": "boresight.errors",
    "Inspection": "boresight.calibration",
    "Joint": "boresight.arm",
    "Result": "boresight.calibration",
    "Solver": "boresight.calibration",
    "calibrate": "boresight.calibration",
    "compensate": "boresight.compensation",
    "inspect": "boresight.calibration",
    "load_campaign": "boresight.files",
    "load_result": "boresight.files",
    "load_robot": "boresight.files",
    "reproduce": "boresight.reproduction",
    "load_study": "boresight.files",
    "simulate": "boresight.calibration",
    "study": "boresight.studies",
    "write_result": "boresight.report",
}

__all__ = sorted(_HOME)

if TYPE_CHECKING:
    from boresight.arm import Arm as Arm
    from boresight.arm import Joint as Joint
    from boresight.calibration import Campaign as Campaign
    from boresight.calibration import Inspection as Inspection
    from boresight.calibration import Result as Result
    from boresight.calibration import Solver as Solver
    from boresight.calibration import calibrate as calibrate
    from boresight.calibration import inspect as inspect
    from boresight.calibration import simulate as simulate
    from boresight.compensation import Compensation as Compensation
    from boresight.compensation import compensate as compensate
    from boresight.errors import BoresightError as BoresightError
    from boresight.errors import InputError as InputError
    from boresight.files import load_campaign as load_campaign
    from boresight.files import load_result as load_result
    from boresight.files import load_robot as load_robot
    from boresight.files import load_study as load_study
    from boresight.report import write_result as write_result
    from boresight.reproduction import reproduce as reproduce
    from boresight.sensing import Cell as Cell
    from boresight.studies import study as study


def __getattr__(name: str) -> Any:
    """Returns a public name, imported from where it lives."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    """Returns the public names."""
    return [*__all__, "__version__"]
