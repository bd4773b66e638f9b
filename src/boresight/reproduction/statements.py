"""The paper's statements, each with its place, and how it is held against what was measured.

A statement is put as one or more yes-or-no questions to every seed. It holds where every question is answered yes by at
least `HOLDS` of the seeds, does not hold where every one is by less than `FAILS`, and holds in part otherwise.
"""

from __future__ import annotations

import enum
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from boresight.inference import everett_count
from boresight.reproduction.measurements import Measurements
from boresight.reproduction.setting import CASES, STOPS
from boresight.reproduction.spread import Spread, percent, plain
from boresight.reproduction.trials import Run
from boresight.reproduction.variants import AZIMUTH_FREE, NOMINAL

HOLDS, FAILS = 0.95, 0.5

ONE, TWO = CASES[1], CASES[2]

FAR = 10.0
""""Far lower" efficiency: a final cost at least this many times the trade-off's."""

NEAR = 1.01
"""At the optimum: an RMS range error within 1 % of it."""

SIGNIFICANT = 2.0
"""A "significant" or "authentic" improvement: errors at least this many times smaller."""

EARLY_MM = 5.0
"""Fast at first: fewer generations to an RMS range error below this."""

STEEP = 100
"""Generations that count as "the beginning"."""


class Verdict(enum.Enum):
    """How a statement stands."""

    HOLDS = "holds"
    PARTLY = "holds in part"
    FAILS = "does not hold"


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


def _share(yes: np.ndarray) -> float:
    return float(np.mean(yes))


def _position(run: Run) -> float:
    return run.validation.position_rms_mm


def _orientation(run: Run) -> float:
    return run.validation.orientation_rms_mrad


def _cost(run: Run) -> float:
    return run.cost_mm2


def _starts(found: Measurements) -> Finding:
    before = {rows: found.values(lambda run: run.range_max_mm, NOMINAL, rows) for rows in (ONE, TWO)}
    return Finding(
        tuple(Answer(f"case {case}, above 30 mm", _share(before[rows] > 30.0)) for case, rows in CASES.items()),
        f"Largest error before: case 1 {Spread.of(before[ONE]).text()} mm, case 2 {Spread.of(before[TWO]).text()} mm.",
    )


def _ends(found: Measurements) -> Finding:
    after = {rows: found.values(lambda run: run.range_max_mm, "trade-off", rows) for rows in (ONE, TWO)}
    real = [
        found.spread(lambda run: float(np.max(np.abs(run.real_range_mm))), "trade-off", rows) for rows in (ONE, TWO)
    ]
    return Finding(
        tuple(Answer(f"case {case}, below 0.2 mm", _share(after[rows] < 0.2)) for case, rows in CASES.items()),
        f"Largest error after: case 1 {Spread.of(after[ONE]).text()} mm, case 2 {Spread.of(after[TWO]).text()} mm; "
        f"against ranges without noise {real[0].text()} and {real[1].text()} mm.",
    )


def _classical(found: Measurements) -> Finding:
    ratio = {
        (name, rows): found.values(_cost, name, rows) / found.values(_cost, "trade-off", rows)
        for name in ("rand/1", "best/1")
        for rows in (ONE, TWO)
    }
    worse = {key: _share(each > 1.0) for key, each in ratio.items()}
    return Finding(
        tuple(
            Answer(f"{name}, case 1, cost ≥ {FAR:.0f} × the trade-off's", _share(ratio[name, ONE] >= FAR))
            for name in ("rand/1", "best/1")
        ),
        "Final cost over the trade-off's, case 1: "
        f"rand/1 {Spread.of(ratio['rand/1', ONE]).text()}, best/1 {Spread.of(ratio['best/1', ONE]).text()} "
        f"(larger at all in {percent(worse['best/1', ONE])} of seeds); case 2, which the paper does not show: "
        f"{Spread.of(ratio['rand/1', TWO]).text()} and {Spread.of(ratio['best/1', TWO]).text()}.",
    )


def generations_to(run: Run, rms_mm: float) -> float:
    """Returns the first generation whose best member's RMS range error is below a value; infinite if none is."""
    below = np.flatnonzero(run.history_mm2 < len(run.range_mm) * rms_mm**2)
    return float(below[0]) if len(below) else np.inf


