"""What Universal Robots' driver and controller read: six transforms, or deltas to a D-H table without beta."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from boresight.arm import Arm
from boresight.arm.arm import Joint
from boresight.arm.common_normals import link_transform, standard_dh
from boresight.arm.screws import screws_of
from boresight.arm.serial import SerialChain, chain_of, corrected_chain
from boresight.errors import InputError
from boresight.files.names import comment_lines, yaml_key
from boresight.files.problems import printable
from boresight.geometry import Frame, inverse, rotation_angle

LINKS = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
"""The keys of a kinematics file, in order."""

JOINTS = ("shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint")
"""How the joints' names end, whatever prefix they have."""

EXACT = 1e-9
"""An export whose forward kinematics is off by more [m or rad] is refused."""

_STILL = 1e-12
_FAR = 0.1


@dataclass(frozen=True)
class UniversalChain:
    """An arm with UR's frames: z along every axis, at zero all theta 0, the base turned so that this is so.

    Attributes:
        nominal, identified: from UR's base to the tool; the tool's fixed joint comes last.
        turn: angle [rad] about z by which UR's base is turned in the arm's own.
    """

    nominal: SerialChain
    identified: SerialChain
    turn: float = 0.0


def is_universal(arm: Arm) -> bool:
    """Whether an arm's joints are called as UR's."""
    return len(arm.joints) == len(JOINTS) and all(
        joint.name.endswith(name) for joint, name in zip(arm.joints, JOINTS, strict=True)
    )


def universal_chain(nominal: Arm, identified: Arm) -> UniversalChain:
    """Returns a six-axis arm with UR's frames, before and after; both in standard D-H.

    Raises:
        InputError: it is not six turning axes, the first two at an angle.
    """
    if len(nominal.joints) != 6 or any(joint.type != "revolute" or joint.follows for joint in nominal.joints):
        raise InputError(f"{nominal.name}: this format is of six revolute joints; export to urdf, dh or json instead")
    screws = screws_of(nominal)
    normal = np.cross(screws.joints[0].axis, screws.joints[1].axis)
    if np.linalg.norm(normal[:2]) < 0.1:
        raise InputError(f"{nominal.name}: the first two axes are not at an angle as UR's are; export to urdf instead")
    # UR's x of the base lies along the common normal of the first two axes, so that theta is 0 at zero.
    angle = math.atan2(normal[1], normal[0])
    turn = link_transform(angle, 0.0, 0.0, 0.0, 0.0)
    seen = chain_of(standard_dh(screws.seen_from(inverse(turn))))
    both = [corrected_chain(_moved(seen, turn), nominal, arm) for arm in (nominal, identified)]
    before, after = (_moved(chain, inverse(turn)) for chain in both)
    return UniversalChain(before, after, turn=angle if abs(angle) > _STILL else 0.0)


def universal_blocks(chain: UniversalChain) -> tuple[dict[str, Frame], tuple[str, ...]]:
    """Returns the six transforms of a kinematics file, and what a person should know about them."""
    *joints, tool = chain.identified.joints
    notes = _turned_base(chain)
    if not _is_nothing(tool.origin):
        notes.append(
            f"This format ends at the last joint. Behind it the tool stands at {_in_words(tool.origin)}: add that to "
            "the tool's own transform."
        )
    return dict(zip(LINKS, (joint.origin for joint in joints), strict=True)), tuple(notes)


def _turned_base(chain: UniversalChain) -> list[str]:
    """Returns what a person should know about the base of the format, nothing where it is the arm's own."""
    if not chain.turn:
        return []
    return [
        f"This format's base frame is the arm's own turned by {chain.turn:.9g} rad about z, so that the first joint "
        "stands at 0 as UR's does."
    ]


def kinematics_yaml(blocks: Mapping[str, Frame], header_comment: str, notes: Sequence[str] = ()) -> str:
    """Returns the text of a file for `kinematics_params_file`.

    Args:
        blocks: each joint's frame in the one before, by the block's key.
        header_comment: lines to put above it.
        notes: what a person should know, put there too.
    """
    block = []
    for name, origin in blocks.items():
        block.append(f"  {yaml_key(name)}:")
        numbers = zip(("x", "y", "z", "roll", "pitch", "yaw"), (*origin.xyz, *origin.rpy), strict=True)
        block += [f"    {key}: {value + 0.0!r}" for key, value in numbers]
    digits = int.from_bytes(hashlib.sha256("\n".join(block).encode()).digest()[:8], "big")
    said = [
        *comment_lines(header_comment),
        "Each block is a joint's frame in the one before: metres, and radians about fixed axes, R = Rz(yaw) Ry(pitch)",
        "Rx(roll), as the description reads them. The hash is of these numbers; a driver that compares it with the",
        "controller's own will say that they differ.",
        *map(printable, notes),
    ]
    text = [*(f"# {line}" for line in said), "kinematics:", *block, f"  hash: calib_{digits}"]
    return "\n".join(text) + "\n"


