"""Why a direction is unseen, and what would show it, in words for each kind of motion."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from boresight.inference.movements import Movements
from boresight.inference.symmetries import Kind, Symmetry
from boresight.sensing.cell import FRAME_NUMBERS

_SQUARE = np.radians(0.5)
"""An axis this close to a plane's normal is called perpendicular to the plane."""


def opening(symmetry: Symmetry, moves: Movements | None) -> str:
    """Returns what a motion of several parameters does, as the beginning of a sentence; "" where nothing is known."""
    if moves is None:
        return ""
    owners = {moves.of_target[i] for i in np.flatnonzero(symmetry.direction) if moves.of_target[i]}
    if symmetry.kind == "gliding":
        return f"moving them together only {_glides(moves, 'slides')}"
    if symmetry.kind == "base":
        verb = symmetry.motion.split()[0] if symmetry.motion else "moving"
        motion = symmetry.motion.replace(verb, f"{verb} the base", 1) if symmetry.motion else "moving the base"
        if owners:
            return f"{motion} while {verb} {_named(sorted(owners), moves)} with it changes no reading"
        if not moves.targets:
            return f"{motion} changes no reading, as distances do not depend on where the arm stands"
        return f"{motion} changes no reading" + ("" if "`" in motion else f", as {_targets(moves)} {_stay(moves)}")
    if symmetry.kind == "sensor":
        if symmetry.motion == "turning about z" and _has_beam(symmetry, moves):
            return "spin about the beam is not seen"
        motion, sensor = symmetry.motion or "moving", _mounted(symmetry, moves)
        return f"{motion.replace(' ', f' {sensor} ', 1) if ' ' in motion else f'moving {sensor}'} changes no reading"
    return ""


def group_reason(
    kind: Kind,
    names: tuple[str, ...],
    symmetries: list[Symmetry],
    scale: Float[np.ndarray, "parameters"],
    moves: Movements | None,
) -> str:
    """Returns why parameters do not change any reading by themselves, to be added to a sentence that says so."""
    if moves is None:
        return ""
    they = "it" if len(names) == 1 else "they"
    owners = {moves.of_target[int(np.argmax(np.abs(s.direction)))] for s in symmetries} - {""}
    if kind == "still" and owners:
        return f", because {_unused(owners, moves)}"
    if kind == "gliding":
        if reason := _perpendicular(moves):
            return f", because {reason}: {they} only {'moves' if they == 'it' else 'move'} the sensor along it"
        return f": {they} only {_glides(moves, 'moves' if they == 'it' else 'move')}"
    if kind == "base":
        return f": {they} only {'moves' if they == 'it' else 'move'} the whole arm"
    if kind == "sensor":
        if all(symmetry.motion == "turning about z" and _has_beam(symmetry, moves) for symmetry in symmetries):
            return ": spin about the beam is not seen"
        sensor = _mounted(symmetries[0], moves) if len({symmetry.mount for symmetry in symmetries}) == 1 else "a marker"
        return f": {they} only {'turns' if they == 'it' else 'turn'} {sensor} about its own origin"
    return ""


