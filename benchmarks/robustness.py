"""What robustness costs on clean data, and what it saves where readings are grossly wrong.

- *efficiency*: variance of plain least squares over that of the robust fit, on clean campaigns, over all parameters.
- *gross errors*: 20 to 400 mm, either sign, in a share of the rows; solved as `calibrate` solves by default. `found`
  is the share of planted rows that were left out, `flagged` that of good rows. The pose error is the RMS error of
  the tool's position over the work space; its ratio is to the robust fit of the same campaign without gross errors,
  and beside it stands the ratio of least squares that was told which rows are wrong: what nobody can beat.
- *wrong*: pose error more than three times the clean one. *Silently wrong*: `calibrate` then accepts the result and
  gives no warning.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from benchmarks.parallel import on_all_cores
from benchmarks.report import Figure, Report, Table, percent, spread
from benchmarks.space_arm import Setup, draw, one_plane, pose_error, three_planes
from boresight.calibration import calibrate
from boresight.calibration.robust import fit, refine
from boresight.calibration.solve import Solver, solve
from boresight.synthetic import spoiled

SETUPS = (one_plane(100), three_planes(100), one_plane(35))
SHARES = (0.08, 0.15, 0.25)
WRONG = 3.0

NOTE = (
    "*Wrong* compares with the fit to clean readings, and *told which* with the planted rows taken out by hand. Where "
    "the pose ratio equals the latter, what is lost is the rows' information, not the fit's fault: so it is with the "
    "silently wrong results of 35 rows and 8 %, of which every planted row was found."
)


@dataclass(frozen=True)
class Spoiled:
    """The outcome of one campaign with gross errors.

    Attributes:
        found: share of planted rows that were left out.
        flagged: share of good rows that were.
        poses: pose errors [m]: clean, robust, and with the planted rows taken out by hand.
        warned: whether a result that is wrong was refused or came with a warning; None where it is not wrong.
    """

    found: float
    flagged: float
    poses: tuple[float, float, float]
    warned: bool | None


def clean(seed: int, kind: Setup) -> tuple[np.ndarray, np.ndarray, int]:
    """Returns squared errors of plain least squares and of the robust fit, and how many rows that left out."""
    drawn = draw(kind, seed)
    start = np.zeros(len(drawn.x))
    robust = fit(drawn.problem, start)
    plain = refine(drawn.problem, start).best
    return (plain - drawn.x) ** 2, (robust.x - drawn.x) ** 2, int(np.count_nonzero(~robust.kept))


def with_gross_errors(seed: int, kind: Setup, share: float) -> Spoiled:
    """Returns the outcome of a campaign with gross errors in a share of its rows."""
    drawn = draw(kind, seed)
    readings, planted = spoiled(drawn.problem.readings, share, seed)
    start = np.zeros(len(drawn.x))
    before = fit(drawn.problem, start)
    robust = solve(drawn.with_readings(readings), Solver()).fit
    told = refine(drawn.with_readings(readings).on(np.flatnonzero(~planted)), before.x).best
    poses = (
        pose_error(drawn.truth, drawn.problem.fitted(before.x)),
        pose_error(drawn.truth, drawn.problem.fitted(robust.x)),
        pose_error(drawn.truth, drawn.problem.fitted(told)),
    )
    warned = None
    if poses[1] > WRONG * poses[0]:
        result = calibrate(drawn.campaign(readings))
        warned = bool(result.warnings) or not result.verdict.accepted
    return Spoiled(float(np.mean(~robust.kept[planted])), float(np.mean(~robust.kept[~planted])), poses, warned)


def run(quick: bool) -> Report:
    cleans, count = (50, 6) if quick else (500, 60)
    figures, efficiency, gross = [], [], []
    for kind in SETUPS:
        outcomes = on_all_cores(partial(clean, kind=kind), range(cleans))
        plain, robust, out = (np.array(each) for each in zip(*outcomes, strict=True))
        ratio = plain.mean(axis=0) / robust.mean(axis=0)
        flagged = float(out.sum() / (cleans * kind.rows))
        efficiency.append((kind.name, percent(ratio.mean(), 2), percent(ratio.min(), 2), percent(flagged, 4)))
        figures.append(
            Figure(f"efficiency, clean: {kind.name}", percent(ratio.min()), ">= 95 %", bool(ratio.min() >= 0.95))
        )
    for kind in SETUPS:
        for share in SHARES:
            outcomes = on_all_cores(partial(with_gross_errors, kind=kind, share=share), range(count))
            row, of_share = _summary(kind, share, outcomes)
            gross.append(row)
            figures += of_share
    header = ("found", "flagged", "all found", "pose ratio, RMS", "told which", "wrong", "silently wrong")
    return Report(
        "robustness",
        f"{cleans} clean campaigns and {count} for each share of gross errors; see the module's docstring.",
        tuple(figures),
        (
            Table(
                "Clean data", ("campaign", "efficiency, mean", "worst parameter", "rows left out"), tuple(efficiency)
            ),
            Table("Gross errors of 20 to 400 mm", ("campaign", "share", *header), tuple(gross)),
        ),
        (NOTE,),
    )


def _summary(kind: Setup, share: float, outcomes: list[Spoiled]) -> tuple[tuple[str, ...], list[Figure]]:
    found, flagged = (np.array([getattr(o, name) for o in outcomes]) for name in ("found", "flagged"))
    squares = np.array([o.poses for o in outcomes]) ** 2
    ratio, told = np.sqrt(squares[:, 1:].mean(axis=0) / squares[:, 0].mean())
    wrong = [o for o in outcomes if o.warned is not None]
    silent = sum(not o.warned for o in wrong)
    what = f"{share:.0%} gross: {kind.name}"
    row = (
        kind.name,
        f"{share:.0%}",
        spread(found.mean(), found.std() / np.sqrt(len(found))),
        percent(flagged.mean(), 2),
        percent(float(np.mean(found == 1.0))),
        f"{ratio:.3g}",
        f"{told:.3g}",
        f"{len(wrong)} of {len(outcomes)}",
        f"{silent}",
    )
    figures = [
        Figure(f"silently wrong, {what}", f"{silent} of {len(outcomes)}", "0", silent == 0),
        Figure(f"good rows flagged, {what}", percent(flagged.mean(), 2), "<= 1 %", bool(flagged.mean() <= 0.01)),
    ]
    if share == SHARES[0]:
        figures.append(Figure(f"found, {what}", percent(found.mean()), "100 %", bool(np.all(found == 1.0))))
        figures.append(Figure(f"pose error ratio, {what}", f"{ratio:.3g}", "<= 1.3", bool(ratio <= 1.3)))
    return row, figures