def _slow(found: Measurements) -> Finding:
    ends = {rows: found.values(lambda run: run.range_rms_mm, "rand/1", rows) for rows in (ONE, TWO)}
    far = {rows: found.values(lambda run: run.from_optimum, "rand/1", rows) for rows in (ONE, TWO)}
    return Finding(
        tuple(
            Answer(f"case {case}, ends ≥ {FAR:.0f} × the optimum", _share(far[r] >= FAR)) for case, r in CASES.items()
        ),
        f"RMS range error after 500 generations: case 1 {Spread.of(ends[ONE]).text()} mm, case 2 "
        f"{Spread.of(ends[TWO]).text()} mm; the optimum's is {plain(np.median(ends[ONE] / far[ONE]))} and "
        f"{plain(np.median(ends[TWO] / far[TWO]))} mm.",
    )


def _caught(found: Measurements) -> Finding:
    def early(name: str, rows: int) -> np.ndarray:
        return found.values(lambda run: generations_to(run, EARLY_MM), name, rows)

    ends = {rows: found.values(lambda run: run.from_optimum, "best/1", rows) for rows in (ONE, TWO)}
    return Finding(
        (
            *(
                Answer(
                    f"case {case}, sooner below {EARLY_MM:.0f} mm", _share(early("best/1", r) < early("trade-off", r))
                )
                for case, r in CASES.items()
            ),
            *(Answer(f"case {case}, ends above the optimum", _share(ends[r] > NEAR)) for case, r in CASES.items()),
        ),
        f"Generations to {EARLY_MM:.0f} mm RMS, case 1: best/1 {Spread.of(early('best/1', ONE)).text(2)}, trade-off "
        f"{Spread.of(early('trade-off', ONE)).text(2)}. Final RMS over the optimum's: case 1 "
        f"{Spread.of(ends[ONE]).text()}, case 2 {Spread.of(ends[TWO]).text()}.",
    )


def _declines(found: Measurements) -> Finding:
    answers, said = [], []
    for case, rows in CASES.items():
        runs = found.runs("trade-off", rows)
        decades = [
            np.log10(run.history_mm2[[0, STEEP, -STEEP - 1, -1]]) for run in runs if len(run.history_mm2) > STEEP
        ]
        first, last = (np.array([d[i] - d[i + 1] for d in decades]) for i in (0, 2))
        whole = np.array([len(run.history_mm2) == STOPS.generations + 1 for run in runs])
        answers += [
            Answer(f"case {case}, steeper at first", _share(first > last)),
            Answer(f"case {case}, runs to generation 500", _share(whole)),
        ]
        said.append(
            f"case {case}: {Spread.of(first).text(2)} decades in the first {STEEP} generations, "
            f"{Spread.of(last).text(2)} in the last; H ends at {found.spread(_cost, 'trade-off', rows).text(2)} mm²"
        )
    return Finding(tuple(answers), f"{'; '.join(said)}. V = 0.0001 mm² lies below what noise leaves.".capitalize())


def _stable(found: Measurements) -> Finding:
    ends = {rows: found.values(lambda run: run.from_optimum, "trade-off", rows) for rows in (ONE, TWO)}
    return Finding(
        tuple(
            Answer(f"case {case}, within 1 % of the optimum", _share(ends[rows] < NEAR)) for case, rows in CASES.items()
        ),
        f"Final RMS range error over the optimum's: case 1 {Spread.of(ends[ONE]).text(4)}, worst "
        f"{plain(ends[ONE].max(), 4)}; case 2 {Spread.of(ends[TWO]).text(4)}, worst {plain(ends[TWO].max(), 4)}.",
    )


def _improves(found: Measurements) -> Finding:
    answers, said = [], []
    for case, rows in CASES.items():
        factor = {
            name: found.values(number, NOMINAL, rows) / found.values(number, "trade-off", rows)
            for name, number in (("position", _position), ("orientation", _orientation))
        }
        answers += [
            Answer(f"case {case}, {name} ≥ {SIGNIFICANT:.0f} × better", _share(each >= SIGNIFICANT))
            for name, each in factor.items()
        ]
        said.append(
            f"case {case}: position {Spread.of(factor['position']).text()} times, orientation "
            f"{Spread.of(factor['orientation']).text()} times smaller (RMS, validation)"
        )
    return Finding(tuple(answers), f"{'; '.join(said)}.".capitalize())


