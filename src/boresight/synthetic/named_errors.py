"""True errors that hang on a parameter's own name, so that campaigns which differ share what they have in common."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from functools import lru_cache

import numpy as np


def named_errors(widths: Mapping[str, float], seed: int) -> dict[str, float]:
    """Returns an error of each named parameter, uniform within its width [m, rad or 1].

    Each is a function of seed, name and width alone: adding a parameter changes no other's error, and the error
    grows with the width. (`perturbed` draws one after the other.)
    """
    return {name: float(width * _unit(name, seed)) for name, width in widths.items()}


def _unit(name: str, seed: int) -> float:
    """Returns a number uniform in [-1, 1): 53 bits of Philox under (seed, name)."""
    bits = int(np.random.Philox(key=np.array((seed, _word(name)), dtype=np.uint64)).random_raw())
    return 2.0 * (bits >> 11) * 2.0**-53 - 1.0


@lru_cache(maxsize=4096)
def _word(name: str) -> int:
    return int.from_bytes(hashlib.sha256(name.encode()).digest()[:8], "little")
