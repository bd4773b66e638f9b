"""What the readings cannot tell about a placement: chosen nearest to where frames stand in the file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from boresight.calibration.placement.equations import Equations
from boresight.calibration.placement.placements import Placements, Unknowns
from boresight.geometry import Frame, Plane, quaternion_matrix, rotation_angle
from boresight.sensing import Cell

SAME_RAD = 0.1
"""Sensors' axes that differ by no more than this are one."""

FAR = 4.0
"""Standard deviations from where it is stated beyond which a frame is not looked for."""

INDEPENDENT = 1e-6
"""Planes' normals with a smaller singular value leave directions of the base unseen."""


def least_turn(first: Float[np.ndarray, "n 3"], second: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3 3"]:
    """Returns the smallest turns that take unit vectors to others."""
    half = first + second
    opposite = np.linalg.norm(half, axis=1) < 1e-6
    aside = np.where(np.abs(first[:, [0]]) < 0.7, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    half = np.where(opposite[:, None], np.cross(first, aside), half)
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    w, axis = np.einsum("ni,ni->n", first, half), np.cross(first, half)
    return quaternion_matrix(np.concatenate([w[:, None], axis], axis=1))


def held(at: Placements, neutral: Placements, equations: Equations, unknowns: Unknowns) -> Placements:
    """Returns placements with what the equations do not see as near as may be to a neutral one.

    That is the spin about a beam, and of the base against one plane the spin about its normal and the shifts along
    it, against two the shift along both.
    """
    return _held_mounts(_held_base(at, neutral, equations, unknowns), neutral, equations, unknowns)


def _held_base(at: Placements, neutral: Placements, equations: Equations, unknowns: Unknowns) -> Placements:
    _, size, directions = np.linalg.svd(equations.normal, full_matrices=False)
    unseen = directions[size < INDEPENDENT * size[0]]
    shift, turn = at.base_shift, at.base_turn
    if unknowns.base[1]:
        shift = shift - (shift - neutral.base_shift) @ unseen.T @ unseen
    if unknowns.base[0] and len(unseen) == 2:
        normal = np.tile(equations.normal[0], (len(at), 1))
        seen = (normal[:, None, :] @ turn)[:, 0] @ neutral.base_turn[0].T
        turn = least_turn(seen, normal) @ neutral.base_turn
    return replace(at, base_shift=shift, base_turn=turn)


def _held_mounts(at: Placements, neutral: Placements, equations: Equations, unknowns: Unknowns) -> Placements:
    turns = at.mount_turn.copy()
    for mount, (turn, _) in enumerate(unknowns.mounts):
        axes = np.unique(equations.axis[(equations.mount == mount) & (equations.length != 0.0)])
        if not turn or len(axes) > 1:
            continue
        start = np.repeat(neutral.mount_turn[:, mount], len(at), axis=0)
        axis = int(axes[0]) if len(axes) else None
        turns[:, mount] = start if axis is None else least_turn(start[:, :, axis], turns[:, mount, :, axis]) @ start
    return replace(at, mount_turn=turns)


def same_but_for_the_base(cells: list[Cell]) -> bool:
    """Returns whether placements differ by a motion of the base that takes every plane to itself, and absolutely only.

    With fewer than three independent planes the base has motions that nothing sees anyway, so that only the tool's
    place relative to itself is asked for.
    """
    first = cells[0]
    planes = [plane for plane in first.targets.values() if isinstance(plane, Plane)]
    if not planes or len(planes) != len(first.targets) or _independent(planes) == 3:
        return False
    beams = np.array([[frame.matrix[:3, 2] for frame in cell.mounts.values()] for cell in cells])
    return bool((np.einsum("cmi,mi->cm", beams, beams[0]) > np.cos(SAME_RAD)).all())


def nearest_to(stated: Frame, cells: list[Cell]) -> list[Cell]:
    """Returns the cells in order of how far their bases are turned from a stated orientation."""
    turn = stated.matrix[:3, :3]
    return sorted(cells, key=lambda cell: float(rotation_angle(turn, cell.base.matrix[:3, :3])))


def is_near(found: Cell, stated: Cell, std: Mapping[str, float]) -> bool:
    """Returns whether frames stand no farther from where they are stated than `FAR` standard deviations allow.

    Args:
        found: where they may be.
        stated: where they were said to be.
        std: by parameter [m or rad]; what has none may be anywhere.
    """
    for name, frame, start in _frames(found, stated):
        turned = float(rotation_angle(frame.matrix[:3, :3], start.matrix[:3, :3]))
        turns = [std[f"{name}.{n}"] for n in ("roll", "pitch", "yaw") if f"{name}.{n}" in std]
        if len(turns) == 3 and turned > FAR * float(np.linalg.norm(turns)):
            return False
        for n, here, there in zip("xyz", frame.xyz, start.xyz, strict=True):
            if abs(here - there) > FAR * std.get(f"{name}.{n}", np.inf):
                return False
    return True


def _frames(first: Cell, second: Cell) -> list[tuple[str, Frame, Frame]]:
    return [
        ("base", first.base, second.base),
        *((name, frame, second.mounts[name]) for name, frame in first.mounts.items()),
    ]


def _independent(planes: list[Plane]) -> int:
    return int(np.linalg.matrix_rank(np.array([plane.normal for plane in planes]), tol=1e-3)) if planes else 0
