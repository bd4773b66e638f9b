"""Others' differential evolution, each given a cost of its own kind and ours."""

from __future__ import annotations

import importlib
import importlib.util

from benchmarks.speed.timing import Entry
from boresight.calibration.problem import Problem

PEERS = {
    "scipy": "scipy_peer",
    "pygmo": "pygmo_peer",
    "pymoo": "pymoo_peer",
    "minionpy": "minionpy_peer",
}
"""Package and the module here that puts it to work."""


def missing() -> list[str]:
    """Returns the peers that are not installed."""
    return [package for package in PEERS if importlib.util.find_spec(package) is None]


def entries(problem: Problem, generations: int, only: tuple[str, ...] = tuple(PEERS)) -> list[Entry]:
    """Returns what every peer that is installed is timed at, final errors in mm RMS."""
    present = [module for package, module in PEERS.items() if package in only and package not in missing()]
    modules = [importlib.import_module(f"benchmarks.speed.peers.{module}") for module in present]
    return [entry for module in modules for entry in module.entries(problem, generations)]
