"""Slips that no small correction mends, tried one by one where a fit is bad.

A plane whose offset has the wrong sign, two targets exchanged, rows that name another target, a joint that counts the
other way round, readings that stand one row too early or too late: each is made undone, and told where the readings
then fit.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from boresight.calibration.frames import find_frames
from boresight.calibration.gross import beyond_help
from boresight.calibration.problem import MISSED_M, Problem
from boresight.calibration.robust import Fit
from boresight.calibration.thinning import thinned
from boresight.errors import InputError
from boresight.geometry import Plane
from boresight.inference import listed
from boresight.inference.score_tests import QUADRATIC, fit_robustly
from boresight.sensing import Cell, Readings
from boresight.sensing.linear import slopes_of

ROWS = 300
"""Rows that stand for many."""

NEARER = 0.3
"""An alternative is fitted where the nominal errors' median falls to this share, or as many more rows fit."""

BETTER = 0.25
"""It explains the readings where what it leaves falls to this share."""

FITTED, STEPS = 4, 8
FEWEST = 3
SETTLED = 0.01


@dataclass(frozen=True, slots=True)
class Alternative:
    """A slip that explains the readings.

    Attributes:
        effect: what it is: `deck flipped`, `j3 counts backwards`, `targets`, `row order`.
        words: what it is and what to do, a sentence without its full stop.
        ratio_before: residuals over the stated noise as the result is, rows that were left out counted.
        ratio_after: the same with the slip undone.
    """

    effect: str
    words: str
    ratio_before: float
    ratio_after: float

    @property
    def sentence(self) -> str:
        """What a person should know."""
        return (
            f"{self.words}: residuals fall from {self.ratio_before:.2g}x to {self.ratio_after:.2g}x the stated noise."
        )


def find_alternatives(found: Fit, nominal: Cell, unknown: frozenset[str], seed: int) -> tuple[Alternative, ...]:
    """Returns the slips that explain what a bad fit leaves, the best first.

    Args:
        found: the fit.
        nominal: the cell before it.
        unknown: parameters of frames that nobody has measured: they are found anew for each slip.
        seed: of that search.
    """
    free = tuple(f for f in found.problem.freedoms if f.parameter in nominal.index)
    problem = Problem(nominal, found.problem.readings, free)
    problem = problem.on(thinned(problem.readings, ROWS))
    before, cost = _typical(problem), _fitted_cost(problem)
    promising = []
    for effect, words, cell, readings in _slips(nominal, problem.readings):
        trial = _placed(replace(problem, cell=cell, readings=readings), unknown, seed)
        if trial is not None and (typical := _typical(trial)) <= NEARER * before:
            promising.append((typical, effect, words, trial))
    told = []
    for _, effect, words, trial in sorted(promising, key=lambda each: each[0])[:FITTED]:
        after = _fitted_cost(trial)
        if after <= BETTER**2 * cost:
            told.append(Alternative(effect, words, _ratio(cost, problem), _ratio(after, problem)))
    return tuple(sorted(told, key=lambda each: each.ratio_after))


def _placed(problem: Problem, unknown: frozenset[str], seed: int) -> Problem | None:
    """Returns the problem with its unknown frames where these readings put them; None where there is no such place."""
    if not unknown - set(problem.cell.offsets):
        return problem
    try:
        return replace(problem, cell=find_frames(problem.cell, problem.readings, unknown, seed))
    except InputError:
        return None


def _typical(problem: Problem) -> float:
    """Returns the mean of the nominal errors' square roots, squared [m]: rows that fit count, gross ones little."""
    errors = np.abs(np.nan_to_num(problem.errors(np.zeros(len(problem.names))), nan=MISSED_M))
    return float(np.mean(np.sqrt(errors[problem.readings.read]))) ** 2


def _fitted_cost(problem: Problem) -> float:
    """Returns what a robust fit leaves, over the stated variances, gross residuals by their size."""
    x, read, std = np.zeros(len(problem.names)), problem.readings.read, problem.readings.std
    precision, cost = 1.0 / problem.prior_std**2, np.inf
    for _ in range(STEPS):
        errors = problem.errors(x)
        missed = read & ~np.isfinite(errors)
        seen = read & ~missed
        columns = (slopes_of(problem.model, x, problem.readings) / std[:, :, None])[seen]
        step = fit_robustly(columns, -errors[seen] / std[seen], precision, x)
        far = MISSED_M / std[missed]
        now = step.cost + float(np.sum(QUADRATIC * (2.0 * far - QUADRATIC)))
        if now > (1.0 - SETTLED) * cost:
            break
        cost, x = now, np.clip(x + step.step, -problem.half_width, problem.half_width)
    return min(cost, now)


