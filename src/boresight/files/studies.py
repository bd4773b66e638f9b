"""study.yaml and the files it names, as one immutable value."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from boresight.calibration.campaign import Campaign, Freedom
from boresight.calibration.freedom import USUAL_WITHIN, link_candidates
from boresight.errors import InputError, did_you_mean
from boresight.files.campaigns import Choice, cell_of, load_campaign
from boresight.files.chosen_robots import RobotOf
from boresight.files.composing import KeyPath
from boresight.files.documents import Document, read_document
from boresight.files.explaining import validated
from boresight.files.patterns import Matcher
from boresight.files.problems import Problems, listed, printable, shown
from boresight.files.schemas import CampaignEntry, RobotChoice
from boresight.files.study_schemas import StudyEntry
from boresight.sensing import Cell
from boresight.studies import Bench, Chosen, Settings, Study, grid
from boresight.studies.grid import AXES

USUAL_ERRORS = 0.2
"""Errors are this share of `USUAL_WITHIN` where a study says nothing about them: 0.01 rad and 4 mm."""

STUDIED = ("laser_ranger", "position")
"""Sensors that a study simulates."""

MOST_POINTS = 10_000
"""More than anyone looks at."""

MOST_RUNS = 2_000_000
"""Campaigns of all points together: hours of many cores, and hundreds of megabytes to keep their outcomes."""

_ROWS = 35


def load_study(path: Path | str, *, seeds: int | None = None) -> Study:
    """Returns the study that a file describes, with everything it names, in metres and radians.

    Args:
        path: the study.yaml; the files it names are relative to its folder.
        seeds: how many campaigns to simulate of each point; as the file says by default.

    Raises:
        InputError: everything that is wrong with the files, as far as it can be told at once.
    """
    document = read_document(path)
    entry = validated(document, StudyEntry)
    problems = Problems()
    benches, sensor = _benches(document, entry, problems)
    problems.raise_if_any()
    axes = _axes(document, entry, benches, problems)
    settings = _settings(document, entry, benches, sensor, problems)
    problems.raise_if_any()
    count = math.prod((len(benches), *(len(values) for values in axes.values())))
    if count > MOST_POINTS:
        raise InputError(f"{document.at(('vary',))}the grid has {count:,} points; expected at most {MOST_POINTS:,}")
    runs = count * (seeds or entry.seeds)
    if runs > MOST_RUNS:
        raise InputError(
            f"{document.at(('seeds',))}{count:,} points with {seeds or entry.seeds:,} seeds each are {runs:,} "
            f"campaigns; expected at most {MOST_RUNS:,}"
        )
    try:
        points = grid(benches, axes, settings)
    except InputError as error:
        raise InputError(f"{document.at(())}{error}") from None
    varied = [axis for axis in AXES if len({point.label(axis) for point in points}) > 1]
    return Study(entry.name or printable(document.path.stem), points, tuple(varied), seeds or entry.seeds)


def _benches(document: Document, entry: StudyEntry, problems: Problems) -> tuple[dict[str, Bench], Mapping[str, Any]]:
    """Returns what is calibrated, by the robot's name, and what the sensor says of noise and repeats."""
    if entry.campaign is not None:
        bench = _bench_of_campaign(document, entry, problems)
        sensor = next(iter(bench.cell.sensors.values()))
        return {bench.cell.arm.name: bench}, {"noise_std": sensor.noise_std, "repeats": sensor.repeats}
    for owner in ("base", "mount"):
        if None in (getattr(entry, owner).xyz, getattr(entry, owner).rpy):
            problems.add(f"{document.at((owner,))}got unknown; a study simulates the cell, so it must know its frames")
    cells: dict[str, Cell] = {}
    for place, robot in enumerate(entry.vary.robot or [entry.robot]):
        assert robot is not None
        where: KeyPath = ("vary", "robot", place) if entry.vary.robot else ("robot",)
        with suppress(InputError):  # which are among the problems then
            campaign = _campaign(entry, robot)
            cell = cell_of(document, campaign, RobotOf(document, campaign, {}, where), problems)
            file = robot.file or robot.urdf or ""
            name = robot.catalogue or Path(file).stem
            cells[file if name in cells else name] = cell
    problems.raise_if_any()
    benches = {name: _own_bench(document, entry, cell, tuple(cells.values()), problems) for name, cell in cells.items()}
    assert entry.sensor is not None
    metres = entry.units.value.metres
    return benches, {"noise_std": entry.sensor.noise_std * metres, "repeats": entry.sensor.repeats}


def _campaign(entry: StudyEntry, robot: RobotChoice | None) -> CampaignEntry:
    """Returns the campaign that a study with one robot would be."""
    same = ("units", "sensor", "mount", "base", "targets", "estimate", "fixed")
    return CampaignEntry.model_construct(robot=robot, **{key: getattr(entry, key) for key in same})


def _own_bench(document: Document, entry: StudyEntry, cell: Cell, cells: tuple[Cell, ...], problems: Problems) -> Bench:
    """Returns the bench of a cell that the study describes; a pattern need not mean something in all of its cells."""

    def kept(patterns: Sequence[str]) -> list[str]:
        return [p for p in patterns if _reaches_any(p, (cell,)) or not _reaches_any(p, cells)]

    campaign = _campaign(entry, None)
    if len(cells) > 1:
        lines = [line.model_copy(update={"parameters": kept(line.parameters)}) for line in entry.estimate or ()]
        estimate = None if entry.estimate is None else [line for line in lines if line.parameters]
        campaign = campaign.model_copy(update={"estimate": estimate, "fixed": kept(entry.fixed)})
    choice = Choice.of(document, campaign, cell, problems)
    return Bench(cell, _chosen(cell, choice))


