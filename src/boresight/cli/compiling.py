"""A word where a command has to compile first, which happens once on a machine."""

from __future__ import annotations

from typing import Any

from rich.console import Console

from boresight.kernels.compiling import first_compile_ahead


def told_of_compiling(*functions: Any) -> bool:
    """Returns whether one of some compiled functions is not on disk yet; then the user has been told."""
    ahead = any(first_compile_ahead(function) for function in functions)
    if ahead:
        Console(stderr=True).print("Compiling for this machine; this happens once and takes about ten seconds.")
    return ahead
