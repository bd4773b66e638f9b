"""What many outcomes of a point say together: medians, quantiles, and shares with what chance leaves open."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from boresight.studies.grid import Point, Study
from boresight.studies.outcome import Outcome
from boresight.studies.store import Store

_Z_95 = 1.959963984540054


@dataclass(frozen=True, slots=True)
class Spread:
    """Quantiles of one number over the runs of a point.

    Attributes:
        low: 10 % of the runs lie below.
        median: half do.
        high: 90 % do.
    """

    low: float
    median: float
    high: float


@dataclass(frozen=True, slots=True)
class Share:
    """How many of some cases, with the 95 % interval that so many cases allow (Wilson 1927).

    Attributes:
        count: how many.
        of: of how many.
    """

    count: int
    of: int

    @property
    def value(self) -> float:
        """The share; NaN of none."""
        return self.count / self.of if self.of else float("nan")

    @property
    def interval(self) -> tuple[float, float]:
        """Where the true share lies with 95 % confidence."""
        if not self.of:
            return float("nan"), float("nan")
        z2 = _Z_95**2 / self.of
        centre = (self.value + z2 / 2.0) / (1.0 + z2)
        half = math.sqrt(self.value * (1.0 - self.value) * z2 + z2**2 / 4.0) / (1.0 + z2)
        return max(0.0, centre - half), min(1.0, centre + half)


@dataclass(frozen=True)
class PointSummary:
    """The outcomes of one point.

    Attributes:
        point: which.
        outcomes: by seed.
    """

    point: Point
    outcomes: dict[int, Outcome]

    @property
    def good(self) -> list[Outcome]:
        """The outcomes of runs that could be made."""
        return [outcome for outcome in self.outcomes.values() if not outcome.failure]

    @property
    def failed(self) -> int:
        """Number of runs that could not."""
        return len(self.outcomes) - len(self.good)

    @property
    def reached(self) -> Share:
        """How often the search ended at the optimum."""
        return Share(sum(outcome.reached for outcome in self.good), len(self.good))

    @property
    def found(self) -> Share:
        """How many of the rows that are grossly wrong were found."""
        return Share(sum(o.found for o in self.good), sum(o.planted for o in self.good))

    def spread(self, number: str | Callable[[Outcome], float]) -> Spread:
        """Returns the quantiles of one of an outcome's numbers, or of what is made of them."""
        take = number if callable(number) else lambda outcome: float(getattr(outcome, number))
        values = np.array([take(outcome) for outcome in self.good])
        values = values[np.isfinite(values)]
        if not values.size:
            return Spread(float("nan"), float("nan"), float("nan"))
        return Spread(*(float(q) for q in np.quantile(values, (0.1, 0.5, 0.9))))


@dataclass(frozen=True)
class Summary:
    """A study as far as it is done.

    Attributes:
        study: what was asked.
        points: the outcomes of each of its points.
    """

    study: Study
    points: tuple[PointSummary, ...]

    @property
    def done(self) -> int:
        """Number of runs made."""
        return sum(len(each.outcomes) for each in self.points)


def summarise(study: Study, store: Store) -> Summary:
    """Returns what a store holds of a study."""
    return Summary(study, tuple(PointSummary(point, store.outcomes(point, study.seeds)) for point in study.points))
