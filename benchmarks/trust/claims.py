"""What a result claims and names, read from any version of it: fields that it does not have claim nothing."""

from __future__ import annotations

import fnmatch
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

FIRST = 3
"""Explanations and sensitivities that count: nobody reads a tenth."""

UNSPECIFIC = re.compile(r"moves? in ways this model does not have")
"""A sentence that lists everything that is ever wrong names nothing, but that the noise does not fit."""


@dataclass(frozen=True)
class Claims:
    """What a person is told.

    Attributes:
        accepted: whether to use the result.
        accuracy: which accuracy of the tool it is accepted for, `absolute` or `relative`.
        joints: (rows, joints) configurations [rad or m].
        position, orientation: (rows, 3) [m] and (rows, 3, 3) of the tool there.
        radius: (rows,) that holds each position with 95 % probability, of that accuracy [m].
        angle: (rows,) the same of the orientation [rad].
        beam_alone: whether that orientation is the beam's, its spin left out.
        explanations, sensitivities: names of effects, best first.
        sentences: warnings, then reasons.
    """

    accepted: bool
    accuracy: str
    joints: np.ndarray
    position: np.ndarray
    orientation: np.ndarray
    radius: np.ndarray
    angle: np.ndarray
    beam_alone: bool
    explanations: tuple[str, ...]
    sensitivities: tuple[str, ...]
    sentences: tuple[str, ...]

    def names(self, effects: tuple[str, ...], words: str) -> tuple[str, ...]:
        """Returns where a cause is named: effects among the first few, and sentences' words.

        Args:
            effects: patterns of the effects that are it.
            words: regular expression of words that mean it.
        """
        told = (*self.explanations[:FIRST], *self.sensitivities[:FIRST])
        found = [name for name in told if any(fnmatch.fnmatchcase(name, each) for each in effects)]
        for sentence in self.sentences:
            text = "noise_std" if UNSPECIFIC.search(sentence) else sentence
            match = re.search(words, text)
            if match:
                found.append(f"“{match.group()[:40]}”")
        return tuple(dict.fromkeys(found))


def claims_of(result: Any) -> Claims:
    """Returns what a `Result` claims."""
    workspace = _first(result, "pose_uncertainty", "in_workspace")
    accuracy = "relative" if getattr(result.verdict, "accepted_for", None) == "relative" else "absolute"
    judged = getattr(getattr(result, "accuracy", None), accuracy, None) or workspace
    joints = np.asarray(getattr(judged, "pose", workspace).joints)
    poses = result.cell.poses(joints)
    return Claims(
        bool(result.verdict.accepted),
        accuracy,
        joints,
        poses[:, :3, 3],
        poses[:, :3, :3],
        np.asarray(getattr(judged, "pose", workspace).position_95),
        np.asarray(getattr(judged, "pose", workspace).orientation_95),
        bool(getattr(getattr(judged, "pose", workspace), "beam_alone", False)),
        tuple(each.effect for each in getattr(result, "explanations", None) or ()),
        tuple(each.effect for each in getattr(result, "sensitivities", None) or ()),
        (*result.warnings, *result.verdict.reasons),
    )


def _first(value: Any, *names: str) -> Any:
    """Returns the first of some attributes that there is."""
    for name in names:
        found = getattr(value, name, None)
        if found is not None:
            return found
    raise AttributeError(f"{type(value).__name__} has none of {', '.join(names)}")
