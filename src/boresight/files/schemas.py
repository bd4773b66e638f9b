"""What robot.yaml and campaign.yaml may say, as pydantic models; numbers in the file's own units.

A description completes the sentence "expected ...". Values that pydantic would bend into shape (true as 1,
"3" as 3) are refused: a file of measurements says what it means.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal, cast

from pydantic import (
    AfterValidator,
    AllowInfNan,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    Strict,
    Tag,
    ValidationInfo,
    field_validator,
    model_validator,
)
from pydantic_core import PydanticCustomError

from boresight.arm.conventions import Convention, JointType
from boresight.calibration.campaign import TERMS, Term
from boresight.units import AngleUnit, LengthUnit, Units

RESERVED = ("base", "mount", "sensor")
"""Names that joints and targets cannot have, since parameters or keys are called after them."""

_NOT_IN_NAMES = set('.*?[]#",')


def expected(what: str) -> PydanticCustomError:
    """Returns the error that a value is not what it should be, in words."""
    return PydanticCustomError("expected", "{what}", {"what": what})


def name_fault(name: str) -> str | None:
    """Returns what was expected of a name that joints and targets cannot have, or None."""
    if not name or name.strip() != name or not name.isprintable() or _NOT_IN_NAMES & set(name):
        return 'a name that is not empty, without dots, wildcards, commas, ", # or spaces around it'
    if name in RESERVED:
        return f"a name other than {', '.join(RESERVED)}, which mean something else"
    return None


def _checked_name(name: str) -> str:
    fault = name_fault(name)
    if fault:
        raise expected(fault)
    return name


def _triple(value: Any) -> Any:
    if not _is_numbers(value, 3):
        raise expected("a list of 3 finite numbers")
    return tuple(map(float, value))


def _unknown_or_triple(value: Any) -> Any:
    if value == "unknown":
        return None
    if not _is_numbers(value, 3):
        raise expected("a list of 3 finite numbers, or unknown")
    return tuple(map(float, value))


def _limits(value: Any) -> Any:
    if value == "none":
        return -math.inf, math.inf
    if not _is_numbers(value, 2) or not value[0] < value[1]:
        raise expected("two finite numbers, the lower limit and then the upper: [-170, 170]; or none")
    return tuple(map(float, value))


def _direction(value: Any) -> Any:
    if not _is_numbers(value, 3) or not any(value):
        raise expected("a list of 3 finite numbers that are not all zero, a direction")
    return _unit(value)


def _gravity(value: Any) -> Any:
    if value in ("level", "off"):
        return value
    if not _is_numbers(value, 3) or not any(value):
        raise expected("level, off, or gravity's direction in the world: [0, 0, -1]")
    return _unit(value)


def _unit(value: list[float]) -> tuple[float, ...]:
    size = math.hypot(*value)
    return tuple(float(part) / size for part in value)


def _sag(value: Any) -> Any:
    if not isinstance(value, dict) or not all(key.isascii() and key.isdigit() for key in value):
        raise expected("turns by number of the link whose weight they come from: {3: 0.0002}")
    if not all(map(_is_number, value.values())):
        raise expected("a finite number for each link")
    return tuple((int(key), float(turn)) for key, turn in value.items())


def _beyond(value: Any) -> Any:
    if value == "off":
        return []
    if not isinstance(value, list) or not all(term in TERMS for term in value):
        raise expected(f"off, or a list of what may be added: [{', '.join(TERMS)}]")
    return value


def _not_minute(value: float) -> float:
    if value < SMALLEST:
        raise expected(f"a number of at least {SMALLEST:g}")
    return value


def _is_numbers(value: Any, count: int) -> bool:
    if isinstance(value, list) and any(_is_finite(each) and abs(each) > LARGEST for each in value):
        raise expected(f"numbers of at most {LARGEST:g}")
    return isinstance(value, list) and len(value) == count and all(map(_is_number, value))


def _is_finite(value: Any) -> bool:
    if not isinstance(value, int | float) or isinstance(value, bool):
        return False
    return math.isfinite(value) if isinstance(value, float) else abs(value) < 10**300  # more is no float


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= LARGEST


LARGEST = 1e9
"""Beyond this a number is a slip of the pen, and its squares would leave floating point."""

SMALLEST = 1e-12
"""The same for what is above 0."""

MOST_JOINTS = 64
"""Arms have six or seven, snakes some dozens; what follows grows with the cube of their number."""

Number = Annotated[float, Strict(), AllowInfNan(False), Field(ge=-LARGEST, le=LARGEST)]
Positive = Annotated[Number, Field(gt=0), AfterValidator(_not_minute)]
Name = Annotated[str, AfterValidator(_checked_name)]
Triple = Annotated[tuple[float, float, float], BeforeValidator(_triple)]
KnownTriple = Annotated[tuple[float, float, float] | None, BeforeValidator(_unknown_or_triple)]
Direction = Annotated[tuple[float, float, float] | None, BeforeValidator(_direction)]
Gravity = Annotated[tuple[float, float, float] | Literal["level", "off"], BeforeValidator(_gravity)]
Sag = Annotated[tuple[tuple[int, float], ...], BeforeValidator(_sag)]
Limits = Annotated[tuple[float, float] | None, BeforeValidator(_limits)]


class Entry(BaseModel):
    """A block of keys; others than its own are errors."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class UnitsEntry(Entry):
    """`units: {length: mm, angle: deg}`."""

    length: LengthUnit = "m"
    angle: AngleUnit = "rad"

    @property
    def value(self) -> Units:
        """The units as the package's own value."""
        return Units(self.length, self.angle)


