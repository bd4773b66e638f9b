"""A word where a command has to compile first, which happens once on a machine."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from rich.console import Console

from boresight.kernels.compiling import first_compile_ahead


def told_of_compiling(*functions: Any, singles: Sequence[Any] = ()) -> bool:
    """Returns whether one of some compiled functions is not on disk yet; then the user has been told.

    Args:
        functions: those called in double precision.
        singles: those called in single precision.
    """
    ahead = any(first_compile_ahead(each) for each in functions)
    ahead = ahead or any(first_compile_ahead(each, np.float32) for each in singles)
    if ahead:
        Console(stderr=True).print("Compiling for this machine; this happens once and takes about ten seconds.")
    return ahead
