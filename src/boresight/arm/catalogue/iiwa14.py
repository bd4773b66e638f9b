"""KUKA LBR iiwa 14 R820.

Source: KUKA Roboter, "LBR iiwa 7 R800, LBR iiwa 14 R820: Specification" (2015): distances between axes 360,
420 and 400 mm, axis ranges; "Media Flange for product family LBR iiwa: Assembly and operating instructions":
126 mm from axis 6 to the plain flange.

Standard D-H with KUKA's senses of rotation; the arm points straight up at zero. The tool frame is the flange.
Some URDFs in circulation shift axes 2 to 3 by 0.43624 mm; KUKA's drawings do not.
"""

from __future__ import annotations

from boresight.arm.catalogue.tables import revolute_arm

ARM = revolute_arm(
    "iiwa14",
    (
        ("joint_a1", 0.0, 0.36, 0.0, -90.0, (-170.0, 170.0)),
        ("joint_a2", 0.0, 0.0, 0.0, 90.0, (-120.0, 120.0)),
        ("joint_a3", 0.0, 0.42, 0.0, 90.0, (-170.0, 170.0)),
        ("joint_a4", 0.0, 0.0, 0.0, -90.0, (-120.0, 120.0)),
        ("joint_a5", 0.0, 0.40, 0.0, -90.0, (-170.0, 170.0)),
        ("joint_a6", 0.0, 0.0, 0.0, 90.0, (-120.0, 120.0)),
        ("joint_a7", 0.0, 0.126, 0.0, 0.0, (-175.0, 175.0)),
    ),
)
