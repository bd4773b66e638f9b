"""Which two positions make a distance.

Each position is used once, so that errors of different distances are independent and their noise is honest: a chain
of neighbours would have twice as many distances, each sharing an end with the next, and a fit that takes them for
independent is too sure of itself. Partners are half a block apart, since rows taken one after the other are often near
each other, and short distances say little.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Int

from boresight.sensing.cell import Cell
from boresight.sensing.distances import Distances


def of_distances(cell: Cell, target: Int[np.ndarray, "rows"]) -> Int[np.ndarray, "some"]:
    """Returns the rows whose sensor reads distances."""
    own = np.array([isinstance(cell.sensors[aim.sensor], Distances) for aim in cell.aims], dtype=bool)
    return np.flatnonzero(own[target])


def pairs_of(
    cell: Cell, target: Int[np.ndarray, "rows"], session: np.ndarray | None
) -> tuple[Int[np.ndarray, "pairs"], Int[np.ndarray, "pairs"]]:
    """Returns the first and the second row of every pair; rows of one marker in one session belong together.

    Args:
        cell: the cell.
        target: (rows,) index of each row's aim.
        session: (rows,) names of the sessions, or None.
    """
    first: list[int] = []
    second: list[int] = []
    blocks: dict[tuple[int, str], list[int]] = {}
    for row in of_distances(cell, target):
        blocks.setdefault((int(target[row]), "" if session is None else str(session[row])), []).append(int(row))
    for rows in blocks.values():
        half = len(rows) // 2
        first += rows[:half]
        second += rows[half : 2 * half]
    return np.array(first, dtype=np.int64), np.array(second, dtype=np.int64)
