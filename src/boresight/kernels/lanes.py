"""How many members go through the loops side by side, and where each of a tile's numbers begins.

A tile's numbers lie side by side, so that vector code needs no remainder and a tile's links stay in the first-level
cache: as many lanes as fill the same bytes in either precision, 40 in double and 80 in single. Tried on one core (150
members, 35 readings, six links, aligned, 512-bit; ns a range in double precision): 16 lanes 7.3, 32 lanes 3.8, 40 lanes
3.3, 80 lanes 4.3; in single precision 32 lanes 3.5, 40 lanes 4.0, 80 lanes 2.7. Vectorised over readings instead, the
loop reaches 4.9 at 1,000 readings, but 20 at 35, where the start of each short loop dominates.

What follows from the precision of an array is a constant wherever it is compiled: an offset that is computed may cost
vector code. Offsets are unsigned for the same reason.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numba.extending import overload

_TILE_BYTES = 320


def tile(real: type[np.floating]) -> int:
    """Returns the number of lanes of a tile in a precision."""
    return _TILE_BYTES // np.dtype(real).itemsize


def padded(count: int, real: type[np.floating] = np.float64) -> int:
    """Returns the number of lanes that hold `count` members in whole tiles."""
    return -(-count // tile(real)) * tile(real)


def _constant(of_lanes: Callable[[int], Any]) -> Callable[[np.ndarray], Any]:
    """Returns a function of an array, compiled to what follows from its precision."""

    def found(numbers: np.ndarray) -> Any:
        return of_lanes(_TILE_BYTES // numbers.itemsize)

    @overload(found)
    def _compiled(numbers):
        value = of_lanes(8 * _TILE_BYTES // numbers.dtype.bitwidth)
        return lambda numbers: value

    return found


lanes_of = _constant(np.uint64)
"""Returns the lanes of a tile of an array's precision."""

is_single = _constant(lambda lanes: lanes == tile(np.float32))
"""Returns whether an array is in single precision."""

plane_offsets = _constant(lambda lanes: tuple(np.uint64(k * lanes) for k in range(4)))
"""Returns where n_x, n_y, n_z and f begin among a plane's numbers."""

link_offsets = _constant(lambda lanes: tuple(np.uint64(k * lanes) for k in range(12)))
"""Returns where R, column by column, and t begin among a link's numbers."""
