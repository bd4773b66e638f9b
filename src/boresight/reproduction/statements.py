"""All of the paper's statements, each beside what was measured."""

from __future__ import annotations

from dataclasses import dataclass

from boresight.reproduction.counting_statements import COUNTING_STATEMENTS
from boresight.reproduction.measurements import Measurements
from boresight.reproduction.pose_statements import POSE_STATEMENTS
from boresight.reproduction.search_statements import SEARCH_STATEMENTS
from boresight.reproduction.verdicts import Finding, Statement

STATEMENTS = (*SEARCH_STATEMENTS, *POSE_STATEMENTS, *COUNTING_STATEMENTS)
"""In the order of the page."""


@dataclass(frozen=True, slots=True)
class Judged:
    """A statement beside what was measured."""

    statement: Statement
    finding: Finding


def judge(found: Measurements) -> tuple[Judged, ...]:
    """Returns every statement beside what was measured."""
    return tuple(Judged(statement, statement.measure(found)) for statement in STATEMENTS)
