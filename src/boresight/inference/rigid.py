"""Rigid motions as twists (v, w): those with names, and how they look from a plane and from the sensor."""

from __future__ import annotations

import itertools

import numpy as np

from boresight.inference.movements import Movements

AXES = {
    f"{verb} {axis}": np.eye(6)[3 * turns + place]
    for verb, turns in (("turning about", 1), ("shifting along", 0))
    for axis, place in (("z", 2), ("x", 0), ("y", 1))
}
"""Unit twists (v, w) about and along the axes of a frame."""


def base_motions(moves: Movements) -> dict[str, np.ndarray]:
    """Returns rigid motions of the base that people have words for, as twists in the world."""
    R, origin = moves.base[:3, :3], moves.base[:3, 3]

    def in_world(twist: np.ndarray) -> np.ndarray:
        v, w = R @ twist[:3], R @ twist[3:]
        return np.concatenate([v + np.cross(origin, w), w])

    named = {name: in_world(twist) for name, twist in AXES.items()}
    normals = {name: np.asarray(moves.targets[name].normal) for name in moves.aimed_at}
    for name, normal in normals.items():
        named[f"turning about the normal of plane `{name}`"] = np.concatenate([np.zeros(3), normal])
        _add_shift(named, f"along plane `{name}`, square to z,", np.cross(normal, np.eye(3)[2]))
        _add_shift(named, f"along plane `{name}`, towards z,", np.cross(normal, np.cross(normal, np.eye(3)[2])))
    for (first, a), (second, b) in itertools.combinations(normals.items(), 2):
        _add_shift(named, f"along the line where planes `{first}` and `{second}` meet", np.cross(a, b))
    return named


def _add_shift(named: dict[str, np.ndarray], name: str, direction: np.ndarray) -> None:
    """Adds a shift along a direction [any length], if it is one."""
    if (length := float(np.linalg.norm(direction))) > 1e-3:
        named[f"shifting {name}"] = np.concatenate([direction / length, np.zeros(3)])


def off_plane(twists: np.ndarray, moves: Movements) -> np.ndarray:
    """Returns (directions, rows, 4): how far each twist takes the plane a row aims at off itself."""
    planes = list(moves.targets.values())
    normals = np.array([plane.normal for plane in planes])[moves.aimed]
    feet = normals * -np.array([plane.offset for plane in planes])[moves.aimed][:, None]
    v, w = twists[..., :3], twists[..., 3:]
    lift = np.sum(normals * (v + np.cross(w, feet)), axis=-1, keepdims=True)
    return np.concatenate([lift, np.cross(w, np.broadcast_to(normals, w.shape))], axis=-1)


def seen_from_sensor(twists: np.ndarray, poses: np.ndarray) -> np.ndarray:
    """Returns twists (directions, rows, 6) about the sensor's origin and in its axes."""
    v, w = twists[..., :3], twists[..., 3:]
    R, p = poses[:, :3, :3], poses[:, :3, 3]
    moved = v + np.cross(w, np.broadcast_to(p, w.shape))
    return np.concatenate([np.einsum("rji,drj->dri", R, moved), np.einsum("rji,drj->dri", R, w)], axis=-1)
