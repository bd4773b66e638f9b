"""What study.yaml may say, as pydantic models; numbers in the file's own units."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Field, Strict, WrapValidator, field_validator, model_validator

from boresight.calibration.solve import SolverName
from boresight.files.schemas import (
    Entry,
    FrameEntry,
    FreedomEntry,
    Name,
    Number,
    PlaneEntry,
    Positive,
    RobotChoice,
    SensorEntry,
    UnitsEntry,
    expected,
    robot_choice,
)
from boresight.search import STRATEGIES

MOST_ROWS, MOST_SEEDS, MOST_MEMBERS, MOST_GENERATIONS = 100_000, 10_000_000, 1_000_000, 1_000_000_000
"""Beyond these memory or patience would end first."""

LARGEST_SIZE = 100.0


def _strategy(name: Any) -> Any:
    if name not in STRATEGIES:
        raise expected(f"one of {', '.join(STRATEGIES)}")
    return name


def _planes(value: Any, check: Any) -> Any:
    if isinstance(value, str):
        value = [value]
    whole = isinstance(value, int) and not isinstance(value, bool) and value >= 1
    names = isinstance(value, list) and value and all(isinstance(name, str) for name in value)
    if not whole and not names:
        raise expected("how many targets to use, or a list of their names")
    return value if whole else tuple(value)


def _names(value: Any, check: Any) -> Any:
    if not isinstance(value, list) or not all(isinstance(name, str) for name in value):
        raise expected("a list of names such as j1.theta, which may be empty: [j1.theta]")
    return tuple(value)


def _distinct(values: list[Any]) -> list[Any]:
    seen: list[Any] = []
    for value in values:
        if value in seen:
            raise expected("a list without repetitions")
        seen.append(value)
    return values


def _title(name: str) -> str:
    if not name.strip() or not name.isprintable() or set(name) & set("/\\:"):
        raise expected("a name of visible characters that can be a folder's, without / \\ and :")
    return name


Rows = Annotated[int, Strict(), Field(ge=1, le=MOST_ROWS)]
Repeats = Annotated[int, Strict(), Field(ge=1, le=10**9)]
Size = Annotated[Positive, Field(le=LARGEST_SIZE)]
GrossShare = Annotated[Number, Field(ge=0, le=0.9)]
Members = Annotated[int, Strict(), Field(ge=5, le=MOST_MEMBERS)]
Generations = Annotated[int, Strict(), Field(ge=1, le=MOST_GENERATIONS)]
StrategyName = Annotated[str, BeforeValidator(_strategy)]
Planes = Annotated[Any, WrapValidator(_planes)]
Names = Annotated[Any, WrapValidator(_names)]
Robot = Annotated[RobotChoice, BeforeValidator(robot_choice)]


def _refuse(entry: Entry, keys: tuple[str, ...]) -> None:
    """Refuses keys of a campaign that a study, which draws its own errors, would not heed."""
    for key in keys:
        if key in entry.model_fields_set:
            raise expected(f"no {key} in a study, whose errors are those of estimate, drawn within their width")


class VaryEntry(Entry):
    """What is varied: every key a list of values, the grid their product."""

    robot: Annotated[list[Robot], Field(min_length=1), AfterValidator(_distinct)] | None = None
    planes: Annotated[list[Planes], Field(min_length=1), AfterValidator(_distinct)] | None = None
    fixed: Annotated[list[Names], Field(min_length=1), AfterValidator(_distinct)] | None = None
    rows: Annotated[list[Rows], Field(min_length=1), AfterValidator(_distinct)] | None = None
    repeats: Annotated[list[Repeats], Field(min_length=1), AfterValidator(_distinct)] | None = None
    noise_std: Annotated[list[Positive], Field(min_length=1), AfterValidator(_distinct)] | None = None
    error_size: Annotated[list[Size], Field(min_length=1), AfterValidator(_distinct)] | None = None
    gross_errors: Annotated[list[GrossShare], Field(min_length=1), AfterValidator(_distinct)] | None = None
    solver: Annotated[list[SolverName], Field(min_length=1), AfterValidator(_distinct)] | None = None
    strategy: Annotated[list[StrategyName], Field(min_length=1), AfterValidator(_distinct)] | None = None
    population: Annotated[list[Members], Field(min_length=1), AfterValidator(_distinct)] | None = None
    generations: Annotated[list[Generations], Field(min_length=1), AfterValidator(_distinct)] | None = None


class StudyEntry(Entry):
    """study.yaml."""

    name: Annotated[str, AfterValidator(_title)] | None = None
    seeds: Annotated[int, Strict(), Field(ge=1, le=MOST_SEEDS)] = Field(
        description="how many campaigns to simulate of each point of the grid"
    )
    units: UnitsEntry = UnitsEntry()
    campaign: str | None = None
    robot: Robot | None = None
    sensor: SensorEntry | None = None
    mount: FrameEntry = FrameEntry()
    base: FrameEntry = FrameEntry()
    targets: dict[Name, PlaneEntry] = Field(default_factory=dict)
    estimate: list[FreedomEntry] | None = None
    fixed: list[str] = Field(default_factory=list)
    planes: Planes | None = None
    rows: Rows | None = None
    validation_rows: Rows = 20
    error_size: Size = 1.0
    gross_errors: GrossShare = 0.0
    solver: SolverName = "least-squares"
    strategy: StrategyName = "trade-off"
    population: Members = 150
    generations: Generations = 500
    patience: Annotated[int, Strict(), Field(ge=1, le=MOST_GENERATIONS)] = 100
    vary: VaryEntry = VaryEntry()

    @field_validator("sensor")
    @classmethod
    def _sensors_read_without_slips(cls, sensor: SensorEntry | None) -> SensorEntry | None:
        if sensor is not None:
            _refuse(sensor, ("bias_std", "scale_std", "offset_per", "markers"))
        return sensor

    @field_validator("base", "mount")
    @classmethod
    def _frames_stand_where_stated(cls, frame: FrameEntry) -> FrameEntry:
        _refuse(frame, ("xyz_std", "rpy_std"))
        return frame

    @field_validator("targets")
    @classmethod
    def _planes_stand_where_stated(cls, targets: dict[str, PlaneEntry]) -> dict[str, PlaneEntry]:
        for plane in targets.values():
            _refuse(plane, ("normal_std", "offset_std", "flatness"))
        return targets

    @model_validator(mode="after")
    def _evolution_is_part_of_it(self) -> StudyEntry:
        keys = ("strategy", "population", "generations", "patience")
        given = [key for key in keys if key in self.model_fields_set | self.vary.model_fields_set]
        if given and all(solver == "least-squares" for solver in self.vary.solver or [self.solver]):
            raise expected(
                f"a solver with evolution beside {given[0]}, which least squares does not have: "
                "solver: evolution+least-squares"
            )
        return self

    @model_validator(mode="after")
    def _one_cell(self) -> StudyEntry:
        own = [
            key for key in ("robot", "sensor", "targets", "mount", "base", "estimate") if key in self.model_fields_set
        ]
        if self.campaign is not None and (own or self.vary.robot):
            raise expected("either a campaign, or robot, sensor and targets of the study's own; the campaign has them")
        if self.campaign is None and self.sensor is None:
            raise expected("a sensor, such as sensor: {type: laser_ranger, noise_std: 0.0002}, or a campaign: FILE")
        if self.campaign is None and self.robot is None and self.vary.robot is None:
            raise expected("a robot, such as robot: {catalogue: space-arm}, or a campaign: FILE")
        return self

    @model_validator(mode="after")
    def _not_twice(self) -> StudyEntry:
        twice = sorted((self.vary.model_fields_set & self.model_fields_set) - {"fixed"})  # these add up
        if twice:
            raise expected(f"{twice[0]} either as one value or under vary, not both")
        return self
