"""Every placement that explains the readings well, from starts all over the orientations.

For each of many turns of the base the rest follows by linear least squares, robustly; from there all trials descend
together (Levenberg-Marquardt with weights that fall with the residual), and the best that differ are kept. Nothing
here needs a guess, and a few hundred trials take a fraction of a second.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float, Int

from boresight.calibration.placement.equations import Equations
from boresight.calibration.placement.gauge import held, least_turn
from boresight.calibration.placement.placements import Placements, Unknowns, linearised, residuals, started
from boresight.geometry import quaternion_matrix

TRIALS = 1000
"""Turns of the base that are tried: about 20 degrees from one to the next."""

ROUGH, FINE = 8, 30
"""Steps of all trials, and of the best."""

KEPT = 24
"""Trials that are followed to the end."""

DIFFERENT_RAD = 0.15
"""Placements differ where a plane's normal as the arm sees it, or a sensor's axis, does by more than this."""

LINEAR_ROUNDS = 4
SPARE_ROWS = 3
"""Rows more than unknowns that a set of a few has."""

SOFT = 1.5
"""A residual weighs half where it is about this many times the median one."""

FLOOR_M = 1e-6
WEAK = 1e-7
"""Share of the largest curvature that holds what the equations do not see where it is."""


def search(
    equations: Equations, neutral: Placements, unknowns: Unknowns, trials: int = TRIALS
) -> tuple[Placements, Float[np.ndarray, " n"]]:
    """Returns placements that differ, the best first, and what each typically leaves [m].

    Args:
        equations: what must hold.
        neutral: one placement: what is known, and neutral values of what is not.
        unknowns: what is sought.
        trials: how many turns of the base, or of sets of rows, are tried.
    """
    turns = _turns_all_over(trials) if unknowns.base[0] else np.repeat(neutral.base_turn, trials, axis=0)
    at = _by_linear_least_squares(started(turns, neutral, unknowns), equations, unknowns)
    at = _descended(at, equations, unknowns, ROUGH)
    at = at.chosen(np.argsort(typical(residuals(at, equations)))[:KEPT])
    at = _descended(at, equations, unknowns, FINE)
    left = typical(residuals(at, equations))
    order = np.argsort(left)
    at, left = at.chosen(order), left[order]
    different = _different(at, equations)
    return held(at.chosen(different), neutral, equations, unknowns), left[different]


def typical(left: Float[np.ndarray, "*batch equations"]) -> Float[np.ndarray, "*batch"]:
    """Returns the squared mean of the roots of residuals [m]: those that fit count, gross ones little."""
    return np.asarray(np.mean(np.sqrt(np.abs(left)), axis=-1) ** 2)


def _turns_all_over(count: int) -> Float[np.ndarray, "count 3 3"]:
    """Returns orientations spread evenly over all: a spiral on the quaternions (Alexa, CVPR 2022)."""
    s = np.arange(count) + 0.5
    inner, outer = np.sqrt(s / count), np.sqrt(1.0 - s / count)
    first, second = 2.0 * np.pi * s / np.sqrt(2.0), 2.0 * np.pi * s / 1.533751168755204288118041
    return quaternion_matrix(
        np.stack([inner * np.sin(first), inner * np.cos(first), outer * np.sin(second), outer * np.cos(second)], axis=1)
    )


def _by_linear_least_squares(at: Placements, equations: Equations, unknowns: Unknowns) -> Placements:
    """Returns the trials with shifts and mounts' axes by robust linear least squares, given the base's turns."""
    e, trials = equations, len(at)
    in_base = e.normal @ at.base_turn
    in_flange = np.einsum("sej,ejk->sek", in_base, e.rotation)
    columns, slots = [], []
    if unknowns.base[1]:
        columns.append(np.broadcast_to(e.normal * e.carried[:, None], in_base.shape))
        slots.append(("base", 0, 0))
        at = replace(at, base_shift=np.zeros_like(at.base_shift))
    for mount, (turn, shift) in enumerate(unknowns.mounts):
        own = e.mount == mount
        if shift:
            columns.append(in_flange * (e.carried * own)[:, None])
            slots.append(("shift", mount, 0))
        for axis in range(3) if turn else ():
            of_axis = own & (e.axis == axis) & (e.length != 0.0)
            if of_axis.any():
                columns.append(in_flange * (e.length * of_axis)[:, None])
                slots.append(("axis", mount, axis))
    if not columns:
        return at
    A = np.concatenate(columns, axis=2)
    rest = residuals(_without(at, unknowns), e)
    ridge = WEAK * np.einsum("sei,sei->s", A, A)[:, None, None] * np.eye(A.shape[2]) + 1e-12 * np.eye(A.shape[2])
    weight = _first_weights(trials, e, A.shape[2])
    for _ in range(LINEAR_ROUNDS):
        weighed = A * weight[:, :, None]
        normal = np.swapaxes(weighed, 1, 2) @ A + ridge
        x = -np.linalg.solve(normal, np.einsum("sei,se->si", weighed, rest)[..., None])[..., 0]
        left = rest + np.einsum("sei,si->se", A, x)
        weight = _weights(left)
    parts = dict(zip(slots, np.split(x, x.shape[1] // 3, axis=1), strict=True))
    base_shift = parts.get(("base", 0, 0), at.base_shift)
    turns, shifts = at.mount_turn.copy(), at.mount_shift.copy()
    for mount in range(len(unknowns.mounts)):
        shifts[:, mount] = parts.get(("shift", mount, 0), shifts[:, mount])
        axes = {axis: parts["axis", mount, axis] for axis in range(3) if ("axis", mount, axis) in parts}
        if axes:
            turns[:, mount] = _turned_to(turns[:, mount], axes)
    return Placements(at.base_turn.reshape(trials, 3, 3), base_shift, turns, shifts)


def _first_weights(trials: int, equations: Equations, unknowns: int) -> Float[np.ndarray, "trials equations"]:
    """Returns all rows for every other trial, and for those between a few: of these some are free of gross errors."""
    random = np.random.Generator(np.random.Philox(0))
    rows = np.unique(equations.row)
    each = len(equations) / len(rows)
    share = min((unknowns / each + SPARE_ROWS) / len(rows), 1.0)
    chosen = random.random((trials, len(rows))) < share
    chosen[::2] = True
    return chosen[:, np.searchsorted(rows, equations.row)].astype(float)


def _without(at: Placements, unknowns: Unknowns) -> Placements:
    """Returns the trials with what linear least squares seeks at zero, the mounts' axes too."""
    turns, shifts = at.mount_turn.copy(), at.mount_shift.copy()
    for mount, (turn, shift) in enumerate(unknowns.mounts):
        turns[:, mount] *= 0.0 if turn else 1.0
        shifts[:, mount] *= 0.0 if shift else 1.0
    return replace(at, mount_turn=turns, mount_shift=shifts)


