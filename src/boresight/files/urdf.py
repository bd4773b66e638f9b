"""URDF, read: the joints from a base link to a tip link; everything else in the file is left alone."""

from __future__ import annotations

import math
import re
from pathlib import Path

from boresight.arm import Joint
from boresight.arm.serial import UNLIMITED, SerialChain, SerialJoint
from boresight.calibration.campaign import RobotFile
from boresight.errors import InputError, did_you_mean
from boresight.files.elements import Element, read_elements
from boresight.files.problems import Problems, printable, shown
from boresight.files.schemas import LARGEST, MOST_JOINTS, name_fault
from boresight.files.sources import Source, read_source
from boresight.files.tree import Tree, nearest, tree_of
from boresight.geometry import Frame

LIMIT_MIB = 16
SUFFIXES = (".urdf", ".xacro", ".xml")
"""How the names of descriptions end; anything else is read as a robot.yaml."""

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", re.ASCII)
_MOVING = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic"}
_Triple = tuple[float, float, float]


def read_urdf(
    path: Path | str, name: str | None = None, named_by: str = "", base: str | None = None, tip: str | None = None
) -> RobotFile:
    """Returns a URDF and the chain of joints in it that is the arm.

    Args:
        path: where it is.
        name: what the user calls it; the path as given by default.
        named_by: the place that names the file, as the beginning of a sentence.
        base: the link the arm stands on; the root link by default.
        tip: the link that carries the sensor; the last link, if there is only one, by default.

    Raises:
        InputError: everything that is wrong with the file.
    """
    name = str(path) if name is None else name
    source = read_source(
        Path(path), name, kind="a URDF file", limit_mib=LIMIT_MIB, mend="meshes belong in their own files",
        named_by=named_by,
    )  # fmt: skip
    return robot_file_of(source, base, tip)


def robot_file_of(source: Source, base: str | None = None, tip: str | None = None) -> RobotFile:
    """Returns a URDF whose bytes are at hand; see `read_urdf`."""
    root = read_elements(source)
    if root.name != "robot":
        raise InputError(
            printable(f"{source.name}, line {root.line}: <{root.name[:60]}> is not URDF; expected <robot>")
        )
    tree = tree_of(root, source.name)
    base, tip, joints = tree.chain(base, tip)
    if sum(element.attributes.get("type") != "fixed" for element in joints) > MOST_JOINTS:
        raise InputError(printable(f"{source.name}: more than {MOST_JOINTS} joints move between {base} and {tip}"))
    problems = Problems()
    read = [_joint(element, tree, source.name, problems) for element in joints]
    problems.raise_if_any()
    joints_read = tuple(joint for joint in read if joint is not None)
    if all(joint.type == "fixed" for joint in joints_read):
        raise InputError(
            printable(f"{source.name}: no joint from {base} to {tip} moves; expected an arm between base and tip")
        )
    title = root.attributes.get("name", "").strip()
    chain = SerialChain(
        title if title.isprintable() and title else printable(Path(source.name).stem), base, tip, joints_read
    )
    return RobotFile(source.name, source.content, _following(chain, tree, source.name))


def moving_joints(path: Path | str) -> tuple[Joint, ...]:
    """Returns every joint of a URDF that moves by a reading of its own, whatever chain it is on: names and types alone.

    Raises:
        InputError: it cannot be read.
    """
    source = read_source(
        Path(path), str(path), kind="a URDF file", limit_mib=LIMIT_MIB, mend="meshes belong in their own files"
    )
    tree = tree_of(read_elements(source), source.name)
    return tuple(
        Joint(name, "prismatic" if element.attributes["type"] == "prismatic" else "revolute")
        for name, element in tree.joints.items()
        if element.attributes.get("type") in _MOVING and not element.all("mimic") and name_fault(name) is None
    )


def _joint(element: Element, tree: Tree, file: str, problems: Problems) -> SerialJoint | None:
    name = element.attributes["name"]
    place = f"{file}, line {element.line}: joint {name}: "
    kind = element.attributes.get("type", "")
    if kind not in _MOVING and kind != "fixed":
        known = "fixed, revolute, continuous, prismatic"
        between = f"on the chain from {tree.base} to {tree.tip}"
        problems.add(f"{place}got type {shown(kind)}{did_you_mean(kind[:60], [*_MOVING, 'fixed'])}; expected one of "
                     f"{known} {between}")  # fmt: skip
        return None
    reader = _Reader(element, place, problems)
    origin = Frame(reader.triple("origin", "xyz"), reader.triple("origin", "rpy"))
    if kind == "fixed":
        return SerialJoint(name, "fixed", origin)
    fault = name_fault(name)
    if fault:
        problems.add(f"{place}parameters are called after joints; expected {fault}")
    axis = reader.triple("axis", "xyz", (1.0, 0.0, 0.0))
    length = math.hypot(*axis)
    if not length > 1e-9:
        problems.add(f"{place}the axis has no direction; expected one such as 0 0 1")
        return None
    limits = _limits(reader, kind)
    if limits == UNLIMITED and kind == "prismatic" and not element.all("mimic"):
        problems.add(f'{place}a prismatic joint needs limits; expected <limit lower="0" upper="0.5" .../>')
    x, y, z = (value / length + 0.0 for value in axis)
    return SerialJoint(name, "prismatic" if kind == "prismatic" else "revolute", origin, (x, y, z), limits)