def _more_is_better(found: Measurements) -> Finding:
    position = {rows: found.values(_position, "trade-off", rows) for rows in (ONE, TWO)}
    orientation = {rows: found.values(_orientation, "trade-off", rows) for rows in (ONE, TWO)}
    return Finding(
        (
            Answer("position better in case 2", _share(position[TWO] < position[ONE])),
            Answer("orientation better in case 2", _share(orientation[TWO] < orientation[ONE])),
        ),
        f"Validation RMS: {Spread.of(position[ONE]).text()} → {Spread.of(position[TWO]).text()} mm, "
        f"{Spread.of(orientation[ONE]).text()} → {Spread.of(orientation[TWO]).text()} mrad; case 2 is better by "
        f"{Spread.of(position[ONE] / position[TWO]).text()} times in position.",
    )


def _calibration_is_better(found: Measurements) -> Finding:
    answers, said = [], []
    for case, rows in CASES.items():
        ratio = {
            "position": found.values(lambda run: _position(run) / run.calibration.position_rms_mm, "trade-off", rows),
            "orientation": found.values(
                lambda run: _orientation(run) / run.calibration.orientation_rms_mrad, "trade-off", rows
            ),
        }
        answers += [Answer(f"case {case}, {name} better there", _share(each > 1.0)) for name, each in ratio.items()]
        said.append(
            f"case {case}: position {Spread.of(ratio['position']).text()}, orientation "
            f"{Spread.of(ratio['orientation']).text()}"
        )
    return Finding(tuple(answers), f"RMS in validation over RMS where readings were taken, {'; '.join(said)}.")


def _configurations(found: Measurements) -> Finding:
    number = {rows: found.values(_position, "trade-off", rows) for rows in (35, 50, 100, 200)}
    steps = ((35, 100), (100, 200))
    return Finding(
        tuple(Answer(f"{more} better than {few}", _share(number[more] < number[few])) for few, more in steps),
        "Validation position RMS: "
        + ", ".join(f"{rows} configurations {Spread.of(values).text()} mm" for rows, values in number.items())
        + ".",
    )


def _twenty_five(found: Measurements) -> Finding:
    seen = np.array([trial.ranks.of_paper for trial in found.trials])
    return Finding(
        (Answer("rank 25 of the 26 parameters of eq. (19)", _share(seen == 25)),),
        f"Rank of the 24 link parameters and n_x, n_z together: {_counts(seen)}. `j1.theta` and n_x are one direction.",
    )


def _counted(found: Measurements) -> Finding:
    plane = np.array([trial.ranks.of_one_plane for trial in found.trials])
    return Finding(
        (Answer("25 of 30 seen", _share(plane == 25)),),
        f"Ranges to one known plane see {_counts(plane)} of the arm's 30 independent parameters. Hidden are the spin "
        "about the beam and three motions of the base along and about the plane: four, not five. The number 25 comes "
        "out for another reason: the plane is identified too.",
    )


def _everett(found: Measurements) -> Finding:
    pose = np.array([trial.ranks.of_pose for trial in found.trials])
    return Finding(
        (
            Answer("rank 30 where the whole pose is measured", _share(pose == 30)),
            Answer("C = 2R + 2P + 6 gives that rank", _share(pose == 2 * 6 + 6)),
        ),
        f"Measured rank: {_counts(pose)}. As printed the formula gives {2 * 6 + 6} for six revolute joints; with 4R, "
        f"as Everett has it, {everett_count(6, 0)}. The 30 is right, the 2R a misprint.",
    )


def _floor(found: Measurements) -> Finding:
    seen = np.array([trial.ranks.of_floor for trial in found.trials])
    blind = [set(trial.ranks.blind_to) == {"j1.theta", "j1.a", "j3.d"} for trial in found.trials]
    return Finding(
        (
            Answer("exactly these three change no range", _share(np.array(blind))),
            Answer("rank 21 of 24", _share(seen == 21)),
        ),
        f"Rank of the 24 link parameters: {_counts(seen)}. They only slide and turn the arm along the plane.",
    )


