"""The robot that a campaign or a study names: a robot.yaml, a URDF, or an arm of the catalogue."""

from __future__ import annotations

import hashlib
from pathlib import Path

from boresight.arm import Arm
from boresight.arm.conditioning import well_conditioned
from boresight.calibration.campaign import RobotFile
from boresight.errors import InputError, did_you_mean
from boresight.files.composing import KeyPath
from boresight.files.documents import Document, read_document
from boresight.files.explaining import validated
from boresight.files.plausible_units import Robot
from boresight.files.problems import listed, shown
from boresight.files.robots import arm_of, is_urdf, units_of
from boresight.files.schemas import CampaignEntry
from boresight.files.urdf import read_urdf


class RobotOf:
    """The robot that a campaign names: its arm, and, of a URDF, the file and what it cannot hold."""

    def __init__(
        self, document: Document, entry: CampaignEntry, inputs: dict[str, str], at: KeyPath = ("robot",)
    ) -> None:
        self._document, self._choice, self._inputs, self._at = document, entry.robot, inputs, at
        self.file: RobotFile | None = None
        self.held: frozenset[str] = frozenset()
        self.notes: tuple[str, ...] = ()
        self.called = Robot(self._choice.urdf or self._choice.file or f"catalogue: {self._choice.catalogue}", None)

    def read(self) -> Arm:
        """Returns the arm; raises an `InputError` where there is none."""
        name, place = self._choice.urdf or self._choice.file, self._document.at(self._at)
        if name is None:
            return _of_catalogue(self._choice.catalogue or "", place)
        path = self._document.path.parent / name
        if self._choice.urdf is None and not is_urdf(name):
            robot = read_document(path, name, place)
            self._inputs[name] = robot.sha256
            self.called = Robot(name, units_of(robot))
            return self._with_short_lengths(arm_of(robot), name)
        self.file = read_urdf(path, name, place, self._choice.base, self._choice.tip)
        self._inputs[name] = hashlib.sha256(self.file.content).hexdigest()
        chain = self.file.chain
        if not chain.ends_with_a_fixed_joint:
            last = chain.joints[-1].name
            self.held = frozenset(f"{last}.{number}" for number in ("a", "alpha", "beta"))
            self.notes = (
                f"{last}.a, .alpha and .beta are held: {chain.tip} is the link that {last} moves, and the URDF has no "
                "joint behind it to hold their corrections. Errors of the sensor's place are mount's.",
            )
        return chain.arm

    def _with_short_lengths(self, arm: Arm, name: str) -> Arm:
        """Returns the arm of a table, whose nearly parallel axes may carry lengths far beyond its own, and says so."""
        found = well_conditioned(arm)
        if found is not arm:
            longest = max(max(abs(joint.d), abs(joint.a)) for joint in arm.joints)
            now = max(max(abs(joint.d), abs(joint.a)) for joint in found.joints)
            self.notes = (
                f"{name}: nearly parallel axes carry lengths up to {longest:.4g} m; the arm is calibrated and written "
                f"with beta in place of d there, none of its lengths above {now:.2g} m. It moves the same.",
            )
        return found


def robot_of_campaign(path: Path | str) -> Arm:
    """Returns the arm of a campaign, whatever else the campaign names.

    Raises:
        InputError: the campaign or the arm cannot be read.
    """
    document = read_document(path)
    return RobotOf(document, validated(document, CampaignEntry), {}).read()


def _of_catalogue(wanted: str, place: str) -> Arm:
    from boresight.arm import catalogue  # a table of arms that most campaigns do without

    known = catalogue.names()
    if wanted not in known:
        near = did_you_mean(wanted[:60], known)
        raise InputError(f"{place}the catalogue has no arm {shown(wanted)}{near}; expected one of {listed(known)}")
    return catalogue.load(wanted)