def _limits(reader: _Reader, kind: str) -> tuple[float, float]:
    lower, upper = (reader.number("limit", side, 0.0, most=math.inf) for side in ("lower", "upper"))
    # Revolute without limits, with both 0, or with limits no joint reaches is how some tools write "none given".
    if kind == "continuous" or not lower < upper or max(-lower, upper) > LARGEST:
        return UNLIMITED
    return lower, upper


def _following(chain: SerialChain, tree: Tree, file: str) -> SerialChain:
    """Returns the chain with every joint that mimics one on the chain following it, through others if need be."""
    problems, known = Problems(), {joint.name for joint in chain.moving}
    joints = []
    for joint in chain.joints:
        name, ratio, offset, seen = joint.name, 1.0, 0.0, {joint.name}
        # fixed joints cannot follow, and what follows a joint off the chain is read itself
        while joint.type != "fixed" and (mimic := tree.joints[name].all("mimic")):
            place = f"{file}, line {mimic[0].line}: joint {name}: mimic: "
            reader = _Reader(tree.joints[name], f"{file}, line {mimic[0].line}: joint {name}: ", problems)
            offset += ratio * reader.number("mimic", "offset", 0.0)
            ratio *= reader.number("mimic", "multiplier", 1.0)
            name = mimic[0].attributes.get("joint", "")
            if name not in tree.joints:
                problems.add(f"{place}there is no joint {shown(name)}{nearest(name, tree.joints)}")
            elif name in seen:
                problems.add(f"{place}{name} mimics itself, round about; expected a joint with a reading of its own")
            if problems or name in seen:
                break
            seen.add(name)
        if name != joint.name and name in known:
            joints.append(_follower(joint, name, ratio, offset))
        else:
            joints.append(joint)
    problems.raise_if_any()
    return SerialChain(chain.name, chain.base, chain.tip, tuple(joints))


def _follower(joint: SerialJoint, name: str, ratio: float, offset: float) -> SerialJoint:
    return SerialJoint(joint.name, joint.type, joint.origin, joint.axis, joint.limits, name, ratio, offset)


class _Reader:
    """Numbers of a joint's elements, each fault a sentence."""

    def __init__(self, joint: Element, place: str, problems: Problems) -> None:
        self._joint, self._place, self._problems = joint, place, problems

    def triple(self, tag: str, attribute: str, default: _Triple = (0.0, 0.0, 0.0)) -> _Triple:
        """Returns three numbers, or the default where the file gives none."""
        text = self._text(tag, attribute)
        if text is None:
            return default
        words = text.split(maxsplit=3)  # what is left of a long text is not looked at
        numbers = [_number(word) for word in words]
        if len(words) != 3 or None in numbers:
            self._problems.add(f"{self._place}{tag} {attribute}: got {shown(text)}; expected 3 finite numbers")
            return default
        x, y, z = (number for number in numbers if number is not None)
        return x, y, z

    def number(self, tag: str, attribute: str, default: float, most: float = LARGEST) -> float:
        """Returns a number, or the default where the file gives none."""
        text = self._text(tag, attribute)
        if text is None:
            return default
        number = _number(text.strip(), most)
        if number is None:
            self._problems.add(f"{self._place}{tag} {attribute}: got {shown(text)}; expected a finite number")
            return default
        return number

    def _text(self, tag: str, attribute: str) -> str | None:
        elements = self._joint.all(tag)
        if len(elements) > 1:
            problem = f"{self._place}there are {len(elements)} elements <{tag}>; expected one"
            self._problems.add(problem)
        return elements[0].attributes.get(attribute) if elements else None


def _number(word: str, most: float = LARGEST) -> float | None:
    if not _NUMBER.fullmatch(word) or len(word) > 400:
        return None
    value = float(word)
    return value if abs(value) <= most else None
