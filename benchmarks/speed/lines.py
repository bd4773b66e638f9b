"""The one table: a line is a workload and who did it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from benchmarks.report import Table
from benchmarks.speed.timing import Timed

HEADER = ("workload", "who", "median", "min", "x ours", "runs", "ends at", "notes")


@dataclass(frozen=True)
class Line:
    """A line of the table.

    Attributes:
        workload: what was done.
        who: did it.
        median: time [s], the main number.
        least: shortest time [s].
        runs: how many were timed.
        ratio: of medians, to ours; None for what has none to compare with.
        end: how well it ended, median over runs.
        worst: the same, worst run.
        unit: of these two.
        notes: what a reader should know.
    """

    workload: str
    who: str
    median: float
    least: float
    runs: int
    ratio: float | None = None
    end: float | None = None
    worst: float | None = None
    unit: str = ""
    notes: str = ""

    def as_row(self) -> tuple[str, ...]:
        """Returns its cells."""
        ratio = "" if self.ratio is None else f"{self.ratio:.3g}"
        end = ""
        if self.end is not None:
            worst = "" if self.worst is None or np.isclose(self.worst, self.end, rtol=1e-3) else f", {self.worst:.4g}"
            end = f"{self.end:.4g}{worst} {self.unit}".strip()
        return (
            self.workload,
            self.who,
            duration(self.median),
            duration(self.least),
            ratio,
            f"{self.runs}",
            end,
            self.notes,
        )

    def as_values(self) -> dict[str, object]:
        """Returns it as plain values."""
        return asdict(self)


def lines_of(workload: str, timed: Sequence[Timed], unit: str = "", per: float = 1.0) -> list[Line]:
    """Returns a line for each that was timed, compared with the first that is ours.

    Args:
        workload: what was done.
        timed: by whom.
        unit: of how well they ended.
        per: things done in a run, where the time of one is told.
    """
    ours = next((each.median for each in timed if each.entry.is_ours), None)
    return [
        Line(
            workload,
            each.entry.who,
            each.median / per,
            each.least / per,
            len(each.seconds),
            None if ours is None else each.median / ours,
            float(np.median(each.ends)) if each.ends else None,
            max(each.ends) if each.ends else None,
            unit,
            each.entry.notes,
        )
        for each in timed
    ]


def table_of(lines: Sequence[Line]) -> Table:
    """Returns the table; a workload is named on its first line only."""
    rows, before = [], ""
    for line in lines:
        name, *rest = line.as_row()
        rows.append(("" if name == before else name, *rest))
        before = name
    return Table("Every workload and who does it", HEADER, tuple(rows))


def duration(seconds: float) -> str:
    """Returns a time to three digits in the unit that suits it."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}" if seconds < 1000 * size else f"{seconds / size:.0f} {unit}"
    return f"{seconds / 1e-9:.3g} ns"