class JointEntry(Entry):
    """One joint and its link."""

    name: Name = Field(description="the joint's name")
    type: JointType = "revolute"
    theta: Number = 0.0
    d: Number = 0.0
    a: Number = 0.0
    alpha: Number = 0.0
    beta: Number = 0.0
    cos1: Number | None = None
    sin1: Number | None = None
    cos2: Number | None = None
    sin2: Number | None = None
    sag: Sag = ()
    limits: Limits = None
    follows: Name | None = None
    ratio: Number = 1.0

    @model_validator(mode="after")
    def _only_revolute_joints_bend(self) -> JointEntry:
        if self.type == "prismatic" and (self.sag or self.harmonics):
            raise expected("no harmonics or sag for a prismatic joint, which does not turn")
        if self.follows is not None and (self.sag or self.harmonics):
            raise expected("no harmonics or sag for a joint that follows another")
        return self

    @model_validator(mode="after")
    def _a_ratio_is_to_another_joint(self) -> JointEntry:
        if self.follows is None and self.ratio != 1.0:
            raise expected(
                f"follows: JOINT beside ratio, which multiplies that joint's reading; a joint's own is not multiplied: "
                f"write column {self.name} of the observations times {self.ratio:g} instead"
            )
        return self

    @property
    def harmonics(self) -> tuple[float, ...]:
        """Heights of the four waves; none where none is named."""
        named = (self.cos1, self.sin1, self.cos2, self.sin2)
        return () if all(height is None for height in named) else tuple(height or 0.0 for height in named)

    @model_validator(mode="after")
    def _prismatic_joints_have_limits(self) -> JointEntry:
        unlimited = self.limits is None or math.isinf(self.limits[0])
        if self.type == "prismatic" and self.follows is None and unlimited:
            raise expected("limits for a prismatic joint, in the length unit: limits: [0, 0.5]")
        return self


class PlaceEntry(Entry):
    """`root` or `tip`: where a frame of the arm itself stands."""

    xyz: Triple = (0.0, 0.0, 0.0)
    rpy: Triple = (0.0, 0.0, 0.0)


