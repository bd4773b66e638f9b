"""When a search ends, and why, in words."""

from __future__ import annotations

import enum
from dataclasses import dataclass


class Outcome(enum.Enum):
    """Why a search ended."""

    RUNNING = "still running"
    GENERATIONS = "all generations were used"
    COST = "the cost fell to the value asked for"
    STAGNATION = "the best member had stopped improving"
    CONVERGED = "no step improves the fit any further"
    EVALUATIONS = "the limit on evaluations was reached"


@dataclass(frozen=True, slots=True)
class Stops:
    """The limits of an evolution; generations and cost are the paper's G and V (eq. 24).

    Attributes:
        generations: G, generations after the first population.
        cost: V, the cost at which the search may stop.
        patience: generations without improvement after which it stops.
        improvement: the relative fall in the best cost that counts as one.
    """

    generations: int = 500
    cost: float = 0.0
    patience: int = 100
    improvement: float = 1e-4

    def outcome(self, generation: int, cost: float, stale: int) -> Outcome:
        """Returns why to stop now, or `Outcome.RUNNING`."""
        if cost <= self.cost:
            return Outcome.COST
        if stale >= self.patience:
            return Outcome.STAGNATION
        if generation >= self.generations:
            return Outcome.GENERATIONS
        return Outcome.RUNNING
