"""What joints and links do beside what geometry says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmarks.trust.cell import Cell
from benchmarks.trust.faults.fault import Fault, Rows, late


def encoder_noise(std: float) -> Fault:
    """Returns joints that stand elsewhere than they read, afresh each time [rad or m]."""
    return Fault(
        ("*encoder*", "*joint noise*", "*joint_noise*"),
        r"encoder|joint noise|joint readings|joint_noise",
        actual=lambda joints, random: joints + random.normal(0.0, std, joints.shape),
    )


def backlash(width: float) -> Fault:
    """Returns joints that stand at either end of a gap [rad or m]."""
    return Fault(
        ("*backlash*", "*encoder*", "*joint noise*", "*joint_noise*"),
        r"backlash|encoder|joint noise|joint readings|joint_noise",
        actual=lambda joints, random: joints + width * random.choice([-0.5, 0.5], joints.shape),
    )


def sag(give: float, mass: float) -> Fault:
    """Returns joints that give way to gravity [rad/(N m)] under links of this mass [kg]."""

    def truth(cell: Cell, random: np.random.Generator) -> Cell:
        each = give * random.uniform(0.5, 1.5, cell.arm.count)
        return replace(cell, give=each * cell.arm.revolute, mass=mass)

    return Fault(("gravity", "sag*", "*.sag*"), r"gravity|\bsag|weight", truth=truth)


def gain(joint: int, amount: float) -> Fault:
    """Returns a joint that turns by 1 + amount times its reading."""

    def truth(cell: Cell, random: np.random.Generator) -> Cell:
        return replace(cell, gain=amount * (np.arange(cell.arm.count) == joint - 1))

    return Fault((f"j{joint}.gain",), rf"j{joint}\.gain|\bgain\b", truth=truth)


def waves(height: float) -> Fault:
    """Returns gears that turn further once and twice a turn, of all joints [rad]."""

    def truth(cell: Cell, random: np.random.Generator) -> Cell:
        return replace(cell, waves=random.normal(0.0, height / np.sqrt(2.0), (cell.arm.count, 4)))

    return Fault(("*.harmonics", "*.cos?", "*.sin?", "harmonics"), r"harmonics|\.cos\d|\.sin\d", truth=truth)


def counts_backwards(joint: int) -> Fault:
    """Returns a joint whose column has the other sign."""

    def rows(rows: Rows, random: np.random.Generator) -> Rows:
        sign = np.where(np.arange(rows.joints.shape[1]) == joint - 1, -1.0, 1.0)
        return replace(rows, joints=sign * rows.joints)

    return Fault(
        (f"j{joint} counts*", f"j{joint}.sign*"), rf"j{joint}\b.*(backwards|sign|opposite|other way)", rows=rows
    )


def link_grows(joint: int, amount: float) -> Fault:
    """Returns a link whose a grows steadily [m]."""
    return Fault(
        ("drift*",),
        r"\bdrift",
        during=lambda cell, time: replace(cell, arm=cell.arm.corrected("a", _of_joint(cell, joint, amount * time))),
    )


def zero_moves(joint: int, amount: float) -> Fault:
    """Returns a joint whose zero moves half way [rad], as by a collision."""

    def during(cell: Cell, time: np.ndarray) -> Cell:
        return replace(cell, arm=cell.arm.corrected("theta", _of_joint(cell, joint, amount * late(time)[:, 0])))

    return Fault(("step*", "*jump*", "drift*"), r"\bstep|jump|than before|\bdrift", during=during)


def fixed_but_wrong(joint: int, number: str, amount: float) -> Fault:
    """Returns a link number [rad or m] that the campaign fixes at a value that it does not have."""

    def truth(cell: Cell, random: np.random.Generator) -> Cell:
        return replace(cell, arm=cell.arm.corrected(number, amount * (np.arange(cell.arm.count) == joint - 1)))

    name = f"j{joint}.{number}"
    return Fault((name,), name.replace(".", r"\."), truth=truth)


def _of_joint(cell: Cell, joint: int, amount: np.ndarray) -> np.ndarray:
    return amount[:, None] * (np.arange(cell.arm.count) == joint - 1)
