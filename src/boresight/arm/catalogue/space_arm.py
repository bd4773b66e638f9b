"""A PUMA-like space arm that carries its laser off the last axis.

Source: this project. The nominal table of Liu, Ni, Liu & Xu, "Enhancing pose accuracy of space robot by
improved differential evolution" (2012), is an image in the paper and is lost from its text; these numbers
stand in for it, and so do the limits.

Standard D-H. Axes 2 and 3 are parallel, so `j2.beta` is to be identified in place of `j2.d`. The tool frame
is the laser's own: row 6 puts the beam 60 mm beside axis 6 and 30 degrees off it, or theta_6 could not be seen.
"""

from __future__ import annotations

from boresight.arm.catalogue.tables import revolute_arm

ARM = revolute_arm(
    "space-arm",
    (
        ("j1", 0.0, 0.35, 0.0, -90.0, (-170.0, 170.0)),
        ("j2", 0.0, 0.0, 0.45, 0.0, (-170.0, 170.0)),
        ("j3", 0.0, 0.15, 0.0, 90.0, (-170.0, 170.0)),
        ("j4", 0.0, 0.40, 0.0, -90.0, (-170.0, 170.0)),
        ("j5", 0.0, 0.0, 0.0, 90.0, (-120.0, 120.0)),
        ("j6", 0.0, 0.12, 0.06, 30.0, (-180.0, 180.0)),
    ),
)
