"""What is wrong in the written rows: names, order, gross errors, units."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmarks.trust.faults.fault import Fault, Rows


def swapped_targets(share: float) -> Fault:
    """Returns rows of which a share names another plane."""

    def rows(rows: Rows, random: np.random.Generator) -> Rows:
        count = int(rows.target.max()) + 1
        wrong = _share(len(rows.target), share, random)
        other = (rows.target + random.integers(1, count, len(wrong))) % count
        return replace(rows, target=np.where(wrong, other, rows.target))

    return Fault(("target*",), r"\btargets?\b|left out", rows=rows)


def shifted_rows(by: int) -> Fault:
    """Returns values that stand so many rows below their configurations."""
    return Fault(
        ("row*",),
        r"row order|shifted|one row (earlier|later)",
        rows=lambda rows, random: replace(rows, values=np.roll(rows.values, by, axis=0)),
    )


def gross_errors(share: float) -> Fault:
    """Returns rows of which a share is 20 to 400 mm wrong, either way."""

    def rows(rows: Rows, random: np.random.Generator) -> Rows:
        wrong = _share(len(rows.values), share, random)
        amount = random.uniform(0.02, 0.4, rows.values.shape) * random.choice([-1.0, 1.0], rows.values.shape)
        values = rows.values + amount * wrong[:, None]
        return replace(rows, values=np.abs(values) if values.shape[1] == 1 else values)

    return Fault(("gross*",), r"left out|gross", rows=rows)


def clustered_errors(share: float) -> Fault:
    """Returns a block of rows that all met something that stands 30 to 80 mm before the plate."""

    def rows(rows: Rows, random: np.random.Generator) -> Rows:
        count = len(rows.values)
        length = round(share * count)
        first = int(random.integers(0, count - length + 1))
        wrong = (np.arange(count) >= first) & (np.arange(count) < first + length)
        height = random.uniform(0.03, 0.08)
        return replace(rows, values=rows.values - height * wrong[:, None] / np.abs(rows.cosine[:, None]))

    return Fault(("gross*", "step*", "*jump*"), r"left out|gross|\bstep|jump|than before", rows=rows)


def in_millimetres() -> Fault:
    """Returns distances in millimetres under a campaign in metres."""
    return Fault(("*unit*",), r"\bunits?\b", rows=lambda rows, random: replace(rows, values=1e3 * rows.values))


def in_degrees() -> Fault:
    """Returns joints in degrees under a campaign in radians."""
    return Fault(
        ("*unit*",), r"\bunits?\b|degrees", rows=lambda rows, random: replace(rows, joints=np.rad2deg(rows.joints))
    )


def _share(count: int, share: float, random: np.random.Generator) -> np.ndarray:
    wrong = np.zeros(count, dtype=bool)
    wrong[random.choice(count, round(share * count), replace=False)] = True
    return wrong
