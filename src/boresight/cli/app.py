"""The commands and their exit codes.

0: done, and accepted where there is a verdict; 1: an error in input or usage; 2: the calibration ran and was
rejected; 130: interrupted.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import App, CycloptsError, Parameter

from boresight import __version__
from boresight.cli.codes import INTERRUPTED
from boresight.cli.consoles import PipedConsole
from boresight.errors import BoresightError

SolverChoice = Literal["evolution+least-squares", "evolution", "least-squares"]
StrategyChoice = Literal["trade-off", "rand-to-best/1", "current-to-best/1", "best/1", "rand/1", "downhill"]

app = App(
    name="boresight",
    version=__version__,
    help="Calibrate a robot arm with a laser ranger and a flat plate, and be told how far to trust the result.",
    help_epilogue="Exit codes: 0 accepted, 1 an error in input or usage, 2 rejected, 130 interrupted.",
    suppress_keyboard_interrupt=False,  # it would end without a word
)


@app.command
def calibrate(
    campaign: Path,
    *,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    solver: SolverChoice = "evolution+least-squares",
    strategy: StrategyChoice = "trade-off",
    population: int | None = None,
    generations: int = 500,
    seed: int = 0,
    json: Annotated[bool, Parameter(negative="")] = False,
) -> int:
    """Identify the real arm from readings, and say how far to trust it.

    Args:
        campaign: the campaign.yaml that names the robot, the sensor, its targets and the readings.
        output: folder for the result; NAME-result in the present folder by default.
        solver: how to search.
        strategy: how evolution makes mutants.
        population: members of the evolution (Np); the strategy's own by default, 150 as in the paper, 120 for downhill.
        generations: generations of the evolution (G).
        seed: of all random numbers; the same seed gives the same answer.
        json: print result.json instead of a summary.
    """
    from boresight.cli.calibrate import run_calibrate

    return run_calibrate(
        campaign,
        output,
        solver=solver,
        strategy=strategy,
        population=population,
        generations=generations,
        seed=seed,
        as_json=json,
    )


@app.command
def inspect(
    campaign: Path,
    *,
    rows: int | None = None,
    seed: int = 0,
    json: Annotated[bool, Parameter(negative="")] = False,
) -> int:
    """Say what these data could identify, and how well; needs no readings.

    Rank, directions that no reading can see and what would mend them, observability, predicted accuracy.

    Args:
        campaign: the campaign.yaml to inspect.
        rows: configurations to draw; the campaign's own by default, 100 where it has none.
        seed: of the configurations; the same seed gives the same answer.
        json: print everything as JSON instead of a summary.
    """
    from boresight.cli.inspect import run_inspect

    return run_inspect(campaign, rows=rows, seed=seed, as_json=json)


@app.command
def simulate(
    campaign: Path,
    *,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    rows: int | None = None,
    validation_rows: int = 20,
    size: float = 1.0,
    seed: int = 0,
) -> int:
    """Make the readings of an arm whose errors are known: a campaign to rehearse with.

    Writes a campaign folder with a nominal robot, noisy readings, validation rows and the truth.

    Args:
        campaign: the campaign.yaml to rehearse; it needs no readings.
        output: folder for the simulated campaign; NAME-simulated in the present folder by default.
        rows: configurations to draw; the campaign's own by default, 100 where it has none.
        validation_rows: configurations to draw for validation.
        size: factor on the errors, which are uniform within each parameter's `within`.
        seed: of the truth, the configurations and the noise.
    """
    from boresight.cli.simulate import run_simulate

    return run_simulate(campaign, output, rows=rows, validation_rows=validation_rows, size=size, seed=seed)


def main() -> None:
    """Runs the command line and exits with its code."""
    try:
        # cyclopts itself would exit with 2, which here means a rejected result.
        code = app(sys.argv[1:], result_action="return_value", exit_on_error=False, console=PipedConsole())
    except CycloptsError:
        code = 1
    except BoresightError as error:
        _say(error)
        code = 1
    except KeyboardInterrupt:
        print("Interrupted; nothing was written.", file=sys.stderr)
        code = INTERRUPTED
    sys.exit(code if isinstance(code, int) else 0)


def _say(error: BoresightError) -> None:
    """Prints an error: one line, or a list of all that is wrong."""
    problems = getattr(error, "problems", (str(error),))
    if len(problems) == 1:
        print(f"Error: {problems[0]}", file=sys.stderr)
        return
    print(f"Error: {len(problems)} problems", file=sys.stderr)
    for problem in problems:
        print(f"  - {problem}", file=sys.stderr)
