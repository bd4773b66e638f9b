"""How the hot loops are compiled: one decorator, and whether a first compile lies ahead.

Measured on one core, case 1 of the design (150 members, 35 readings, 6 links): without
`error_model="numpy"` a division may raise, so the loops stay scalar; without re-association the sums do.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import llvmlite.binding
import numba
import numpy as np
from numba.core import config

from boresight.kernels.caching import cache_of

_host = llvmlite.binding.get_host_cpu_features()
if _host.get("avx512f") and config.CPU_FEATURES is None:  # type: ignore[attr-defined]
    # LLVM keeps to half the vector width of processors with AVX-512; these loops ran 1.6 times faster at the whole
    config.CPU_FEATURES = f"{_host.flatten()},-prefer-256-bit"  # type: ignore[attr-defined]

_NEWEST = max(source.stat().st_mtime for source in Path(__file__).parent.glob("*.py"))


def compiled(function: Callable[..., Any]) -> Any:
    """Returns a function of numbers and arrays compiled, cached on disk, and not holding other threads up.

    Whatever it calls becomes part of it. A function that is called may otherwise stand in a process twice, compiled for
    itself and once more for its caller, and the process that compiled ran another copy than one that loads from disk:
    the last digits differed, and with them the path of a search. It is also faster, as nothing counts references: a
    case-1 identification takes 10.4 ms instead of 13.0.

    The cache knows when the function's own file changes but not when those it calls do, so what was cached
    before the newest file of this package is dropped.
    """
    dispatcher: Any = numba.njit(fastmath=True, error_model="numpy", nogil=True, forceinline=True)(function)
    cache = cache_of(function)
    if cache is not None:
        dispatcher._cache = cache
    for index in _cached(dispatcher):
        with contextlib.suppress(OSError):
            if index.stat().st_mtime < _NEWEST:
                index.unlink()
    return dispatcher


def first_compile_ahead(function: Any, real: type[np.floating] = np.float64) -> bool:
    """Returns whether calling a compiled function would compile it now instead of loading it from disk.

    Args:
        function: what `compiled` returned.
        real: the precision that it is called in; in either, it is compiled for itself.
    """
    is_single = ["float32" in str(signature) for signature in function.signatures]
    for index in _cached(function):
        try:
            known = index.read_bytes()  # names the types of each version that was compiled, and the file it lies in
        except OSError:
            continue
        singles = int(b"float32" in known)
        is_single += [True] * singles + [False] * (known.count(b".nbc") - singles)
    return (np.dtype(real) == np.float32) not in is_single


def cached_on_disk(function: Any) -> bool:
    """Returns whether there is a place where what is compiled can be kept."""
    return function.stats.cache_path is not None


def _cached(dispatcher: Any) -> list[Path]:
    """Returns the index files under which a compiled function lies on disk."""
    if not cached_on_disk(dispatcher):
        return []
    stem = Path(dispatcher.py_func.__code__.co_filename).stem
    return list(Path(dispatcher.stats.cache_path).glob(f"{stem}.{dispatcher.py_func.__name__}-*.nbi"))
