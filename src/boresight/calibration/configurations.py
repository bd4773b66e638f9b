"""Which rows were taken in one configuration: several markers, repeats or beams there are one piece of evidence."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

SAME = 1e-2
"""Configurations nearer than this in every joint [rad or m] are one: they are left out together, or a repeated pose
would vouch for itself."""

FEW = 3000
"""Up to so many rows each is compared with the first of every configuration; more are sorted into cells."""


def configurations_of(joints: Float[np.ndarray, "rows joints"]) -> Int[np.ndarray, "rows"]:
    """Returns the number of each row's configuration, counted in the order of the rows."""
    if len(joints) > FEW:
        _, found = np.unique(np.round(joints / SAME), axis=0, return_inverse=True)
        return found.ravel()
    found = np.full(len(joints), -1)
    count = 0
    for row in range(len(joints)):
        if found[row] < 0:
            near = np.max(np.abs(joints[row:] - joints[row]), axis=1) <= SAME
            found[row:][near & (found[row:] < 0)] = count
            count += 1
    return found


def repeats_of(joints: Float[np.ndarray, "rows joints"]) -> Int[np.ndarray, "rows"]:
    """Returns how many rows share each row's configuration."""
    own = configurations_of(joints)
    return np.bincount(own)[own]
