"""The commands that calibrate, plan and study, and their exit codes.

0: done, and accepted where there is a verdict; 1: an error in input or usage; 2: the calibration ran and was
rejected, or poses cannot be reached; 130: interrupted.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from boresight import __version__
from boresight.cli.choices import DeviceChoice, PrecisionChoice, Real, SolverChoice, StrategyChoice, Whole, WholeOrNone

app = App(
    name="boresight",
    version=__version__,
    help="Calibrate a robot arm with a laser ranger and a flat plate, and be told how far to trust the result.",
    help_epilogue="Exit codes: 0 accepted, 1 an error in input or usage, 2 rejected or not reached, 130 interrupted.",
    suppress_keyboard_interrupt=False,  # it would end without a word
)


@app.command
def calibrate(
    campaign: Path,
    *,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    solver: SolverChoice = "evolution+least-squares",
    strategy: StrategyChoice = "trade-off",
    population: WholeOrNone = None,
    generations: Whole = 500,
    device: DeviceChoice = "cpu",
    precision: PrecisionChoice = "double",
    seed: Whole = 0,
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
        device: where evolution runs: this processor, or an NVIDIA card. One calibration keeps a small part of a card
            busy; cards are for studies.
        precision: of evolution's numbers: single is up to twice as fast, and compiled once more; least squares, which
            follows, is in double precision in any case.
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
        device=device,
        precision=precision,
        seed=seed,
        as_json=json,
    )


@app.command
def inspect(
    campaign: Path,
    *,
    rows: WholeOrNone = None,
    seed: Whole = 0,
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
    rows: WholeOrNone = None,
    validation_rows: Whole = 20,
    size: Real = 1.0,
    seed: Whole = 0,
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


@app.command
def study(
    study: Path,
    *,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    workers: WholeOrNone = None,
    scheduler: str | None = None,
    shard: str | None = None,
    device: DeviceChoice = "cpu",
    precision: PrecisionChoice = "double",
    seeds: WholeOrNone = None,
    merge: list[Path] | None = None,
    summary: Annotated[bool, Parameter(negative="")] = False,
    json: Annotated[bool, Parameter(negative="")] = False,
) -> int:
    """Simulate thousands of calibrations over a grid of settings, and say what they have in common.

    Every run is kept as soon as it is made: the same command goes on after an interrupt, and adds what a longer
    grid or more seeds ask for. The numbers do not depend on who makes the runs.

    Args:
        study: the study.yaml that names the arm, the sensor, its targets and what is varied.
        output: folder of the study; NAME-study in the present folder by default.
        workers: processes of this machine; one a core by default.
        scheduler: address of a Dask scheduler whose workers do the work instead, such as tcp://host:8786.
        shard: make one part of the runs, such as 2/4, to divide them among machines by hand.
        device: where evolution runs: the workers, or this machine's NVIDIA card for all of them. Runs are kept apart,
            for they differ in their last digits.
        precision: of evolution's numbers: single is up to twice as fast. Runs are kept apart.
        seeds: campaigns of each point; as the file says by default.
        merge: folder of another part, whose runs are added to this one's first; may be given several times.
        summary: run nothing; show what there is, of a study that is still running too.
        json: print summary.json instead of a table.
    """
    from boresight.cli.study import run_study

    return run_study(
        study,
        output,
        workers=workers,
        scheduler=scheduler,
        shard=shard,
        device=device,
        precision=precision,
        seeds=seeds,
        merge=merge or [],
        summary=summary,
        as_json=json,
    )


@app.command
def reproduce(
    *,
    output: Annotated[Path, Parameter(name=["--output", "-o"])] = Path("reproduction"),
    quick: Annotated[bool, Parameter(negative="")] = False,
    seeds: WholeOrNone = None,
    seed: Whole = 0,
    workers: WholeOrNone = None,
) -> int:
    """Do the paper's simulations again: its tables, figures and statements beside what is measured.

    Writes index.html, the same page as Markdown, figures (PNG, SVG) and every number as CSV.

    Args:
        output: folder for the page; what an earlier run left there is replaced, nothing else.
        quick: 16 seeds instead of 300: half a minute instead of six, on two cores.
        seeds: how many seeds, instead.
        seed: the first of them; the same seeds give the same numbers.
        workers: processes; one a core by default.
    """
    from boresight.cli.reproduce import run_reproduce

    return run_reproduce(output, quick=quick, seeds=seeds, seed=seed, workers=workers)