def _minor(found: Measurements) -> Finding:
    answers, said = [], []
    for case, rows in CASES.items():
        fixed = found.values(_position, "trade-off", rows)
        free = found.values(_position, "trade-off", rows, AZIMUTH_FREE)
        turned = found.values(lambda run: run.validation_turned.position_rms_mm, "trade-off", rows, AZIMUTH_FREE)
        answers += [
            Answer(f"case {case}, ≤ 1.5 × the error, in the base's frame", _share(free <= 1.5 * fixed)),
            Answer(f"case {case}, the same with the turn removed", _share(turned <= 1.5 * fixed)),
        ]
        said.append(
            f"case {case}: {Spread.of(fixed).text()} mm with theta_1 fixed, {Spread.of(free).text()} mm with it free, "
            f"{Spread.of(turned).text()} mm once the base's turn is removed"
        )
    return Finding(tuple(answers), f"Validation position RMS, {'; '.join(said)}.")


def _counts(ranks: np.ndarray) -> str:
    """Returns the ranks that occur, the commonest first."""
    values, counts = np.unique(ranks, return_counts=True)
    order = np.argsort(-counts)
    if len(values) == 1:
        return str(values[0])
    return ", ".join(f"{values[i]} in {percent(counts[i] / len(ranks))} of seeds" for i in order)


STATEMENTS = (
    Statement(
        "section 4.4, figure 4", "Before calibration the maximum distance errors are “more than 30 mm”.", _starts
    ),
    Statement("section 4.4, figure 4", "After it they are “less than 0.2 mm for the first and second cases”.", _ends),
    Statement(
        "section 4.4, figure 3; abstract 2",
        "“Optimization efficiency of the first two classical strategies is far lower than that of the third.”",
        _classical,
    ),
    Statement(
        "section 3.2",
        "DE/rand/1 is diverse, its convergence inferior: “the desired level is difficult to be gained”.",
        _slow,
    ),
    Statement("section 3.2", "DE/best/1 is “very fast initially but easily gets into local minima later”.", _caught),
    Statement(
        "section 4.4, figure 3 (c, d)",
        "Costs “decline steeply in the beginning, then turn gentle”, and end at 500 iterations, V never met.",
        _declines,
    ),
    Statement(
        "section 4.4", "The improved DE shows “stability and rapidity in spite of … larger measurement noise”.", _stable
    ),
    Statement(
        "abstract 1; section 4.4, table 5",
        "“A significant improvement of pose accuracy … can be obtained by distance measurement only.”",
        _improves,
    ),
    Statement(
        "section 4.4, table 5", "In validation, case 2 improves pose accuracy more than case 1.", _more_is_better
    ),
    Statement("abstract 3; section 5", "More calibration configurations give better results.", _configurations),
    Statement(
        "section 4.4, figures 5 to 7",
        "“Pose accuracy in the calibration configurations is superior to that in the validation configuration.”",
        _calibration_is_better,
    ),
    Statement(
        "section 3.1", "With the ranger “there are 25 identifiable geometric parameters … at most”.", _twenty_five
    ),
    Statement(
        "section 3.1",
        "They are 25 because, of 30, three are lost to a rotation and two to coordinates left free.",
        _counted,
    ),
    Statement("section 3.1, eq. (13)", "C = 2R + 2P + 6, hence 30 parameters for six revolute joints.", _everett),
    Statement("section 4.3", "The plane z + f = 0 makes θ1, a1 and d3 unidentifiable.", _floor),
    Statement(
        "section 3.1",
        "That the model is incomplete has a minor effect: the base's own frame need not be calibrated.",
        _minor,
    ),
)
"""In the order of the page."""


@dataclass(frozen=True, slots=True)
class Judged:
    """A statement beside what was measured."""

    statement: Statement
    finding: Finding


def judge(found: Measurements) -> tuple[Judged, ...]:
    """Returns every statement beside what was measured."""
    return tuple(Judged(statement, statement.measure(found)) for statement in STATEMENTS)
