"""Holds, holds in part, does not hold: how a statement is judged by many seeds.

A statement is put as one or more yes-or-no questions to every seed. It holds where every question is answered yes by at
least `HOLDS` of the seeds, does not hold where every one is by less than `FAILS`, and holds in part otherwise.
"""

from __future__ import annotations

import enum
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from boresight.reproduction.measurements import Measurements
from boresight.reproduction.spread import percent

HOLDS, FAILS = 0.95, 0.5

NEAR = 1.01
"""At the optimum: an RMS range error within 1 % of it."""


class Verdict(enum.Enum):
    """How a statement stands."""

    HOLDS = "holds"
    PARTLY = "holds in part"
    FAILS = "does not hold"

    def counted(self, count: int) -> str:
        """Returns how many statements stand so, in words."""
        one, many = self.value, self.value.replace("holds", "hold").replace("does", "do")
        return f"{count} {one if count == 1 else many}"


@dataclass(frozen=True, slots=True)
class Answer:
    """A question and the share of seeds that say yes.

    Attributes:
        question: in a few words.
        share: 0 to 1.
    """

    question: str
    share: float

    def text(self) -> str:
        """Returns both."""
        return f"{self.question}: {percent(self.share)}"


@dataclass(frozen=True, slots=True)
class Finding:
    """What was measured about a statement.

    Attributes:
        answers: to its questions.
        found: by how much, in numbers.
    """

    answers: tuple[Answer, ...]
    found: str

    @property
    def verdict(self) -> Verdict:
        """How the statement stands."""
        shares = [answer.share for answer in self.answers]
        if all(share >= HOLDS for share in shares):
            return Verdict.HOLDS
        return Verdict.FAILS if all(share < FAILS for share in shares) else Verdict.PARTLY


@dataclass(frozen=True, slots=True)
class Statement:
    """One claim of the paper.

    Attributes:
        place: where it stands.
        says: the claim, in the paper's words or close to them.
        measure: finds what there is to say about it.
    """

    place: str
    says: str
    measure: Callable[[Measurements], Finding]


def share_of(yes: np.ndarray) -> float:
    """Returns the share of seeds that say yes."""
    return float(np.mean(yes))
