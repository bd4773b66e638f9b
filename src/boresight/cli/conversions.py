"""The commands between Boresight and others' files: recordings in, commands and formats of controllers out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from boresight.cli.app import app
from boresight.cli.choices import ConventionChoice, FormatChoice, Real, WholeOrNone


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
    base: str | None = None,
    tip: str | None = None,
    campaign: Path | None = None,
    joints: Annotated[list[str] | None, Parameter(negative="")] = None,
    range: str | None = None,
    position: str | None = None,
    pose: str | None = None,
    target: str | None = None,
    targets: str | None = None,
    time_offset: Real = 0.0,
    still_speed: Real = 1e-3,
    still_time: Real = 0.5,
    settle: Real = 0.3,
    joint_file: Path | None = None,
    marker: WholeOrNone = None,
    overwrite: Annotated[bool, Parameter(negative="")] = False,
    json: Annotated[bool, Parameter(negative="")] = False,
) -> int:
    """Make an observations.csv, in metres and radians, of a ROS 2 bag, or of FIGAROH's or Leica's CSV.

    Of a bag, every time the arm stands still becomes a row: joints and readings are paired by their time stamps
    and averaged.

    Args:
        source: a rosbag2 folder, an .mcap or .db3 file, or a CSV.
        output: CSV to write; observations.csv in the present folder by default.
        robot: robot.yaml or URDF whose joints become the columns; every joint of the source by default. Of a URDF with
            several last links, its joints that the source has.
        base: of a URDF, the link the arm stands on.
        tip: of a URDF, the link that carries the sensor.
        campaign: campaign.yaml whose robot's joints become the columns, in place of --robot.
        joints: topic of sensor_msgs/JointState; may be given several times. The only one by default.
        range: topic of sensor_msgs/Range, or of std_msgs/Float64 or Float32 in metres. The only one by default.
        position: topic of geometry_msgs/PointStamped, the positions of a tracker, in place of ranges; or of poses,
            whose orientation is left out.
        pose: topic of geometry_msgs/PoseStamped, PoseWithCovarianceStamped or TransformStamped, the poses of a tracker;
            or a frame of a tf topic, /tf:FRAME.
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
    from boresight.cli.importing import ArmOf, run_import
    from boresight.files.topics import Choice
    from boresight.recordings import Rules

    rules = Rules(still_speed, still_time, settle)
    choice = Choice(tuple(joints or ()), range, position, pose, target, targets, time_offset, rules)
    return run_import(
        source,
        output,
        choice,
        arm=ArmOf(robot, base, tip, campaign),
        joint_file=joint_file,
        marker=marker,
        overwrite=overwrite,
        as_json=json,
    )


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
