"""The setting of the paper's section 4 as data: arm, plane, preset errors, scopes and the numbers of eq. (24).

Tables 1 and 2 of the paper are images and lost. Table 1 is replaced by the catalogue's PUMA-like space arm. Table 2
was chosen for this project: link errors drawn once, uniform within 4 mrad and 2 mm, and rounded, so that the tool
starts about as far off as in the sister paper (J. Robotics 2012, 587407: 4.4 mm and 5.1 mrad RMS); errors of the
plane's normal are the paper's own (section 4.3).
"""

from __future__ import annotations

from boresight.arm import catalogue
from boresight.geometry import Plane
from boresight.search import STRATEGIES, DifferentialEvolution, Stops
from boresight.sensing import LaserRanger

ARM = catalogue.load("space-arm")
"""In place of table 1."""

DECK = Plane.of((0.0, 1.0, 4.6), -0.69)
"""Eq. (23), normalised."""

WALLS = {"wall_x": Plane.of((-1.0, 0.15, 0.2), 1.6), "wall_y": Plane.of((0.1, -1.0, 0.15), 1.7)}
"""Two surveyed planes beside it, for the comparison with three planes."""

RANGER = LaserRanger(noise_std=0.0002, repeats=10)
"""Section 4.1: noise of 0.2 mm, each configuration the mean of 10 readings."""

AZIMUTH = "j1.theta"
"""The parameter that no range tells from the plane's azimuth."""

PRESET = {
    "j2.theta": 0.0027,
    "j3.theta": -0.0035,
    "j4.theta": -0.0004,
    "j5.theta": -0.0038,
    "j6.theta": 0.0016,
    "j1.d": -0.0017,
    "j3.d": 0.0007,
    "j4.d": -0.0014,
    "j5.d": -0.0014,
    "j6.d": -0.0001,
    "j1.a": -0.0006,
    "j2.a": 0.0012,
    "j3.a": -0.0010,
    "j4.a": -0.0010,
    "j5.a": -0.0012,
    "j6.a": 0.0001,
    "j1.alpha": -0.0017,
    "j2.alpha": -0.0009,
    "j3.alpha": -0.0014,
    "j4.alpha": 0.0003,
    "j5.alpha": -0.0016,
    "j6.alpha": 0.0009,
    "j2.beta": -0.0005,
    "deck.normal_x": 0.005,
    "deck.normal_z": 0.010,
}
"""Real minus nominal value [m, rad, 1] of the 25 parameters of x, in the order of eq. (19); in place of table 2.

`j2.beta` stands for `j2.d` (axes 2 and 3 are parallel), and `j1.theta` is the definition of azimuth."""

PRESET_AZIMUTH = 0.0025
"""Error of `j1.theta` [rad] where it is free as a 26th parameter."""

PRINTED_NORMAL = {"deck.normal_x": 0.005, "deck.normal_z": 0.010}
"""Section 4.3 once more, to be added to (0, 1, 4.6) where the errors are read as those of (23) as it is printed."""

LARGEST_ERROR = {"angle": 0.004, "length": 0.002}
"""Half-widths [rad, m] of link errors where they are drawn anew for every seed."""

SCOPE = {"angle": 0.025, "length": 0.010, "number": 0.020}
"""Half-widths [rad, m, 1] of the "constrained scopes" (step 2), which the paper does not give."""

CASES = {1: 35, 2: 100}
"""Section 4.4: configurations of each case."""

MOST_ROWS = 200
"""Configurations drawn a seed; the cases take the first ones, as the paper's 35 are of its 100."""

VALIDATION_ROWS = 20

STOPS = Stops(generations=500, cost=1e-4 * 1e-6, patience=10**9)
"""G = 500 and V = 1e-4 mm² (eq. 24); the paper knows no patience."""

THEIRS = ("rand/1", "best/1", "trade-off")
"""Strategies that the paper compares (eq. 14, 15, 16)."""

CANDIDATES = ("trade-off", "rand-to-best/1", "current-to-best/1")
"""Readings of eq. (16), which is lost."""


def evolution(strategy: str) -> DifferentialEvolution:
    """Returns the search with the numbers of eq. (24)."""
    return DifferentialEvolution(STRATEGIES[strategy], population=150, scale=0.6, crossover=0.9)
