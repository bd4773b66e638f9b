"""Unimation PUMA 560.

Source: P. I. Corke & B. Armstrong-Hélouvry, "A search for consensus among model parameters reported for the
PUMA 560 robot", IEEE Int. Conf. Robotics and Automation, 1994, pp. 1608-1613; the table as in Corke's
Robotics Toolbox (`mdl_puma560`), whose limits these are too.

Standard D-H with Paul's signs of the twists, as there; a zero reading is the righty L-shaped pose. The base
frame lies where axes 1 and 2 cross (0.672 m above the floor), the tool frame at the wrist's centre: neither
pedestal nor flange is in the table. Axes 2 and 3 are parallel, so `j2.beta` is to be identified in place of `j2.d`.
Sources differ in the last digits: d_3 is 0.1491 to 0.1501 and d_4 0.4318 to 0.4331.
"""

from __future__ import annotations

from boresight.arm.catalogue.tables import revolute_arm

ARM = revolute_arm(
    "puma560",
    (
        ("j1", 0.0, 0.0, 0.0, 90.0, (-160.0, 160.0)),
        ("j2", 0.0, 0.0, 0.4318, 0.0, (-45.0, 225.0)),
        ("j3", 0.0, 0.15005, 0.0203, -90.0, (-225.0, 45.0)),
        ("j4", 0.0, 0.4318, 0.0, 90.0, (-110.0, 170.0)),
        ("j5", 0.0, 0.0, 0.0, -90.0, (-100.0, 100.0)),
        ("j6", 0.0, 0.0, 0.0, 0.0, (-266.0, 266.0)),
    ),
)