def calibration_conf(chain: UniversalChain, header_comment: str) -> str:
    """Returns the `[mounting]` section of a controller's calibration.conf: deltas to the nominal D-H table.

    Raises:
        InputError: D-H without beta cannot hold the arm to a nanometre, and why.
    """
    before = _pure(chain.nominal)
    after = _pure(chain.identified, before)
    error = _difference(after, chain.identified)
    if not error < EXACT:
        raise InputError(
            f"{chain.nominal.name}: D-H without beta cannot hold this arm: its poses would be off by {error:.2g} (m or "
            f"rad). {_why(chain)} Export to ur-kinematics or urdf instead"
        )
    lines = [f"# {line}" for line in (*comment_lines(header_comment), *_turned_base(chain))]
    lines.append("# Added to this nominal table (theta, d, a, alpha; rad and m):")
    lines += [f"#   {j.name}: {j.theta!r}, {j.d!r}, {j.a!r}, {j.alpha!r}" for j in before.joints]
    if any(abs(b.d - a.d) > _FAR for a, b in zip(before.joints, after.joints, strict=True)):
        lines.append("# Nearly parallel axes meet their common normal far away: deltas of d that cancel are in order.")
    lines.append("[mounting]")
    for number in ("theta", "a", "d", "alpha"):
        deltas = [getattr(b, number) - getattr(a, number) for a, b in zip(before.joints, after.joints, strict=True)]
        if number == "theta":
            deltas = [math.remainder(delta, 2 * math.pi) for delta in deltas]
        lines.append(f"delta_{number} = [ {', '.join(repr(delta + 0.0) for delta in deltas)}]")
    return "\n".join(lines) + "\n"


def _pure(chain: SerialChain, like: Arm | None = None) -> Arm:
    """Returns an arm in D-H without beta, from UR's base to the tool, as nearly as it has such numbers."""
    arm = standard_dh(chain.screws, 0.0, like)
    T = np.eye(4)
    for joint in arm.joints[:-1]:
        T = T @ link_transform(joint.theta, joint.d, joint.a, joint.alpha, 0.0)
    # The tool's x and z are given, so the last theta has no other way round.
    last = inverse(T) @ chain.screws.home
    theta = math.atan2(last[1, 0], last[0, 0])
    a = math.cos(theta) * last[0, 3] + math.sin(theta) * last[1, 3]
    end = Joint(
        arm.joints[-1].name,
        theta=theta,
        d=float(last[2, 3]),
        a=float(a),
        alpha=math.atan2(last[2, 1], math.cos(theta) * last[1, 1] - math.sin(theta) * last[0, 1]),
        limits=arm.joints[-1].limits,
    )
    first = (Joint(j.name, theta=j.theta, d=j.d, a=j.a, alpha=j.alpha, limits=j.limits) for j in arm.joints[:-1])
    return Arm(arm.name, (*first, end))


def _difference(arm: Arm, chain: SerialChain) -> float:
    """Returns the largest difference of position [m] or orientation [rad] over some configurations."""
    joints = np.random.Generator(np.random.Philox(0)).uniform(-math.pi, math.pi, (100, len(arm.joints)))
    ours, theirs = arm.forward_kinematics(joints), chain.screws.forward_kinematics(joints)
    shift = np.linalg.norm(ours[:, :3, 3] - theirs[:, :3, 3], axis=1)
    return float(max(shift.max(), rotation_angle(ours[:, :3, :3], theirs[:, :3, :3]).max()))


def _why(chain: UniversalChain) -> str:
    axes = [np.array(screw.axis) for screw in chain.identified.screws.joints]
    sines = [float(np.linalg.norm(np.cross(a, b))) for a, b in pairwise(axes)]
    closest = min(range(len(sines)), key=lambda place: sines[place] if sines[place] > 0.0 else math.inf)
    if 0.0 < sines[closest] < 1e-6:
        names = [screw.name for screw in chain.identified.screws.joints]
        return (
            f"The axes of {names[closest]} and {names[closest + 1]} are within {sines[closest]:.1g} rad of parallel, "
            "and their common normal is too far away."
        )
    if not _is_nothing(Frame.of(inverse(_before_tool(chain.identified)) @ chain.identified.screws.home)):
        return "The first axis or the tool stands where no theta, d, a and alpha lead."
    return "The first axis does not stand where theta and d of the first joint lead."


def _before_tool(chain: SerialChain):
    return chain.screws.home @ inverse(chain.joints[-1].origin.matrix)


def _moved(chain: SerialChain, T) -> SerialChain:
    """Returns the chain seen from another base: `T_new_base`."""
    first, *others = chain.joints
    origin = Frame.of(T @ first.origin.matrix)
    return SerialChain(chain.name, chain.base, chain.tip, (first.placed(origin), *others))


def _is_nothing(frame: Frame) -> bool:
    return bool(np.abs(frame.matrix - np.eye(4)).max() < _STILL)


def _in_words(frame: Frame) -> str:
    xyz, rpy = (" ".join(f"{round(value, 12) + 0.0:.9g}" for value in part) for part in (frame.xyz, frame.rpy))
    return f"xyz {xyz} (m), rpy {rpy} (rad)"
