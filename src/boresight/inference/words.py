"""Unseen directions in plain words."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from boresight.inference.identifiability import Identifiability


def unseen_in_words(
    found: Identifiability, scale: Float[np.ndarray, "parameters"]
) -> list[tuple[tuple[str, ...], str]]:
    """Returns for every unseen direction its parameters and a sentence that says what cannot be told.

    Parameters that change no reading by themselves come first, together in one sentence.

    Args:
        found: what the data see.
        scale: the size by which each parameter was scaled.
    """
    alone = tuple(found.names[int(np.argmax(np.abs(row)))] for row in found.unseen if np.count_nonzero(row) == 1)
    said: list[tuple[tuple[str, ...], str]] = []
    if alone:
        verb = "does" if len(alone) == 1 else "do"
        said.append((alone, f"{listed(alone)} {verb} not change any reading"))
    for row in found.unseen:
        touched = np.flatnonzero(row)
        if len(touched) > 1:
            names = tuple(found.names[i] for i in sorted(touched, key=lambda i: -abs(row[i])))
            said.append(
                (names, f"{listed(names)} cannot be told apart: {_together(found, row * scale)} changes no reading")
            )
    return said


def listed(names: tuple[str, ...] | list[str], most: int = 8) -> str:
    """Returns names as people list them: "a, b and c"."""
    shown = [*names[:most], f"{len(names) - most} more"] if len(names) > most else list(names)
    return shown[0] if len(shown) == 1 else f"{', '.join(shown[:-1])} and {shown[-1]}"


def _together(found: Identifiability, direction: Float[np.ndarray, "parameters"]) -> str:
    """Returns a direction as moves of its parameters: "moving a by 1 and b by -0.2 together"."""
    touched = sorted(np.flatnonzero(direction), key=lambda i: -abs(direction[i]))
    leading = direction[touched[0]]
    moves = [f"{found.names[i]} by {direction[i] / leading:.3g}" for i in touched[:4]]
    more = f" (and {len(touched) - 4} more)" if len(touched) > 4 else ""
    return f"moving {listed(moves)}{more} together"
