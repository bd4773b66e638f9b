"""Rigid motions as twists (v, w): those with names, and how they look from a plane and from the sensor."""

from __future__ import annotations

import itertools

import numpy as np

from boresight.geometry import Plane, Point
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
    normals = {name: np.asarray(plane.normal) for name, plane in moves.planes.items()}
    for name, normal in normals.items():
        named[f"turning about the normal of plane `{name}`"] = np.concatenate([np.zeros(3), normal])
        _add_shift(named, f"along plane `{name}`, square to z,", np.cross(normal, np.eye(3)[2]))
        _add_shift(named, f"along plane `{name}`, towards z,", np.cross(normal, np.cross(normal, np.eye(3)[2])))
    for (first, a), (second, b) in itertools.combinations(normals.items(), 2):
        _add_shift(named, f"along the line where planes `{first}` and `{second}` meet", np.cross(a, b))
    points = {name: np.asarray(point.xyz) for name, point in moves.points.items()}
    for (first, a), (second, b) in itertools.combinations(points.items(), 2):
        if (length := float(np.linalg.norm(b - a))) > 1e-3:
            axis = (b - a) / length
            named[f"turning about the line through points `{first}` and `{second}`"] = _turning(axis, a)
    for name, at in points.items():
        for axis_name, axis in zip("zxy", np.eye(3)[[2, 0, 1]], strict=True):
            named[f"turning about the {axis_name} axis through point `{name}`"] = _turning(axis, at)
    return named


def _turning(axis: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Returns the twist of a turn about an axis through a point."""
    return np.concatenate([np.cross(point, axis), axis])


def _add_shift(named: dict[str, np.ndarray], name: str, direction: np.ndarray) -> None:
    """Adds a shift along a direction [any length], if it is one."""
    if (length := float(np.linalg.norm(direction))) > 1e-3:
        named[f"shifting {name}"] = np.concatenate([direction / length, np.zeros(3)])


def off_target(twists: np.ndarray, moves: Movements) -> np.ndarray:
    """Returns (directions, rows, 6): how far each twist takes the target a row aims at off itself, padded with zeros.

    A plane by its lift and tilt, a point by its shift; where a row aims at nothing the twist itself.
    """
    off = np.array(twists)
    v, w = twists[..., :3], twists[..., 3:]
    for place, target in enumerate(moves.targets.values()):
        rows = moves.aimed == place
        at = (v[:, rows], w[:, rows])
        off[:, rows] = _off_plane(*at, target) if isinstance(target, Plane) else _off_point(*at, target)
    return off


def _off_plane(v: np.ndarray, w: np.ndarray, plane: Plane) -> np.ndarray:
    normal = np.asarray(plane.normal)
    lift = np.sum(normal * (v + np.cross(w, -plane.offset * normal)), axis=-1, keepdims=True)
    return np.concatenate(
        [lift, np.cross(w, np.broadcast_to(normal, w.shape)), np.zeros((*lift.shape[:-1], 2))], axis=-1
    )


def _off_point(v: np.ndarray, w: np.ndarray, point: Point) -> np.ndarray:
    shift = v + np.cross(w, np.broadcast_to(point.xyz, w.shape))
    return np.concatenate([shift, np.zeros_like(shift)], axis=-1)


def seen_from_sensor(twists: np.ndarray, poses: np.ndarray) -> np.ndarray:
    """Returns twists (directions, rows, 6) about the sensor's origin and in its axes."""
    v, w = twists[..., :3], twists[..., 3:]
    R, p = poses[:, :3, :3], poses[:, :3, 3]
    moved = v + np.cross(w, np.broadcast_to(p, w.shape))
    return np.concatenate([np.einsum("rji,drj->dri", R, moved), np.einsum("rji,drj->dri", R, w)], axis=-1)
