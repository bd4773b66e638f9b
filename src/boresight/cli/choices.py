"""What options of the command line may be."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Annotated, Any, Literal

from cyclopts import Parameter, Token

SolverChoice = Literal["evolution+least-squares", "evolution", "least-squares"]
StrategyChoice = Literal["trade-off", "rand-to-best/1", "current-to-best/1", "best/1", "rand/1", "downhill"]

DeviceChoice = Literal["cpu", "cuda"]
PrecisionChoice = Literal["double", "single"]
FormatChoice = Literal["urdf", "dh", "ur-kinematics", "ur-calibration-conf", "pal", "json"]
ConventionChoice = Literal["standard-dh", "modified-dh"]

_WHOLE = re.compile(r"[-+]?[0-9]+")
_REAL = re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?|[-+]?inf|nan")


def whole(_: Any, tokens: Sequence[Token]) -> int:
    """Returns a whole number written plainly.

    Raises:
        ValueError: it is none; cyclopts says which option.
    """
    text = tokens[0].value
    if not _WHOLE.fullmatch(text):
        raise ValueError(f"expected a whole number, got {text}")
    return int(text)


def real(_: Any, tokens: Sequence[Token]) -> float:
    """Returns a number written plainly; ValueError where it is none."""
    text = tokens[0].value
    if not _REAL.fullmatch(text):
        raise ValueError(f"expected a number, got {text}")
    return float(text)


Whole = Annotated[int, Parameter(converter=whole)]
WholeOrNone = Annotated[int | None, Parameter(converter=whole)]
Real = Annotated[float, Parameter(converter=real)]
"""Numbers as they are written plainly: cyclopts would take 1.5, 1_0 and digits of any script for whole ones."""
