"""Frames that were estimated beside the arm: where they stand, and how far off the tool is without them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from boresight.arm import Arm
from boresight.geometry import Frame, inverse, rotation_angle, rpy_matrix, triple_of
from boresight.report.converting import configurations
from boresight.units import in_millimetres

_AXES, _TURNS = ("x", "y", "z"), ("roll", "pitch", "yaw")


@dataclass(frozen=True, slots=True)
class EstimatedFrame:
    """A frame of a result that was estimated.

    Attributes:
        name: `base`, `mount` or a marker.
        identified: where it was found.
        stated: where the campaign states it; None where any of it is unknown there.
    """

    name: str
    identified: Frame
    stated: Frame | None


def estimated_frames(document: Mapping[str, Any]) -> tuple[EstimatedFrame, ...]:
    """Returns the frames that a result's document says were estimated and moved."""
    changes = {parameter["name"]: parameter["correction"] for parameter in document["parameters"]}
    found = []
    for name, place in document["frames"].items():
        own = {part: changes[f"{name}.{part}"] for part in (*_AXES, *_TURNS) if f"{name}.{part}" in changes}
        if any(change is None or change != 0.0 for change in own.values()):
            identified = Frame(triple_of(place["xyz"]), triple_of(place["rpy"]))
            found.append(EstimatedFrame(name, identified, _stated(identified, own)))
    return tuple(found)


def in_words(frames: tuple[EstimatedFrame, ...], arm: Arm) -> tuple[str, ...]:
    """Returns a sentence for each estimated frame: where it stands, and what its absence costs an identified arm."""
    return tuple(_in_words(frame, arm) for frame in frames)


def _in_words(frame: EstimatedFrame, arm: Arm) -> str:
    xyz, rpy = ([round(value, 12) + 0.0 for value in part] for part in (frame.identified.xyz, frame.identified.rpy))
    where = "in the world" if frame.name == "base" else "in the flange"
    shift, turn = _moved(frame.identified, frame.stated or Frame(), arm if frame.name == "base" else None)
    without = "Where the campaign states it" if frame.stated is not None else "Without it, at the identity"
    return (
        f"`{frame.name}` was estimated too and is not in this format: it stands {where} at xyz {xyz} (m), rpy {rpy} "
        f"(rad). {without}, the tool would be off by {in_millimetres(shift)} and {_turn(turn)}."
    )


def _moved(one: Frame, other: Frame, arm: Arm | None) -> tuple[float, float]:
    """Returns how far [m] a frame, or the tool of an arm on it, stands from where it would on another, and its turn."""
    points = np.zeros((1, 3)) if arm is None else arm.forward_kinematics(configurations(arm))[:, :3, 3]
    T = one.matrix - other.matrix
    turn = rotation_angle(one.matrix[None, :3, :3], other.matrix[None, :3, :3])
    return float(np.linalg.norm(points @ T[:3, :3].T + T[:3, 3], axis=1).max()), float(turn[0])


def _turn(turn: float) -> str:
    return in_millimetres(turn).replace("mm", "mrad")


def _stated(identified: Frame, changes: Mapping[str, float | None]) -> Frame | None:
    """Returns where a frame stood before its corrections; None where it was nowhere."""
    known = [changes.get(part, 0.0) for part in (*_AXES, *_TURNS)]
    if None in known:
        return None
    shift, turn = np.array(known[:3], float), tuple(float(value or 0.0) for value in known[3:])
    T = np.eye(4)
    T[:3, :3] = rpy_matrix((turn[0], turn[1], turn[2]))
    before = Frame.of(identified.matrix @ inverse(T))
    return Frame(triple_of(np.array(identified.xyz) - shift), before.rpy)
