"""Axes of small charts: where a value lies in an SVG drawing, and which values get a tick."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_MOST_DECADES = 7


@dataclass(frozen=True, slots=True)
class Tick:
    """A labelled place on an axis.

    Attributes:
        at: where, in the drawing.
        text: its label.
    """

    at: float
    text: str


@dataclass(frozen=True, slots=True)
class Axis:
    """A scale from values to places in a drawing.

    Attributes:
        low, high: the values at its ends.
        start, end: the places of its ends; an upright axis starts below, where places are larger.
        log: whether equal ratios, rather than equal differences, are equally far apart.
        ticks: labelled places.
    """

    low: float
    high: float
    start: float
    end: float
    log: bool
    ticks: tuple[Tick, ...]

    def at(self, values: Float[np.ndarray, "*values"]) -> Float[np.ndarray, "*values"]:
        """Returns the places of values, those beyond an end at that end."""
        return _place(values, self.low, self.high, self.start, self.end, self.log)


def linear_axis(low: float, high: float, start: float, end: float, most: int = 6) -> Axis:
    """Returns an axis on which 1, 2 or 5 times a power of ten is the step between at most `most + 1` ticks."""
    if not high > low:
        low, high = low - 1.0, high + 1.0
    rough = (high - low) / most
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(power * factor for factor in (1, 2, 5, 10) if power * factor >= rough * (1 - 1e-9))
    values = [k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    return _axis(low, high, start, end, False, values, [_signed(value, decimals) for value in values])


def log_axis(low: float, high: float, start: float, end: float) -> Axis:
    """Returns an axis over whole decades that hold both values, ticked at decades, and between them if they are few."""
    first = math.floor(math.log10(low) + 1e-9)
    last = max(math.ceil(math.log10(high) - 1e-9), first + 1)
    every = math.ceil((last - first) / _MOST_DECADES)
    factors = (1, 2, 5) if last - first == 1 else (1,)
    values = [factor * 10.0**power for power in range(first, last + 1, every) for factor in factors]
    values = [value for value in values if value <= 10.0**last * (1 + 1e-9)]
    texts = [_plain(value) if first >= -4 and last <= 4 else _power(value) for value in values]
    return _axis(10.0**first, 10.0**last, start, end, True, values, texts)


def _axis(
    low: float, high: float, start: float, end: float, log: bool, values: Sequence[float], texts: Sequence[str]
) -> Axis:
    places = _place(np.array(values, dtype=float), low, high, start, end, log)
    ticks = tuple(Tick(float(place), text) for place, text in zip(places, texts, strict=True))
    return Axis(low, high, start, end, log, ticks)


def _place(values: np.ndarray, low: float, high: float, start: float, end: float, log: bool) -> np.ndarray:
    inside = np.clip(values, low, high)
    share = np.log10(inside / low) / math.log10(high / low) if log else (inside - low) / (high - low)
    return start + share * (end - start)


def _signed(value: float, decimals: int) -> str:
    text = f"{value:,.{decimals}f}"
    return text.replace("-", "−") if float(text.replace(",", "")) else text.lstrip("-")


def _plain(value: float) -> str:
    return f"{value:,.0f}" if value > 0.99 else f"{value:.4f}".rstrip("0")


def _power(value: float) -> str:
    power = math.floor(math.log10(value) + 1e-9)
    factor = round(value / 10.0**power)
    return ("" if factor == 1 else f"{factor}·") + "10" + str(power).translate(_SUPERSCRIPTS)