def _turned_to(
    neutral: Float[np.ndarray, "trials 3 3"], axes: dict[int, Float[np.ndarray, "trials 3"]]
) -> Float[np.ndarray, "trials 3 3"]:
    """Returns the rotations nearest to neutral ones among those whose axes point along given vectors."""
    wanted = neutral.copy() if len(axes) < 3 else np.zeros_like(neutral)
    for axis, vector in axes.items():
        wanted[:, :, axis] = vector / np.maximum(np.linalg.norm(vector, axis=1, keepdims=True), 1e-12)
    if len(axes) == 1:
        axis = next(iter(axes))
        return least_turn(neutral[:, :, axis], wanted[:, :, axis]) @ neutral
    u, _, vt = np.linalg.svd(wanted)
    u[:, :, 2] *= np.sign(np.linalg.det(u @ vt))[:, None]
    return u @ vt


def _descended(at: Placements, equations: Equations, unknowns: Unknowns, steps: int) -> Placements:
    """Returns the trials after so many robust Levenberg-Marquardt steps."""
    damping = np.full(len(at), 1e-2)
    left, slopes = linearised(at, equations, unknowns)
    count = slopes.shape[1]
    for _ in range(steps):
        weight = _weights(left)
        scale = np.maximum(SOFT * np.median(np.abs(left), axis=1), FLOOR_M)
        weighed = slopes * weight[:, None, :]
        curvature = weighed @ np.swapaxes(slopes, 1, 2)
        diagonal = np.einsum("sii->si", curvature)
        hold = damping[:, None] * diagonal + WEAK * diagonal.max(axis=1, keepdims=True) + 1e-12
        gradient = np.einsum("spe,se->sp", weighed, left)
        step = -np.linalg.solve(curvature + hold[:, :, None] * np.eye(count), gradient[..., None])[..., 0]
        moved = at.moved(step, unknowns)
        new, new_slopes = linearised(moved, equations, unknowns)
        better = _loss(new, scale) < _loss(left, scale)
        at = moved.where(better, at)
        left = np.where(better[:, None], new, left)
        slopes = np.where(better[:, None, None], new_slopes, slopes)
        damping = np.clip(np.where(better, 0.2 * damping, 6.0 * damping), 1e-9, 1e6)
    return at


def _weights(left: Float[np.ndarray, "trials equations"]) -> Float[np.ndarray, "trials equations"]:
    """Returns weights that fall with the square of a residual beyond a trial's usual ones (Cauchy)."""
    scale = np.maximum(SOFT * np.median(np.abs(left), axis=1), FLOOR_M)
    return 1.0 / (1.0 + (left / scale[:, None]) ** 2)


def _loss(left: Float[np.ndarray, "trials equations"], scale: Float[np.ndarray, " trials"]) -> np.ndarray:
    return np.asarray(np.sum(np.log1p((left / scale[:, None]) ** 2), axis=1))


def _different(at: Placements, equations: Equations) -> Int[np.ndarray, " chosen"]:
    """Returns the trials, in their order, that differ from every one before them."""
    seen = _seen_directions(at, equations)
    chosen: list[int] = []
    for trial in range(len(at)):
        cosine = np.einsum("cdi,di->cd", seen[chosen], seen[trial])
        if not (cosine.min(axis=1, initial=1.0) > np.cos(DIFFERENT_RAD)).any():
            chosen.append(trial)
    return np.array(chosen)


def _seen_directions(at: Placements, equations: Equations) -> Float[np.ndarray, "trials directions 3"]:
    """Returns the planes' normals in the arm's base and the sensors' axes in the flange, those that matter."""
    e = equations
    normals = np.unique(e.normal, axis=0) @ at.base_turn
    used = np.unique(np.stack([e.mount, e.axis], axis=1)[e.length != 0.0], axis=0)
    axes = [at.mount_turn[:, mount, :, axis] for mount, axis in used]
    return np.concatenate([normals, *(axis[:, None] for axis in axes)], axis=1)
