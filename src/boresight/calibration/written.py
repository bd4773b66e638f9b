"""In which files a campaign's numbers stand, and as what: for sentences that send a person there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from boresight.units import Units


@dataclass(frozen=True, slots=True)
class Written:
    """Where a campaign's numbers stand.

    Attributes:
        robot, campaign, observations: what the user calls these files; "" of what stands in no file.
        robot_units: of the robot's file.
        units: of the other two.
        offsets: of planes, by name, as the file has them: the package's own belong to normals of unit length.
    """

    robot: str = ""
    campaign: str = ""
    observations: str = ""
    robot_units: Units = Units()
    units: Units = Units()
    offsets: Mapping[str, float] = field(default_factory=dict)