def _ratio(cost: float, problem: Problem) -> float:
    return float(np.sqrt(cost / max(problem.readings.count - len(problem.names), 1)))


def _slips(cell: Cell, readings: Readings) -> Iterator[tuple[str, str, Cell, Readings]]:
    """Yields each slip: its name, what to do, and cell and readings without it."""
    planes = {name: target for name, target in cell.targets.items() if isinstance(target, Plane)}
    for count in range(1, len(planes) + 1):
        for names in itertools.combinations(planes, count) if len(planes) <= 4 or count in (1, len(planes)) else ():
            turned = {name: Plane.of(planes[name].normal, -planes[name].offset) for name in names}
            whose = f"`{names[0]}`" if count == 1 else listed([f"`{name}`" for name in names])
            yield (
                f"{names[0] if count == 1 else 'planes'} flipped",
                f"The offset of {whose} with the other sign explains the readings; a plane is n·p + offset = 0",
                replace(cell, targets={**cell.targets, **turned}),
                readings,
            )
    yield from _exchanged(cell, readings)
    for place, name in enumerate(cell.arm.joint_names):
        sign = np.where(np.arange(readings.joints.shape[1]) == place, -1.0, 1.0)
        since = None if readings.since is None else readings.since * sign
        yield (
            f"{name} counts backwards",
            f"Joint {name} counts the other way round than the robot's file says: negate its readings",
            cell,
            replace(readings, joints=readings.joints * sign, since=since),
        )
    names = cell.arm.joint_names
    for first, second in itertools.combinations(range(len(names)), 2):
        joints = readings.joints.copy()
        joints[:, [first, second]] = joints[:, [second, first]]
        yield (
            "joint columns",
            f"The columns of joints {names[first]} and {names[second]} are exchanged",
            cell,
            replace(readings, joints=joints),
        )
    for shift, word in ((1, "earlier"), (-1, "later")):
        joints = np.roll(readings.joints, shift, axis=0)
        yield (
            "row order",
            f"Each reading belongs to the configuration one row {word}",
            cell,
            replace(readings, joints=joints),
        )
        if cell.targets:
            yield (
                "row order",
                f"Each reading belongs to the configuration and target one row {word}",
                cell,
                replace(readings, joints=joints, target=np.roll(readings.target, shift)),
            )


def _exchanged(cell: Cell, readings: Readings) -> Iterator[tuple[str, str, Cell, Readings]]:
    """Yields targets exchanged in all rows, and each row with the target that fits it best."""
    aims = cell.aims
    same = {
        place: [
            k for k, other in enumerate(aims) if (other.sensor, other.mount) == (aim.sensor, aim.mount) and other.target
        ]
        for place, aim in enumerate(aims)
    }
    used = [name for name in cell.targets if any(aims[k].target == name for k in np.unique(readings.target))]
    for first, second in itertools.combinations(used, 2):
        swap = {first: second, second: first}
        renamed = [
            next((k for k in same[p] if aims[k].target == swap.get(aims[p].target or "", aims[p].target)), p)
            for p in range(len(aims))
        ]
        yield (
            "targets",
            f"Targets `{first}` and `{second}` are exchanged in the rows' column target",
            cell,
            replace(readings, target=np.array(renamed)[readings.target]),
        )
    if len(used) < 2:
        return
    sizes = np.full((len(aims), len(readings)), np.inf)
    for place in range(len(aims)):
        own = np.array([place if place in same[p] else p for p in readings.target])
        errors = np.linalg.norm(cell.errors(replace(readings, target=own)), axis=1)
        sizes[place] = np.where(own == place, np.nan_to_num(errors, nan=MISSED_M), np.inf)
    given = sizes[readings.target, np.arange(len(readings))]
    best = np.argmin(sizes, axis=0)
    usual = 3.0 * float(np.median(np.min(sizes, axis=0))) + 1e-6
    wrong = (given > 3.0 * usual) & (np.min(sizes, axis=0) < usual)
    if np.count_nonzero(wrong) >= FEWEST:
        lines = [str(line) for line in readings.line[wrong]]
        plural = "s" if len(lines) > 1 else ""
        yield (
            "targets",
            f"{len(lines)} row{plural} fit another target than the one they name (line{plural} {listed(lines)})",
            cell,
            replace(readings, target=np.where(wrong, best, readings.target)),
        )


def is_bad(found: Fit, unknown: frozenset[str]) -> bool:
    """Returns whether a fit leaves so much that slips are worth trying; frames found anew each time take longer."""
    left_out = int(np.count_nonzero(~found.kept))
    return beyond_help(found) or left_out > 0.1 * len(found.kept) or (not unknown and left_out >= FEWEST)
