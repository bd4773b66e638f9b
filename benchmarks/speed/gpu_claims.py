"""What is claimed of a card, beside what was measured."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from benchmarks.report import Figure

if TYPE_CHECKING:
    from benchmarks.speed.gpu import Launched

LEAST = {"single": 30_000, "double": 9_000}
"""Identifications a second of one H100, all included."""

CLOSE = 0.02
"""Relative difference of the median final RMS between card and processor that is still the same."""


def figures(found: list[Launched], rms: np.ndarray) -> tuple[Figure, ...]:
    """Returns rates and answers beside what they should be."""
    claims = []
    for each in found:
        rate, least = each.rate(each.whole), LEAST[each.precision]
        name = f"case-1 identifications a second, {each.precision} precision"
        claims.append(Figure(name, f"{rate:,.0f}", f">= {least:,}", rate >= least))
        differs = abs(float(np.median(each.rms)) / float(np.median(rms)) - 1.0)
        name = f"median RMS beside the processor's, {each.precision} precision"
        claims.append(Figure(name, f"{100 * differs:.2f} % apart", f"<= {100 * CLOSE:g} %", differs <= CLOSE))
    return tuple(claims)
