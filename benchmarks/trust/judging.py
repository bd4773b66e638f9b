"""Which of six outcomes a run has: what the result claims of the tool, set beside the truth.

An error and a claim are each one number a run: the root mean square over the configurations of true position errors,
and of the claimed 95 % radii. The parameters' errors are drawn once a run and move the tool everywhere, so a run is one
draw: with honest radii the first exceeds the second in about one run in twenty or fewer.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

Outcome = Literal["covered", "wide", "named", "SILENT", "rejected", "crash"]
OUTCOMES: tuple[Outcome, ...] = ("covered", "wide", "named", "SILENT", "rejected", "crash")

TWICE = 2.0
"""Beyond so many claimed radii a result is wrong, not unlucky."""


def outcome_of(accepted: bool, ratio: float, named: bool) -> Outcome:
    """Returns a run's outcome.

    - *covered*: accepted, and the true error is within the claimed radius, both root mean square.
    - *named*: accepted and outside, and the true cause is named.
    - *wide*: accepted and outside, but within twice the radius.
    - *SILENT*: accepted, beyond twice the radius, and the cause is not named.
    - *rejected*: not accepted, or refused with a sentence.

    Args:
        accepted: whether the result is.
        ratio: true error over claimed radius.
        named: whether the true cause is.
    """
    if not accepted:
        return "rejected"
    if ratio <= 1.0:
        return "covered"
    if named:
        return "named"
    return "wide" if ratio <= TWICE else "SILENT"


def position_errors(found: np.ndarray, truth: np.ndarray) -> dict[str, np.ndarray]:
    """Returns (rows,) position errors [m] by accuracy: absolute, and relative, after the best rigid motion.

    Args:
        found: (rows, 3) positions [m].
        truth: (rows, 3) the true ones.
    """
    return {
        "absolute": np.linalg.norm(found - truth, axis=1),
        "relative": np.linalg.norm(rigidly_aligned(found, truth) - truth, axis=1),
    }


def rigidly_aligned(points: np.ndarray, to: np.ndarray) -> np.ndarray:
    """Returns (rows, 3) points after the rotation and translation that bring them nearest (Kabsch 1976)."""
    return (points - points.mean(axis=0)) @ aligning_turn(points, to).T + to.mean(axis=0)


def aligning_turn(points: np.ndarray, to: np.ndarray) -> np.ndarray:
    """Returns (3, 3) that rotation."""
    u, _, vt = np.linalg.svd((points - points.mean(axis=0)).T @ (to - to.mean(axis=0)))
    mirror = np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))])
    return (u @ mirror @ vt).T


def turn_errors(found: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Returns (rows,) angles [rad] between (rows, 3, 3) orientations."""
    apart = np.swapaxes(found, 1, 2) @ truth
    sine = 0.5 * np.stack(
        [apart[:, 2, 1] - apart[:, 1, 2], apart[:, 0, 2] - apart[:, 2, 0], apart[:, 1, 0] - apart[:, 0, 1]], axis=1
    )
    return np.arctan2(np.linalg.norm(sine, axis=1), 0.5 * (np.trace(apart, axis1=1, axis2=2) - 1.0))


def beam_errors(found: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Returns (rows,) angles [rad] between the z axes of (rows, 3, 3) orientations."""
    across = np.linalg.norm(np.cross(found[:, :, 2], truth[:, :, 2]), axis=1)
    return np.arctan2(across, np.einsum("ri,ri->r", found[:, :, 2], truth[:, :, 2]))


def rms(values: np.ndarray) -> float:
    """Returns the root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))
