"""Canadarm2, the Space Station Remote Manipulator System (SSRMS).

Source: P. K. Nguyen & P. C. Hughes, "Teleoperation: from the space shuttle to the space station", in
"Teleoperation and Robotics in Space", Progress in Astronautics and Aeronautics 161, AIAA, 1994, p. 353,
by way of the description that cites it in vyas-shubham/TraceableRobotModels (its numbers, not its text): the offsets
between the joints (1.3589, 0.7026, 0.5692, 7.11, 0.475, 7.11, 0.5692, 0.7026, 1.3589 m) and the directions of
the axes in the straight pose (roll x, yaw z, pitch y three times, yaw z, roll x).

Standard D-H, arranged by this project so that a zero reading is that straight pose and every joint turns in
the published sense, which makes the offsets along the pitch axes negative. The base frame is where the
shoulder's end effector is latched, z along the boom; the tool frame is the free end effector's, z out of it.
Axes 3, 4 and 5 are parallel: identify beta in place of d for joints 3 and 4.
"""

from __future__ import annotations

from boresight.arm.catalogue.tables import revolute_arm

_RANGE = (-270.0, 270.0)

ARM = revolute_arm(
    "canadarm2",
    (
        ("shoulder_roll", 0.0, 1.3589, 0.0, 90.0, _RANGE),
        ("shoulder_yaw", -90.0, 0.7026, 0.0, 90.0, _RANGE),
        ("shoulder_pitch", 180.0, -0.5692, 7.11, 0.0, _RANGE),
        ("elbow_pitch", 0.0, -0.475, 7.11, 0.0, _RANGE),
        ("wrist_pitch", 0.0, -0.5692, 0.0, 90.0, _RANGE),
        ("wrist_yaw", 90.0, -0.7026, 0.0, 90.0, _RANGE),
        ("wrist_roll", 0.0, 1.3589, 0.0, 0.0, _RANGE),
    ),
)
