"""Joint commands by damped least squares from the nominal ones, on the compiled loop."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from boresight.arm import Arm
from boresight.compensation.compensation import Compensation, Reached
from boresight.geometry import rotation_angle
from boresight.kernels.programs import FIXED, SHIFT, TURN
from boresight.kernels.reaching import Limb, reach

REACHED_M, REACHED_RAD = 1e-8, 1e-8
"""A pose nearer than this counts as reached; a converged step leaves 1e-10."""

SINGULAR = 0.02
"""An arm is near a singular configuration where a radian of joint motion moves the tool by less than this share of
the arm's lever in some direction."""

LEVER = 1.0 / 3.0
"""Share of the arm's reach at which an angle counts as a distance."""

SPREADS = (0.05, 0.2, 0.1, 0.5, 0.3, 1.0)
"""Sizes [rad, or share of a slide's travel] by which starts are moved where the first did not get there: a
search that begins at a singular configuration may not leave it. Of stuck poses of random PUMA-like arms, half
are reached so; the others really are out of reach."""

BENDS = 5
"""Rounds in which readings are found from turns; each leaves a thousandth of what the last one left."""

FAR_STARTS = 24
"""Starts anywhere within the limits, for a pose that came without joint readings."""


def compensate(
    nominal: Arm,
    calibrated: Arm,
    *,
    joints: Float[np.ndarray, "rows joints"] | None = None,
    poses: Float[np.ndarray, "rows 4 4"] | None = None,
    position_only: bool = False,
) -> Compensation:
    """Returns joint readings that put the calibrated arm at the poses that the nominal arm was asked for.

    Args:
        nominal: the arm that the program was written for.
        calibrated: the arm as identified, of the same joints; its limits are respected.
        joints: the program's joint readings [rad or m]; the poses are the nominal arm's there.
        poses: wanted `T_base_flange`, of the frame after the last link; with `joints`, these are where to begin.
        position_only: whether to leave orientation free.

    Raises:
        ValueError: neither joints nor poses are given, or a shape is wrong.
    """
    if joints is None and poses is None:
        raise ValueError("compensate needs joints, poses or both")
    lever = 0.0 if position_only else LEVER * calibrated.reach
    if poses is None:
        assert joints is not None
        poses = nominal.forward_kinematics(joints)
    if joints is None:
        joints = _nominal_joints(nominal, poses, lever)
    if joints.shape != (len(poses), len(nominal.driven)) or poses.shape[1:] != (4, 4):
        raise ValueError(f"expected (rows, {len(nominal.driven)}) joints and (rows, 4, 4) poses")
    found, missing, weakest = _reach(calibrated, poses, joints, lever, SPREADS)
    there = _there(missing)
    low, high = calibrated.limits.T
    limited = ((found <= low) | (found >= high)).any(axis=1)
    singular = weakest < SINGULAR * LEVER * calibrated.reach
    reached = np.select(
        [there & ~singular, there, limited], [Reached.YES, Reached.NEAR_SINGULAR, Reached.AT_A_LIMIT], Reached.NO
    )
    return Compensation(
        nominal=nominal,
        calibrated=calibrated,
        poses=poses,
        nominal_joints=joints,
        joints=found,
        missing=missing,
        before=_apart(calibrated.forward_kinematics(joints), poses, position_only),
        weakest=weakest,
        reached=reached,
    )


def _nominal_joints(arm: Arm, poses: Float[np.ndarray, "rows 4 4"], lever: float) -> Float[np.ndarray, "rows joints"]:
    """Returns readings at which the arm is at the poses, each found from the middle of its limits or elsewhere."""
    low, high = _span(arm)
    middle = np.broadcast_to(0.5 * (low + high), (len(poses), len(low)))
    return _reach(arm, poses, middle, lever, (np.inf,) * FAR_STARTS)[0]