class RobotEntry(Entry):
    """robot.yaml."""

    name: Annotated[str, AfterValidator(lambda name: _checked_title(name))] = Field(
        description="what the arm is called"
    )
    units: UnitsEntry = UnitsEntry()
    convention: Convention = "standard-dh"
    root: PlaceEntry = PlaceEntry()
    gravity: Direction = None
    joints: Annotated[list[JointEntry], Field(min_length=1, max_length=MOST_JOINTS)] = Field(
        description="a list of one joint or more"
    )
    tip: PlaceEntry = PlaceEntry()

    @model_validator(mode="after")
    def _joints_follow_joints_that_are_read(self) -> RobotEntry:
        read = [joint.name for joint in self.joints if joint.follows is None]
        if len(read) < len(self.joints) and any(joint.sag for joint in self.joints):
            raise expected("no sag in an arm whose joints follow others: other links hold them up")
        for joint in self.joints:
            if joint.follows is not None and joint.follows not in read:
                raise expected(
                    f"joint {joint.name} to follow one that has a reading of its own: {', '.join(read) or 'none has'}"
                )
        return self


def _checked_title(name: str) -> str:
    if not name.strip() or not name.isprintable():
        raise expected("a name of visible characters")
    return name


_ROBOTS = "the name of a robot.yaml or of a URDF, {catalogue: NAME}, or {urdf: arm.urdf, base: LINK, tip: LINK}"


class RobotChoice(Entry):
    """Where a campaign's robot comes from; a bare file name stands for {file: it}."""

    file: str | None = None
    catalogue: str | None = None
    urdf: str | None = None
    base: str | None = None
    tip: str | None = None

    @model_validator(mode="after")
    def _one_source(self) -> RobotChoice:
        if [self.file, self.catalogue, self.urdf].count(None) != 2:
            raise expected(_ROBOTS)
        if self.urdf is None and (self.base is not None or self.tip is not None):
            raise expected("base and tip beside a urdf only: {urdf: arm.urdf, base: base_link, tip: tool0}")
        return self


def robot_choice(value: Any) -> Any:
    """Returns the block that a bare file name stands for."""
    if not isinstance(value, str | dict):
        raise expected(_ROBOTS)
    return {"file": value} if isinstance(value, str) else value


SensorType = Literal["laser_ranger", "draw_wire", "position", "pose", "plane_contact", "point_contact", "distances"]


class SensorEntry(Entry):
    """`sensor: {type: laser_ranger, noise_std: 0.0002, repeats: 10}`."""

    type: SensorType = Field(
        description="laser_ranger, draw_wire, position, pose, plane_contact, point_contact or distances"
    )
    noise_std: Positive = Field(description="the standard deviation of one reading, in the length unit")
    noise_angle_std: Positive | None = None
    repeats: Annotated[int, Strict(), Field(ge=1, le=10**9)] = 1
    bias_std: Positive | None = None
    scale_std: Positive | None = None
    markers: Annotated[list[str], Field(min_length=1)] | None = None
    offset_per: Literal["session"] | None = None

    @model_validator(mode="after")
    def _keys_fit_the_type(self) -> SensorEntry:
        if (self.type == "pose") != (self.noise_angle_std is not None):
            raise expected(
                "noise_angle_std beside noise_std, the standard deviation of one reading about each axis"
                if self.type == "pose"
                else f"no noise_angle_std, as a {self.type} reads no orientation"
            )
        if self.bias_std is not None and self.type not in ("laser_ranger", "draw_wire"):
            raise expected(f"no bias_std, as a {self.type} has no bias: only a laser_ranger or draw_wire has")
        if self.scale_std is not None and self.type not in ("laser_ranger", "draw_wire", "position", "pose"):
            raise expected(f"no scale_std, as a {self.type} has no unit of length of its own")
        if self.offset_per is not None and self.type not in ("laser_ranger", "draw_wire"):
            raise expected(f"no offset_per, as a {self.type} has no offset: only a laser_ranger or draw_wire has")
        return self


