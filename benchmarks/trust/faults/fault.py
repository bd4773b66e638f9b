"""One thing that goes wrong in a scenario, and how a result may name it.

A fault acts where it does in life: on the cell, during the campaign, on the joints, in the sensor, on the written
rows, or in what the files say. What it does not act on stays as it is.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.trust.cell import Cell

NEVER = r"(?!)"


@dataclass(frozen=True)
class Rows:
    """Rows as they are written.

    Attributes:
        joints: (rows, joints) readings [rad or m].
        values: (rows, 1) distances or (rows, 3) positions [m].
        target: (rows,) number of the plane.
        cosine: (rows,) between beam and normal; 1 of a position.
    """

    joints: np.ndarray
    values: np.ndarray
    target: np.ndarray
    cosine: np.ndarray


def _same(value: Any, *others: Any) -> Any:
    return value


def normal(random: np.random.Generator, rows: Rows) -> np.ndarray:
    """Returns noise of standard deviation 1."""
    return random.normal(size=rows.values.shape)


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong, and the campaign does not say so.

    Attributes:
        effects: patterns (fnmatch) of effects that name it.
        words: regular expression of words that do, in a warning or reason.
        truth: (cell, random) the cell as it is.
        during: (cell, time) the cell at (rows,) times from 0, the first row, to 1, the last and after.
        actual: (joints, random) where joints stand that read this.
        sensor: (values, time) what the sensor makes of true values [m], without noise.
        noise: (random, rows) noise of standard deviation 1.
        rows: (rows, random, names of planes) as they are written.
        stated: (cell) as the files describe it.
    """

    effects: tuple[str, ...] = ()
    words: str = NEVER
    truth: Callable[[Cell, np.random.Generator], Cell] = _same
    during: Callable[[Cell, np.ndarray], Cell] = _same
    actual: Callable[[np.ndarray, np.random.Generator], np.ndarray] = _same
    sensor: Callable[[np.ndarray, np.ndarray], np.ndarray] = _same
    noise: Callable[[np.random.Generator, Rows], np.ndarray] = normal
    rows: Callable[[Rows, np.random.Generator], Rows] = _same
    stated: Callable[[Cell], Cell] = _same


NONE = Fault()


def late(time: np.ndarray) -> np.ndarray:
    """Returns (rows, 1) 1 in the second half of a campaign, 0 before."""
    return (time > 0.5)[:, None].astype(float)