def _reach(
    arm: Arm,
    poses: Float[np.ndarray, "rows 4 4"],
    starts: Float[np.ndarray, "rows joints"],
    lever: float,
    spreads: tuple[float, ...],
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns joints, what is missing and the weakest motion, of an arm that may bend.

    Joints are found as they turn, then as they read: a bend is small and hardly depends on itself.
    """
    if not arm.is_bent:
        return _reach_rigid(arm, poses, starts, lever, spreads)
    low, high = arm.limits.T
    turned, _, weakest = _reach_rigid(arm, poses, starts + arm.bends(starts), lever, spreads)
    read = turned
    for _ in range(BENDS):
        read = np.clip(turned - arm.bends(read), low, high)
    return read, _apart(arm.forward_kinematics(read), poses, lever == 0.0), weakest


def _reach_rigid(
    arm: Arm,
    poses: Float[np.ndarray, "rows 4 4"],
    starts: Float[np.ndarray, "rows joints"],
    lever: float,
    spreads: tuple[float, ...],
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns the same where nothing bends; rows that do not get there begin again elsewhere."""
    limb = limb_of(arm)
    low, high = _span(arm)
    slides = np.array([joint.type == "prismatic" for joint in arm.driven])
    found, missing, weakest = _run(limb, poses, starts, lever)
    random = np.random.Generator(np.random.Philox(0))
    for spread in spreads:
        left = np.flatnonzero(~_there(missing))
        if not len(left):
            break
        shift = random.uniform(-1.0, 1.0, (len(left), len(low)))
        if np.isfinite(spread):
            again = starts[left] + spread * shift * np.where(slides, high - low, 1.0)
        else:
            again = 0.5 * (low + high) + 0.5 * (high - low) * shift
        other, still_missing, weak = _run(limb, poses[left], again, lever)
        better = _size(still_missing, lever) < 0.99 * _size(missing[left], lever)
        found[left[better]], missing[left[better]], weakest[left[better]] = (
            each[better] for each in (other, still_missing, weak)
        )
    return found, missing, weakest


def _run(limb: Limb, poses, starts, lever: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    joints, missing, weakest = np.empty(starts.shape), np.empty((len(starts), 2)), np.empty(len(starts))
    reach(limb, np.ascontiguousarray(poses), np.ascontiguousarray(starts), lever, joints, missing, weakest)
    return joints, missing, weakest


def limb_of(arm: Arm) -> Limb:
    """Returns an arm as the compiled loop takes it."""
    motions = [m for m in arm.chain.motions if m.factor is None and (m.value != 0.0 or m.joint is not None)]
    value = np.array([motion.value for motion in motions])
    low, high = arm.limits.T
    return Limb(
        kind=np.array([TURN if motion.turns else SHIFT for motion in motions], dtype=np.int64),
        axis=np.array([motion.axis for motion in motions], dtype=np.int64),
        value=value,
        sine=np.sin(value),
        cosine=np.cos(value),
        joint=np.array([FIXED if motion.joint is None else motion.joint for motion in motions], dtype=np.int64),
        ratio=np.array([motion.ratio for motion in motions]),
        lower=np.ascontiguousarray(low),
        upper=np.ascontiguousarray(high),
    )


def _span(arm: Arm) -> tuple[np.ndarray, np.ndarray]:
    """The limits, of turns within one turn either way: beyond, poses repeat."""
    slides = np.array([joint.type == "prismatic" for joint in arm.driven])
    low, high = arm.limits.T
    return np.where(slides, low, np.maximum(low, -np.pi)), np.where(slides, high, np.minimum(high, np.pi))


def _there(missing: Float[np.ndarray, "rows 2"]) -> np.ndarray:
    return (missing[:, 0] <= REACHED_M) & (missing[:, 1] <= REACHED_RAD)


def _size(missing: Float[np.ndarray, "rows 2"], lever: float) -> np.ndarray:
    return np.hypot(missing[:, 0], lever * missing[:, 1])


def _apart(found, wanted, position_only: bool) -> Float[np.ndarray, "rows 2"]:
    """Returns the distance [m] and angle [rad] between poses."""
    distance = np.linalg.norm(found[:, :3, 3] - wanted[:, :3, 3], axis=1)
    angle = rotation_angle(found[:, :3, :3], wanted[:, :3, :3])
    return np.stack([distance, np.zeros_like(angle) if position_only else angle], axis=1)