def _reaches_any(pattern: str, cells: Sequence[Cell]) -> bool:
    return any(Matcher(cell).match(pattern).parameters for cell in cells)


def _bench_of_campaign(document: Document, entry: StudyEntry, problems: Problems) -> Bench:
    """Returns the bench of a study of a campaign; its configurations are used where the study asks for no others."""
    place = document.at(("campaign",))
    path = document.path.parent / str(entry.campaign)
    try:
        campaign = load_campaign(path)
    except InputError as error:
        raise InputError([f"{place}{problem}" for problem in error.problems]) from None
    if campaign.unknown:
        raise InputError(
            f"{place}{listed(sorted(campaign.unknown))} are unknown there; a study simulates the cell, so it must "
            "know its frames: calibrate first, or write down about where they are"
        )
    types = [sensor.type for sensor in campaign.cell.sensors.values()]
    if len(types) > 1 or types[0] not in STUDIED or len(campaign.cell.mounts) > 1:
        raise InputError(
            f"{place}it has {listed(types)} on {listed(campaign.cell.mounts)}; expected one sensor on one mount, "
            f"{' or '.join(STUDIED)}"
        )
    held = _fixed_in_all(document, ("fixed",), tuple(entry.fixed), {"": Bench(campaign.cell, ())}, problems)
    fixed = campaign.fixed.union(held.names)
    freedoms = tuple(f for f in _chosen(campaign.cell, campaign) if f.parameter not in fixed)
    drawn = entry.rows is not None or entry.vary.rows is not None or campaign.readings is None
    if drawn or campaign.readings is None:
        return Bench(campaign.cell, freedoms)
    return Bench(campaign.cell, freedoms, campaign.readings.joints, campaign.readings.target)


def _chosen(cell: Cell, choice: Choice | Campaign) -> tuple[Freedom, ...]:
    """Returns what is estimated: what is asked for, and every link parameter where the default is."""
    asked = choice.freedoms or ()
    if choice.freedoms is not None and not choice.beside_default:
        return asked
    named = {freedom.parameter for freedom in asked}
    return (*asked, *(freedom for freedom in _usual(cell, choice.fixed) if freedom.parameter not in named))


def _usual(cell: Cell, fixed: frozenset[str]) -> tuple[Freedom, ...]:
    """Returns every link parameter, as wrong as arms usually are."""
    quantity = {parameter.name: parameter.quantity for parameter in cell.parameters}
    widths = {name: USUAL_ERRORS * USUAL_WITHIN[quantity[name]] for name in link_candidates(cell.arm)}
    return tuple(
        Freedom(name, widths[name], widths[name] / math.sqrt(3.0))
        for name in cell.index
        if name in widths and name not in fixed
    )


def _axes(
    document: Document, entry: StudyEntry, benches: Mapping[str, Bench], problems: Problems
) -> dict[str, tuple[Any, ...]]:
    """Returns the values of everything that is varied beside the robot, in the package's units."""
    axes: dict[str, tuple[Any, ...]] = {}
    for axis in AXES[1:]:
        given = getattr(entry.vary, axis)
        if given is None:
            continue
        where: KeyPath = ("vary", axis)
        if axis == "planes":
            values = [_targets(document, (*where, i), one, benches, problems) for i, one in enumerate(given)]
        elif axis == "fixed":
            values = [_fixed_in_all(document, (*where, i), one, benches, problems) for i, one in enumerate(given)]
        elif axis == "noise_std":
            values = [value * entry.units.value.metres for value in given]
        else:
            values = list(given)
        axes[axis] = tuple(values)
    return axes


def _settings(
    document: Document,
    entry: StudyEntry,
    benches: Mapping[str, Bench],
    sensor: Mapping[str, Any],
    problems: Problems,
) -> Settings:
    """Returns the settings that are not varied."""
    own = next(iter(benches.values())).joints
    same = (
        "validation_rows",
        "error_size",
        "gross_errors",
        "solver",
        "strategy",
        "population",
        "generations",
        "patience",
    )
    everything = len(next(iter(benches.values())).cell.targets)
    planes = entry.planes if entry.planes is not None else max(everything, 1)
    return Settings(
        planes=_targets(document, ("planes",), planes, benches, problems),
        rows=None if own is not None else entry.rows or _ROWS,
        **sensor,
        **{key: getattr(entry, key) for key in same},
    )


def _targets(
    document: Document, where: KeyPath, given: Any, benches: Mapping[str, Bench], problems: Problems
) -> Chosen:
    """Returns the targets that are meant: the first so many, or by name."""
    known = tuple(next(iter(benches.values())).cell.targets)
    if isinstance(given, int):
        if given > max(len(known), 1):
            problems.add(f"{document.at(where)}got {given}; there are {len(known)} targets: {listed(known)}")
        return Chosen(str(given), known[:given])
    for name in given:
        if name not in known:
            near = did_you_mean(name[:60], known)
            problems.add(f"{document.at(where)}there is no target {shown(name)}{near}; the targets are {listed(known)}")
    return Chosen(", ".join(given), tuple(name for name in known if name in given))


def _fixed_in_all(
    document: Document, where: KeyPath, patterns: tuple[str, ...], benches: Mapping[str, Bench], problems: Problems
) -> Chosen:
    """Returns the parameters that patterns mean in any of the cells."""
    cells = [bench.cell for bench in benches.values()]
    reached: dict[str, None] = {}
    for place, pattern in enumerate(patterns):
        names = [name for cell in cells for name in Matcher(cell).match(pattern).parameters]
        reached |= dict.fromkeys(names)
        if not names:
            problems.add(f"{document.at((*where, place))}{Matcher(cells[0]).nothing(pattern)}")
    return Chosen(", ".join(patterns) or "none", tuple(reached))