class FrameEntry(Entry):
    """`base`, `mount` or a marker; None stands for `unknown`."""

    xyz: KnownTriple = (0.0, 0.0, 0.0)
    rpy: KnownTriple = (0.0, 0.0, 0.0)
    xyz_std: Positive | None = None
    rpy_std: Positive | None = None

    @model_validator(mode="after")
    def _what_is_unknown_has_no_std(self) -> FrameEntry:
        for part in ("xyz", "rpy"):
            if getattr(self, part) is None and getattr(self, f"{part}_std") is not None:
                raise expected(f"no {part}_std beside {part}: unknown; state a value and its {part}_std, or neither")
        return self


class PlaneEntry(Entry):
    """`{type: plane, normal: [0, 1, 4.6], offset: -0.69}`."""

    type: Literal["plane"] = Field(description="plane or point")
    normal: Triple = Field(description="a list of 3 numbers, a direction at right angles to the plane")
    offset: Number = Field(description="the number f of n·x + f = 0, in the length unit")
    normal_std: Positive | None = None
    offset_std: Positive | None = None
    flatness: Positive | None = None


class PointEntry(Entry):
    """`{type: point, position: [1, 2, 0]}`; None stands for `unknown`."""

    type: Literal["point"] = Field(description="point")
    position: KnownTriple = Field(description="a list of 3 numbers, or unknown")
    position_std: Positive | None = None

    @model_validator(mode="after")
    def _what_is_unknown_has_no_std(self) -> PointEntry:
        if self.position is None and self.position_std is not None:
            raise expected(
                "no position_std beside position: unknown; state a position and its position_std, or neither"
            )
        return self


def _target_kind(value: Any) -> str:
    return "point" if isinstance(value, dict) and value.get("type") == "point" else "plane"


TargetEntry = Annotated[
    Annotated[PlaneEntry, Tag("plane")] | Annotated[PointEntry, Tag("point")], Discriminator(_target_kind)
]


class DataEntry(Entry):
    """`observations` or `validation`: a bare name stands for {file: it}; a bag may say which topics are meant."""

    file: str | None = None
    bag: str | None = None
    joints: Annotated[tuple[str, ...], BeforeValidator(lambda value: _topics(value))] = ()
    range: str | None = None
    position: str | None = None
    pose: str | None = None
    target: Name | None = None
    targets: str | None = None
    time_offset: Number = 0.0
    still_speed: Positive = 1e-3
    still_time: Positive = 0.5
    settle: Annotated[Number, Field(ge=0)] = 0.3

    @model_validator(mode="after")
    def _one_source(self) -> DataEntry:
        if (self.file is None) == (self.bag is None):
            raise expected("the name of a file, or a block with a bag: {bag: run1, range: /ranger}")
        return self

    @property
    def of_bags(self) -> list[str]:
        """The keys that are given and mean something of a bag alone."""
        return [key for key in type(self).model_fields if key in self.model_fields_set - {"file", "bag"}]

    @property
    def name(self) -> str:
        """What the user calls it."""
        return self.file or self.bag or ""


def _data_entry(value: Any) -> Any:
    if not isinstance(value, str | dict):
        raise expected("the name of a CSV file or of a ROS bag, or a block such as {bag: run1, range: /ranger}")
    return {"file": value} if isinstance(value, str) else value


def _topics(value: Any) -> Any:
    if isinstance(value, str):
        return (value,)
    if not isinstance(value, list) or not all(isinstance(topic, str) for topic in value):
        raise expected("the name of a topic, or a list of such names")
    return tuple(value)


class FreedomEntry(Entry):
    """One line of `estimate`."""

    parameters: Annotated[list[str], Field(min_length=1)] = Field(
        description="a list of names such as j2.beta or *.theta"
    )
    within: Positive = Field(description="a number above 0, how far they may be from nominal")
    prior_std: Positive | None = None