def mend(kind: Kind, names: tuple[str, ...], moves: Movements | None, motion: str = "", alone: bool = False) -> str:
    """Returns what would show a direction, or do without it.

    Args:
        kind: of motion.
        names: the parameters of the direction, the largest part first.
        moves: how they move sensor and targets.
        motion: which motion, if it has a name.
        alone: each of the parameters is a direction of its own.
    """
    fixable = min(names, key=lambda name: (_is_target(name, moves), names.index(name)))
    if kind == "still" and all(_is_target(name, moves) for name in names):
        return "aim some rows at it, or leave it out of `estimate:`"
    if alone and kind in ("still", "base", "sensor"):
        matters = "; if the tool needs it, measure it by other means" if kind == "sensor" else ""
        return f"fix {'it' if len(names) == 1 else 'them'}: `fixed: [{', '.join(names)}]`{matters}"
    if kind == "still":
        return f"fix one of them, say `fixed: [{_least_physical(names)}]`"
    if kind == "gliding":
        fixed = f"or fix {'it' if len(names) == 1 else 'them'}, as these readings need not know"
        if moves is not None and not moves.planes:
            return f"measure to more points, three that are not in line, {fixed}"
        plane = _targets(moves) if moves else "the plane"
        return f"measure against one more plane, not parallel to {plane}, {fixed}"
    if kind == "base":
        if any(_is_target(name, moves) for name in names):
            known = " (a known azimuth)" if motion == "turning about z" else ""
            what = "plane" if moves is None or moves.planes else "point"
            return (
                f"fix {fixable}, which then defines where the base is; or survey the {what}{known} and fix its "
                "parameters, or add a surveyed one; or give one of them a tighter `prior_std`"
            )
        if moves is not None and not moves.targets:
            return f"fix {fixable}; only positions in a known frame would show it"
        if moves is not None and moves.points and not moves.planes:
            return f"measure to one more point that is not in line with these, or fix {fixable}"
        return f"measure against one more plane that is not parallel to these, or fix {fixable}"
    if kind == "sensor":
        return f"fix {_least_physical(names)}; if the tool needs it, measure it by other means"
    return "measure more or other configurations, fix one of them, or give one a tighter `prior_std`"


def _is_target(name: str, moves: Movements | None) -> bool:
    return moves is not None and name in moves.names and bool(moves.of_target[moves.names.index(name)])


def _least_physical(names: tuple[str, ...]) -> str:
    """Returns the parameter to give up first: a frame's, then a beta, then the last named."""
    frame = tuple(f".{number}" for number in FRAME_NUMBERS)
    for wanted in (lambda n: n.endswith(frame), lambda n: n.endswith(".beta")):
        if chosen := [name for name in names if wanted(name)]:
            return chosen[-1]
    return names[-1]


def _glides(moves: Movements, verb: str) -> str:
    """Returns how the sensor moves where each row's target stays where it is, after a verb: "slides the sensor ..."."""
    if moves.planes and not moves.points:
        return f"{verb} the sensor along {_targets(moves)}"
    if moves.points and not moves.planes:
        return f"{'turns' if verb == 'slides' else verb} the sensor about {_targets(moves)}"
    return f"{verb} the sensor along or about {_targets(moves)}"


def _has_beam(symmetry: Symmetry, moves: Movements) -> bool:
    """Returns whether the mount that moves carries a sensor with a beam."""
    return moves.sensors.get(symmetry.mount) == "laser_ranger"


def _mounted(symmetry: Symmetry, moves: Movements) -> str:
    return "the sensor" if len(moves.mounts) == 1 else f"`{symmetry.mount}`"


def _targets(moves: Movements) -> str:
    return _named(moves.aimed_at, moves) if moves.targets else "its target"


def _named(targets: list[str], moves: Movements) -> str:
    """Returns targets as people list them: "planes `deck` and `wall` and point `anchor`"."""
    points = [name for name in targets if name in moves.point_names]
    groups = (("plane", [name for name in targets if name not in points]), ("point", points))
    return " and ".join(_group(kind, names) for kind, names in groups if names)


def _group(kind: str, names: list[str]) -> str:
    if len(names) == 1:
        return f"{kind} `{names[0]}`"
    return f"{kind}s {', '.join(f'`{name}`' for name in names[:-1])} and `{names[-1]}`"


def _stay(moves: Movements) -> str:
    return "stays where it is" if len(moves.aimed_at) == 1 else "stay where they are"


def _unused(owners: set[str], moves: Movements) -> str:
    return f"no row aims at {_named(sorted(owners), moves)}"


def _perpendicular(moves: Movements) -> str:
    """Returns that the planes are perpendicular to the first axis, or "" where they are not."""
    axis = moves.first_axis
    if moves.points or not moves.planes:
        return ""
    for plane in moves.planes.values():
        if np.linalg.norm(np.cross(axis, plane.normal)) > np.sin(_SQUARE):
            return ""
    verb = "is" if len(moves.aimed_at) == 1 else "are"
    return f"{_targets(moves)} {verb} perpendicular to the first axis"
