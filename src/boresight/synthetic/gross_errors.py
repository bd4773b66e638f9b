"""Readings that are grossly wrong: a reflection, a slip of the pen, a beam that met something else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float

from boresight.sensing import Readings

GROSS_M = (0.02, 0.4)
"""Smallest and largest gross error of a value [m], either way."""

_GROSS = 77


def spoiled(readings: Readings, share: float, seed: int) -> tuple[Readings, Bool[np.ndarray, " rows"]]:
    """Returns readings of which a share of the rows is grossly wrong, and which those are.

    Of several channels one is wrong. What must not fall below 0, a distance, errs upwards where it would.

    Args:
        readings: the good ones.
        share: of the rows, 0 to 1; rounded to whole rows.
        seed: of which rows, and by how much.
    """
    random = np.random.Generator(np.random.Philox(np.random.SeedSequence((seed, _GROSS))))
    rows = random.choice(len(readings), round(share * len(readings)), replace=False)
    size = random.uniform(*GROSS_M, len(rows)) * random.choice((-1.0, 1.0), len(rows))
    channels = readings.values.shape[1]
    channel = random.integers(channels, size=len(rows)) if channels > 1 else np.zeros(len(rows), dtype=int)
    values = readings.values.copy()
    values[rows, channel] = _off(values[rows, channel], size, signed=channels > 1)
    planted = np.zeros(len(readings), dtype=bool)
    planted[rows] = True
    return replace(readings, values=values), planted


def _off(values: Float[np.ndarray, " rows"], size: Float[np.ndarray, " rows"], *, signed: bool) -> np.ndarray:
    moved = values + size
    return moved if signed else np.where(moved > 0.0, moved, values + np.abs(size))
