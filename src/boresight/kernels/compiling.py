"""How the hot loops are compiled: one decorator, and whether a first compile lies ahead.

Measured on one core, case 1 of the design (150 members, 35 readings, 6 links): without
`error_model="numpy"` a division may raise, so the loops stay scalar; without re-association the sums do.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba

compiled: Callable[[Callable[..., Any]], Any] = numba.njit(
    cache=True, fastmath=True, error_model="numpy", nogil=True, boundscheck=False
)
"""Compiles a function of scalars and arrays, caches it on disk, and lets other threads run meanwhile."""


def first_compile_ahead(function: Any) -> bool:
    """Returns whether calling a compiled function would compile it now instead of loading it from disk."""
    if function.signatures:
        return False
    source = Path(function.py_func.__code__.co_filename)
    index_files = Path(function.stats.cache_path).glob(f"{source.stem}.{function.__name__}-*.nbi")
    return not any(_is_newer(index, source) for index in index_files)


def _is_newer(index: Path, source: Path) -> bool:
    try:
        return index.stat().st_mtime >= source.stat().st_mtime
    except OSError:
        return False
