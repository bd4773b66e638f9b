"""Twists by central differences of the pose."""

import numpy as np

STEP = 1e-6


def twist_between(behind, ahead):
    """Returns (v, w) a unit of the step that leads from one pose to another, by central differences."""
    rate = (ahead - behind) / (2 * STEP)
    middle = 0.5 * (ahead + behind)
    spin = rate[:3, :3] @ middle[:3, :3].T
    w = 0.5 * np.array([spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0], spin[1, 0] - spin[0, 1]])
    return np.concatenate([rate[:3, 3] - np.cross(w, middle[:3, 3]), w])


def numeric_twist(chain, readings, corrections, column):
    """Returns the tool's twist in each configuration a unit of one parameter."""
    step = np.zeros_like(corrections)
    step[column] = STEP
    ahead, behind = chain.poses(readings, corrections + step), chain.poses(readings, corrections - step)
    return np.array([twist_between(*each) for each in zip(behind, ahead, strict=True)])
