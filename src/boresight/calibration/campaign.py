"""One calibration's worth of input: a cell, its readings, and what may be wrong about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from boresight.arm.serial import SerialChain
from boresight.calibration.written import Written
from boresight.sensing import Cell, Readings
from boresight.units import Quantity

Term = Literal["gravity", "harmonics"]
TERMS: tuple[Term, ...] = ("gravity", "harmonics")
"""What bends or turns a joint beside its geometry."""


ROUGH: dict[Quantity, float] = {"length": 0.02, "angle": 0.05, "number": 0.05}
"""Standard deviations [m, rad or 1] beyond which a frame that is stated is still to be found."""


@dataclass(frozen=True, slots=True)
class Freedom:
    """How far a parameter may be from its nominal value.

    Attributes:
        parameter: its name.
        within: half-width of the search about the nominal value [m, rad or 1]; None searches everywhere.
        prior_std: standard deviation of what is believed beforehand; None believes nothing.
        learned_std: standard deviation of parameters of this kind, learned from the readings themselves, that holds
            it in place of `prior_std`; None where nothing was learned.
    """

    parameter: str
    within: float | None
    prior_std: float | None
    learned_std: float | None = None


@dataclass(frozen=True, slots=True)
class SetAside:
    """A row of an observations file that cannot be used.

    Attributes:
        file: the file's name.
        line: the row's line in it.
        reason: why, in words.
    """

    file: str
    line: int
    reason: str


@dataclass(frozen=True)
class RobotFile:
    """The description an arm was read from, kept so that it can be handed back corrected.

    Attributes:
        name: what the user calls the file.
        content: its bytes.
        chain: the joints in it that are the arm.
    """

    name: str
    content: bytes
    chain: SerialChain


@dataclass(frozen=True)
class Campaign:
    """The input of one calibration.

    Attributes:
        name: for titles.
        cell: the nominal cell; frames that are unknown stand at the identity.
        readings: the rows to calibrate with; None, or without values, where a campaign is only planned.
        validation: rows held out; None to judge by cross-validation.
        freedoms: what to estimate; None estimates what the readings can identify.
        beside_default: whether `freedoms` come beside what the readings can identify, rather than in its place.
        fixed: parameters held at nominal, whatever `freedoms` says.
        priors: standard deviation [m, rad or 1] of what is believed of parameters, where the files state it: of the
            sensor's bias, a plane's offset, a link length; whether they are estimated or not.
        joint_noise_std: standard deviation [rad or m] of each joint reading; empty where none is stated.
        beyond: what may be added to the geometry where held-out readings ask for it; None for everything, unless
            `freedoms` says what to estimate.
        gravity: its direction in the world; None where it is the arm's own, along its base's -z unless the robot's
            file says otherwise.
        weightless: whether there is no gravity, as in orbit.
        unknown: the parameters of `base` and `mount` that nobody has measured.
        set_aside: rows that were not used, and why.
        warnings: what looked odd in the files, a sentence each.
        notes: choices made in reading them that a person should know.
        inputs: SHA-256 by file name.
        robot_file: the URDF the arm was read from, if it was.
        written: in which files its numbers stand, for messages.
    """

    name: str
    cell: Cell
    readings: Readings | None = None
    validation: Readings | None = None
    freedoms: tuple[Freedom, ...] | None = None
    beside_default: bool = False
    fixed: frozenset[str] = frozenset()
    priors: Mapping[str, float] = field(default_factory=dict)
    joint_noise_std: tuple[float, ...] = ()
    beyond: tuple[Term, ...] | None = None
    gravity: tuple[float, float, float] | None = None
    weightless: bool = False
    unknown: frozenset[str] = frozenset()
    set_aside: tuple[SetAside, ...] = ()
    warnings: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    inputs: Mapping[str, str] = field(default_factory=dict)
    robot_file: RobotFile | None = None
    written: Written = Written()

    @property
    def sought(self) -> frozenset[str]:
        """The parameters of frames that are found from the readings: unknown, or stated too roughly to start from."""
        frames = ("base", *self.cell.mounts)
        rough = {
            parameter.name
            for parameter in self.cell.parameters
            if parameter.name.rpartition(".")[0] in frames
            and self.priors.get(parameter.name, 0.0) > ROUGH[parameter.quantity]
        }
        return self.unknown | (rough - self.fixed)

    @property
    def chosen_by_default(self) -> bool:
        """Whether the readings decide which link parameters are estimated."""
        return self.freedoms is None or self.beside_default

    @property
    def terms(self) -> tuple[Term, ...]:
        """What may be added to the geometry."""
        asked = self.beyond if self.beyond is not None else TERMS if self.chosen_by_default else ()
        return tuple(term for term in asked if not (term == "gravity" and self.weightless))
