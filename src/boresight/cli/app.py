"""The commands and their exit codes.

0: done, and accepted where there is a verdict; 1: an error in input or usage; 2: the calibration ran and was
rejected, or poses cannot be reached; 130: interrupted.
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

DeviceChoice = Literal["cpu", "cuda"]
PrecisionChoice = Literal["double", "single"]
FormatChoice = Literal["urdf", "dh", "ur-kinematics", "ur-calibration-conf", "pal", "json"]
ConventionChoice = Literal["standard-dh", "modified-dh"]

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
    population: int | None = None,
    generations: int = 500,
    device: DeviceChoice = "cpu",
    precision: PrecisionChoice = "double",
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


@app.command
def compensate(
    result: Path,
    poses: Path,
    *,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    controller_poses: Annotated[bool, Parameter(negative="")] = False,
    position_only: Annotated[bool, Parameter(negative="")] = False,
    length: Literal["m", "mm"] = "m",
    angle: Literal["rad", "deg"] = "rad",
    overwrite: Annotated[bool, Parameter(negative="")] = False,
    json: Annotated[bool, Parameter(negative="")] = False,
) -> int:
    """Find the joint commands that put the calibrated arm where the nominal one was asked to go.

    Args:
        result: folder of a calibration's result.
        poses: CSV of the program: a column a joint, or poses of the flange in the arm's base frame (x, y, z with or
            without qw, qx, qy, qz), or both; other columns are handed on.
        output: CSV to write; POSES-compensated.csv in the present folder by default.
        controller_poses: write poses to command to a controller that keeps the nominal model, not joint readings.
        position_only: leave orientation free.
        length: unit of lengths in both files.
        angle: unit of angles in both files.
        overwrite: replace the output if it is there.
        json: print a summary as JSON.
    """
    from boresight.cli.compensate import run_compensate

    return run_compensate(
        result,
        poses,
        output,
        controller_poses=controller_poses,
        position_only=position_only,
        length=length,
        angle=angle,
        overwrite=overwrite,
        as_json=json,
    )


@app.command(name="import")
def import_(
    source: Path,
    *,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    robot: Path | None = None,
    joints: Annotated[list[str] | None, Parameter(negative="")] = None,
    range: str | None = None,
    position: str | None = None,
    target: str | None = None,
    targets: str | None = None,
    time_offset: float = 0.0,
    still_speed: float = 1e-3,
    still_time: float = 0.5,
    settle: float = 0.3,
    joint_file: Path | None = None,
    marker: int | None = None,
    overwrite: Annotated[bool, Parameter(negative="")] = False,
    json: Annotated[bool, Parameter(negative="")] = False,
) -> int:
    """Make an observations.csv, in metres and radians, of a ROS 2 bag, or of FIGAROH's or Leica's CSV.

    Of a bag, every time the arm stands still becomes a row: joints and readings are paired by their time stamps
    and averaged.

    Args:
        source: a rosbag2 folder, an .mcap or .db3 file, or a CSV.
        output: CSV to write; observations.csv in the present folder by default.
        robot: robot.yaml whose joints become the columns; every joint of the source by default.
        joints: topic of sensor_msgs/JointState; may be given several times. The only one by default.
        range: topic of sensor_msgs/Range, or of std_msgs/Float64 or Float32 in metres. The only one by default.
        position: topic of geometry_msgs/PointStamped, the positions of a tracker, in place of ranges.
        target: what the ranger pointed at, for the column target.
        targets: topic of std_msgs/String that names the target from then on; one called target by default.
        time_offset: seconds to add to the readings' time stamps.
        still_speed: a joint slower than this [rad/s or m/s] stands still.
        still_time: seconds that a pause lasts at least, after settling.
        settle: seconds to leave out at the beginning of a pause.
        joint_file: CSV of joint readings to pair a Leica export with: row by row, or by its column time.
        marker: which of several markers of a FIGAROH file.
        overwrite: replace the output if it is there.
        json: print a summary as JSON.
    """
    from boresight.cli.importing import run_import
    from boresight.files.topics import Choice
    from boresight.recordings import Rules

    rules = Rules(still_speed, still_time, settle)
    choice = Choice(tuple(joints or ()), range, position, target, targets, time_offset, rules)
    return run_import(
        source,
        output,
        choice,
        robot=robot,
        joint_file=joint_file,
        marker=marker,
        overwrite=overwrite,
        as_json=json,
    )


@app.command
def study(
    study: Path,
    *,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    workers: int | None = None,
    scheduler: str | None = None,
    shard: str | None = None,
    device: DeviceChoice = "cpu",
    precision: PrecisionChoice = "double",
    seeds: int | None = None,
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
    seeds: int | None = None,
    seed: int = 0,
    workers: int | None = None,
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


@app.command
def export(
    result: Path,
    *,
    to: FormatChoice,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    convention: ConventionChoice | None = None,
    even_if_rejected: Annotated[bool, Parameter(negative="")] = False,
    overwrite: Annotated[bool, Parameter(negative="")] = False,
) -> int:
    """Hand the identified arm to a planner or controller: URDF, D-H, and the formats of UR and PAL.

    Args:
        result: the folder that calibrate wrote.
        to: urdf: the URDF that was calibrated, or a new one; dh: a robot.yaml, or a table where the output ends
            in .csv; ur-kinematics: six transforms for a driver; ur-calibration-conf: deltas of D-H for a
            controller; pal: deltas of a URDF's origins; json: every form at once.
        output: the file to write; standard output by default.
        convention: of dh; the arm's own by default.
        even_if_rejected: export a result that was rejected.
        overwrite: replace the output file if there is one.
    """
    from boresight.cli.export import run_export

    return run_export(result, to, output, convention=convention, even_if_rejected=even_if_rejected, overwrite=overwrite)


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
