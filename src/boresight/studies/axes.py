"""What is varied, in words and units for tables and figures."""

from __future__ import annotations

from typing import Any

from boresight.studies.grid import AXES

TITLES = {
    "robot": "robot",
    "planes": "planes",
    "fixed": "held",
    "rows": "readings",
    "repeats": "repeats",
    "noise_std": "noise, mm",
    "error_size": "error size",
    "gross_errors": "gross errors",
    "solver": "solver",
    "strategy": "strategy",
    "population": "population",
    "generations": "generations",
}

LONG_TITLES = TITLES | {
    "rows": "readings (configurations)",
    "repeats": "readings averaged in a configuration",
    "noise_std": "noise of one reading, mm (standard deviation)",
    "error_size": "size of the initial errors",
    "gross_errors": "gross errors, % of the readings",
    "fixed": "parameters held",
}

_SCALES = {"noise_std": 1e3, "gross_errors": 1e2}
_NUMBERS = ("rows", "repeats", "noise_std", "error_size", "gross_errors", "population", "generations")

assert tuple(TITLES) == AXES


def is_number(axis: str) -> bool:
    """Returns whether an axis is one of numbers rather than names."""
    return axis in _NUMBERS


def number(axis: str, value: Any) -> float:
    """Returns a value of an axis of numbers as its figures show it; NaN where it means nothing."""
    if value is None:
        return float("nan")
    return float(f"{_SCALES.get(axis, 1.0) * value:.12g}")


def shown(axis: str, value: Any) -> str:
    """Returns a value as its tables and legends show it."""
    if value is None:
        return "–"
    if axis == "gross_errors":
        return f"{number(axis, value):g} %"
    return f"{number(axis, value):g}" if is_number(axis) else str(value)
