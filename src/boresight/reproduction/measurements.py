"""All trials together, and the runs that stand for them in figures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from boresight.reproduction.setting import CASES
from boresight.reproduction.spread import Spread
from boresight.reproduction.trials import Run, Trial
from boresight.reproduction.variants import CHOSEN, Variant


@dataclass(frozen=True)
class Measurements:
    """What was found for every seed.

    Attributes:
        trials: one a seed, in their order.
        modern: whether modern differential evolution was among the methods.
    """

    trials: tuple[Trial, ...]
    modern: bool

    def runs(self, method: str, rows: int, under: str = CHOSEN) -> list[Run]:
        """Returns the runs of a variant, one a seed."""
        return [trial.runs[Variant(method, rows, under)] for trial in self.trials]

    def values(
        self, number: Callable[[Run], float], method: str, rows: int, under: str = CHOSEN
    ) -> Float[np.ndarray, "seeds"]:
        """Returns a number of each run of a variant."""
        return np.array([number(run) for run in self.runs(method, rows, under)])

    def spread(self, number: Callable[[Run], float], method: str, rows: int, under: str = CHOSEN) -> Spread:
        """Returns the spread of a number over the runs of a variant."""
        return Spread.of(self.values(number, method, rows, under))

    def middle(self, number: Callable[[Run], float], method: str, rows: int) -> tuple[int, Run]:
        """Returns the seed and the run whose number is the median one (the lower of two)."""
        place = int(np.argsort(self.values(number, method, rows), kind="stable")[(len(self.trials) - 1) // 2])
        return self.trials[place].seed, self.trials[place].runs[Variant(method, rows)]

    @cached_property
    def typical(self) -> Trial:
        """The trial nearest to the median in both cases: by rank of the trade-off's validation position error."""
        far = np.zeros(len(self.trials))
        for rows in CASES.values():
            order = np.argsort(
                self.values(lambda run: run.validation.position_rms_mm, "trade-off", rows), kind="stable"
            )
            rank = np.empty(len(order))
            rank[order] = np.arange(len(order))
            far += np.abs(rank - (len(order) - 1) / 2)
        return self.trials[int(np.argmin(far))]
