"""What the paper says about pose accuracy (abstract; section 4.4, table 5 and figures 5 to 7; section 3.1)."""

from __future__ import annotations

from boresight.reproduction.measurements import Measurements
from boresight.reproduction.setting import CASES
from boresight.reproduction.spread import Spread
from boresight.reproduction.trials import Run
from boresight.reproduction.variants import AZIMUTH_FREE, NOMINAL
from boresight.reproduction.verdicts import Answer, Finding, Statement, share_of

ONE, TWO = CASES[1], CASES[2]

SIGNIFICANT = 2.0
"""A "significant" or "authentic" improvement: errors at least this many times smaller."""

MINOR = 1.5
"""A "minor" effect: errors at most this many times larger."""


def position(run: Run) -> float:
    """Returns the RMS position error [mm] in validation."""
    return run.validation.position_rms_mm


def orientation(run: Run) -> float:
    """Returns the RMS orientation error [mrad] in validation."""
    return run.validation.orientation_rms_mrad


def _improves(found: Measurements) -> Finding:
    answers, said = [], []
    for case, rows in CASES.items():
        factor = {
            name: found.values(number, NOMINAL, rows) / found.values(number, "trade-off", rows)
            for name, number in (("position", position), ("orientation", orientation))
        }
        answers += [
            Answer(f"case {case}, {name} ≥ {SIGNIFICANT:.0f} × better", share_of(each >= SIGNIFICANT))
            for name, each in factor.items()
        ]
        said.append(
            f"case {case}: position {Spread.of(factor['position']).text()}, orientation "
            f"{Spread.of(factor['orientation']).text()}"
        )
    return Finding(tuple(answers), f"Nominal over calibrated RMS in validation: {'; '.join(said)}.")


def _more_is_better(found: Measurements) -> Finding:
    shift = {rows: found.values(position, "trade-off", rows) for rows in (ONE, TWO)}
    turn = {rows: found.values(orientation, "trade-off", rows) for rows in (ONE, TWO)}
    return Finding(
        (
            Answer("position better in case 2", share_of(shift[TWO] < shift[ONE])),
            Answer("orientation better in case 2", share_of(turn[TWO] < turn[ONE])),
        ),
        f"Validation RMS: {Spread.of(shift[ONE]).text()} → {Spread.of(shift[TWO]).text(unit='mm')}, "
        f"{Spread.of(turn[ONE]).text()} → {Spread.of(turn[TWO]).text(unit='mrad')}; case 2 is better by "
        f"{Spread.of(shift[ONE] / shift[TWO]).text(unit='times')} in position.",
    )


def _configurations(found: Measurements) -> Finding:
    number = {rows: found.values(position, "trade-off", rows) for rows in (35, 50, 100, 200)}
    steps = ((35, 100), (35, 200))
    return Finding(
        tuple(Answer(f"{more} better than {few}", share_of(number[more] < number[few])) for few, more in steps),
        "Validation position RMS: "
        + ", ".join(f"{rows} configurations {Spread.of(values).text(unit='mm')}" for rows, values in number.items())
        + ".",
    )


def _calibration_is_better(found: Measurements) -> Finding:
    answers, said = [], []
    for case, rows in CASES.items():
        ratio = {
            "position": found.values(lambda run: position(run) / run.calibration.position_rms_mm, "trade-off", rows),
            "orientation": found.values(
                lambda run: orientation(run) / run.calibration.orientation_rms_mrad, "trade-off", rows
            ),
        }
        answers += [Answer(f"case {case}, {name} better there", share_of(each > 1.0)) for name, each in ratio.items()]
        said.append(
            f"case {case}: position {Spread.of(ratio['position']).text()}, orientation "
            f"{Spread.of(ratio['orientation']).text()}"
        )
    return Finding(tuple(answers), f"RMS in validation over RMS where readings were taken, {'; '.join(said)}.")


def _minor(found: Measurements) -> Finding:
    answers, said = [], []
    for case, rows in CASES.items():
        fixed = found.values(position, "trade-off", rows)
        free = found.values(position, "trade-off", rows, AZIMUTH_FREE)
        turned = found.values(lambda run: run.validation_turned.position_rms_mm, "trade-off", rows, AZIMUTH_FREE)
        answers += [
            Answer(f"case {case}, ≤ {MINOR} × the error, in the base's frame", share_of(free <= MINOR * fixed)),
            Answer(f"case {case}, the same with the turn removed", share_of(turned <= MINOR * fixed)),
        ]
        said.append(
            f"case {case}: {Spread.of(fixed).text(unit='mm')} with θ1 fixed, {Spread.of(free).text(unit='mm')} with it "
            f"free, {Spread.of(turned).text(unit='mm')} once the base's turn is removed"
        )
    return Finding(tuple(answers), f"Validation position RMS, {'; '.join(said)}.")


POSE_STATEMENTS = (
    Statement(
        "abstract 1; section 4.4, table 5",
        "“A significant improvement of pose accuracy … can be obtained by distance measurement only.”",
        _improves,
    ),
    Statement(
        "section 4.4, table 5", "In validation, case 2 improves pose accuracy more than case 1.", _more_is_better
    ),
    Statement(
        "abstract 3; section 5",
        "“More calibration configurations may make calibration results better.”",
        _configurations,
    ),
    Statement(
        "section 4.4, figures 5 to 7",
        "“Pose accuracy in the calibration configurations is superior to that in the validation configuration.”",
        _calibration_is_better,
    ),
    Statement(
        "section 3.1",
        "That the model is incomplete has a minor effect: the base's own frame need not be calibrated.",
        _minor,
    ),
)
