"""How a row is taken: with which sensor, where on the tool, aimed at what, in which session."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from boresight.geometry import Frame
from boresight.sensing.sensor import Sensor, Target


@dataclass(frozen=True, slots=True)
class Aim:
    """One way in which rows are taken.

    Attributes:
        sensor: name of the sensor.
        mount: where on the flange it, or the marker that it looks at, sits.
        target: what it is aimed at, or None.
        session: the block of rows whose offset of the sensor's is its own, or None.
    """

    sensor: str
    mount: str
    target: str | None = None
    session: str | None = None

    @property
    def offset(self) -> str:
        """The name of the offset of the aim's session."""
        return f"{self.sensor}.bias[{self.session}]"


def default_aims(
    sensors: Mapping[str, Sensor], mounts: Mapping[str, Frame], targets: Mapping[str, Target]
) -> tuple[Aim, ...]:
    """Returns every sensor on every mount at every target of its kind."""
    return tuple(
        Aim(name, mount, target)
        for name, sensor in sensors.items()
        for mount in mounts
        for target in targets_of(sensor, targets)
    )


def targets_of(sensor: Sensor, targets: Mapping[str, Target]) -> tuple[str | None, ...]:
    """Returns the names of the targets that a sensor can be aimed at; None alone where it needs none."""
    kind = sensor.aims_at
    return (None,) if kind is None else tuple(name for name, target in targets.items() if isinstance(target, kind))
