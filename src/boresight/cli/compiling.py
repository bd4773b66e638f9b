"""A word where a command has to compile first, which happens once on a machine."""

from __future__ import annotations

import contextlib
import subprocess
import sys
from typing import Any

from rich.console import Console

from boresight.kernels.compiling import cached_on_disk, first_compile_ahead
from boresight.kernels.evolving import evolve_generations
from boresight.kernels.linearising import linearise_rows
from boresight.search import Device

_ONCE = "Compiling for this machine; this happens once and takes about ten seconds."
_EVERY_TIME = (
    "Compiling in memory, which takes about ten seconds every time: there is no place to keep what is compiled; name a "
    "folder of yours in NUMBA_CACHE_DIR."
)


def told_of_compiling(*functions: Any, evolves: Device | None = None) -> bool:
    """Returns whether one of some compiled functions is not on disk yet; then the user has been told.

    Where evolution and least squares both have to be compiled, another process does the latter meanwhile.

    Args:
        functions: those called in double precision.
        evolves: where evolution runs, in its precision; None where it does not.
    """
    ahead = [each for each in functions if first_compile_ahead(each)]
    if evolves is not None and not evolves.on_card and first_compile_ahead(evolve_generations, evolves.real):
        ahead.append(evolve_generations)
    if ahead:
        kept = all(cached_on_disk(each) for each in ahead)
        Console(stderr=True).print(_ONCE if kept else _EVERY_TIME)
    if len(ahead) > 1 and linearise_rows in ahead and cached_on_disk(linearise_rows):
        nothing = subprocess.DEVNULL
        command = [sys.executable, "-P", "-m", "boresight.cli.warming"]
        with contextlib.suppress(OSError):  # then this process compiles it in its turn
            subprocess.Popen(command, stdin=nothing, stdout=nothing, stderr=nothing)
    return bool(ahead)
