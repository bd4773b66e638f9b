"""An effect that explains residuals, and the sentence that says so."""

from __future__ import annotations

import math
from dataclasses import dataclass

from boresight.units import in_millimetres


@dataclass(frozen=True, slots=True)
class Explanation:
    """An effect that explains residuals.

    Attributes:
        effect: its name: `sensor.bias`, `deck.offset`, `j3.gain`, `drift of j3.a`.
        parameters: the parameters that would model it; empty where none can.
        value: its size [m, rad or 1], of the first number where there are several.
        std: standard deviation of that.
        unit: m, rad or 1.
        numbers: how many numbers it has.
        ratio_before: residuals over the stated noise as the result is.
        ratio_after: the same with the effect estimated.
        left_out_before: rows left out as the result is.
        left_out_after: the same with the effect estimated.
        cost: squared residuals that are left over their variances, gross ones by size.
        tool_m: how far the tool would move over the work space [m], root mean square; NaN where not found.
    """

    effect: str
    parameters: tuple[str, ...]
    value: float
    std: float
    unit: str
    numbers: int
    ratio_before: float
    ratio_after: float
    left_out_before: int
    left_out_after: int
    cost: float
    tool_m: float = math.nan


def explanation_in_words(found: Explanation, line: str | None) -> str:
    """Returns an explanation as a sentence.

    Args:
        found: the explanation.
        line: what to write into the campaign to estimate it, where that can be.
    """
    size = f" = {_amount(found.value, found.std, found.unit)}" if found.numbers == 1 else f" ({found.numbers} numbers)"
    back = ""
    if found.left_out_after != found.left_out_before:
        back = f", rows left out from {found.left_out_before} to {found.left_out_after}"
    how = "explains the residuals" if found.ratio_after < 2.0 else "explains part of the residuals"
    fell = f"from {found.ratio_before:.2g}x to {found.ratio_after:.2g}x the stated noise"
    said = f"`{found.effect}`{size} {how}: {fell}{back}."
    return said if line is None else f"{said} To estimate it: `{line}`."


def _amount(value: float, std: float, unit: str) -> str:
    if unit == "m":
        return f"{in_millimetres(value)} ± {in_millimetres(std)}"
    factor, name = (1e3, "mrad") if unit == "rad" else (1e2, "%")
    return f"{factor * value:.3g} ± {factor * std:.2g} {name}"
