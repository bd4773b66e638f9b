"""A word where a command has to compile first, which happens once on a machine."""

from __future__ import annotations

import contextlib
import subprocess
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
from rich.console import Console

from boresight.kernels.compiling import first_compile_ahead
from boresight.kernels.linearising import linearise_rows


def told_of_compiling(*functions: Any, singles: Sequence[Any] = ()) -> bool:
    """Returns whether one of some compiled functions is not on disk yet; then the user has been told.

    Where evolution and least squares both have to be compiled, another process does the latter meanwhile.

    Args:
        functions: those called in double precision.
        singles: those called in single precision.
    """
    ahead = [each for each in functions if first_compile_ahead(each)]
    ahead += [each for each in singles if first_compile_ahead(each, np.float32)]
    if ahead:
        Console(stderr=True).print("Compiling for this machine; this happens once and takes about ten seconds.")
    if len(ahead) > 1 and linearise_rows in ahead:
        nothing = subprocess.DEVNULL
        command = [sys.executable, "-P", "-m", "boresight.cli.warming"]
        with contextlib.suppress(OSError):  # then this process compiles it in its turn
            subprocess.Popen(command, stdin=nothing, stdout=nothing, stderr=nothing)
    return bool(ahead)