class PriorEntry(Entry):
    """One line of `priors`."""

    parameters: Annotated[list[str], Field(min_length=1)] = Field(description="a list of names such as j2.a or *.theta")
    prior_std: Positive = Field(description="a number above 0, the standard deviation of what is believed of them")


def _estimate(value: Any) -> Any:
    """Returns the entries of `estimate`, with the word default among them as a mark."""
    if isinstance(value, list) and "default" in value:
        if value.count("default") > 1:
            raise expected("default once, and entries beside it: [default, {parameters: [sensor.bias], within: 0.02}]")
        return [DEFAULT if item == "default" else item for item in value]
    return value


DEFAULT: dict[str, Any] = {"parameters": ["default"], "within": 1.0}
"""What stands for the word default in `estimate`: everything that the readings can identify."""


def _joint_noise(value: Any) -> Any:
    numbers = list(value.values()) if isinstance(value, dict) else [value]
    if not numbers or not all(_is_number(each) and 0.0 < each <= LARGEST for each in numbers):
        raise expected("a number above 0 in the angle unit, or one for each joint by name: {j1: 1e-4, slide: 2e-5}")
    return {str(name): float(each) for name, each in value.items()} if isinstance(value, dict) else float(value)


JointNoise = Annotated[float | dict[str, float], BeforeValidator(_joint_noise)]


class CampaignEntry(Entry):
    """campaign.yaml."""

    robot: Annotated[RobotChoice, BeforeValidator(robot_choice)] = Field(description=_ROBOTS)
    units: UnitsEntry = UnitsEntry()
    sensors: Annotated[dict[Name, SensorEntry], Field(min_length=1)] | None = None
    sensor: SensorEntry | None = Field(default=None, validate_default=True)
    markers: Annotated[dict[Name, FrameEntry], Field(min_length=1)] | None = None
    mount: FrameEntry | None = None
    base: FrameEntry = FrameEntry()
    targets: dict[Name, TargetEntry] = {}
    observations: Annotated[DataEntry, BeforeValidator(_data_entry)] | None = None
    validation: Annotated[DataEntry, BeforeValidator(_data_entry)] | None = None
    estimate: Annotated[list[FreedomEntry] | None, BeforeValidator(_estimate)] = None
    fixed: list[str] = []
    priors: list[PriorEntry] = []
    joint_noise_std: JointNoise | None = None
    gravity: Gravity = "level"
    beyond: Annotated[list[Term] | None, BeforeValidator(_beyond)] = None

    @field_validator("sensor")
    @classmethod
    def _one_sensor_or_several(cls, sensor: SensorEntry | None, others: ValidationInfo) -> SensorEntry | None:
        several = others.data.get("sensors", ())  # not there where they have faults of their own
        if sensor is None and several is None:
            raise expected("sensor, a block such as {type: laser_ranger, noise_std: 0.0002}, or sensors by name")
        if sensor is not None and several:
            raise expected("either sensor, or sensors by name")
        return sensor

    @field_validator("mount")
    @classmethod
    def _one_mount_or_several(cls, mount: FrameEntry | None, others: ValidationInfo) -> FrameEntry | None:
        if mount is not None and others.data.get("markers"):
            raise expected("either mount, or markers by name")
        return mount

    @model_validator(mode="after")
    def _gravity_that_is_off_bends_nothing(self) -> CampaignEntry:
        if self.gravity == "off" and "gravity" in (self.beyond or ()):
            raise expected("beyond without gravity beside gravity: off, or a direction of gravity")
        return self

    @property
    def named_sensors(self) -> dict[str, SensorEntry]:
        """The sensors by name; the only one is called `sensor`."""
        return self.sensors or {"sensor": cast(SensorEntry, self.sensor)}

    @property
    def named_mounts(self) -> dict[str, FrameEntry]:
        """The places on the flange by name; the only one is called `mount`."""
        return self.markers or {"mount": self.mount or FrameEntry()}
