"""`*.theta`, `j2.beta`, `deck.normal_z`: which parameters a pattern means."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cached_property

from boresight.errors import did_you_mean
from boresight.files.problems import listed, shown
from boresight.geometry import Plane
from boresight.sensing import Cell

_AXES = "xyz"
_Y = 1


@dataclass(frozen=True)
class Match:
    """What a pattern means in a cell.

    Attributes:
        parameters: the names it reaches, in the cell's order.
        stand_ins: for components of a normal that are not parameters, the one that is corrected instead.
    """

    parameters: tuple[str, ...]
    stand_ins: Mapping[str, str]


@dataclass(frozen=True)
class Matcher:
    """Looks patterns up among a cell's parameters.

    Attributes:
        cell: whose parameters they are.
    """

    cell: Cell

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Every parameter's name."""
        return tuple(parameter.name for parameter in self.cell.parameters)

    @cached_property
    def stand_ins(self) -> dict[str, str]:
        """For planes with n_y ~ 0, the dropped n_x or n_z and the n_y that is corrected in its place.

        Of a normal, two components are free and the third follows. Campaigns name x and z, as the paper
        does; where one of these follows, the pair that is asked for would otherwise be one number short.
        """
        return {
            f"{name}.normal_{_AXES[plane.dropped]}": f"{name}.normal_y"
            for name, plane in self.cell.targets.items()
            if isinstance(plane, Plane) and plane.dropped != _Y
        }

    @cached_property
    def frames(self) -> tuple[str, ...]:
        """Owners that a wildcard does not reach: freeing them is a decision of its own."""
        return ("base", *self.cell.mounts, *self.cell.sensors)

    def match(self, pattern: str) -> Match:
        """Returns what a pattern means; no parameters where it means nothing."""
        direct = [name for name in self.names if self._reaches(pattern, name)]
        replaced = {
            name: other
            for name, other in self.stand_ins.items()
            if self._reaches(pattern, name) and other not in direct
        }
        reached = {*direct, *replaced.values()}
        return Match(tuple(name for name in self.names if name in reached), replaced)

    def nothing(self, pattern: str) -> str:
        """Returns the sentence that a pattern reaches no parameter."""
        wildcards = dict.fromkeys(f"*.{name.partition('.')[2]}" for name in self._shared)
        near = did_you_mean(pattern[:60], (*self.names, *wildcards) if "*" not in pattern else wildcards)
        owners = dict.fromkeys(name.partition(".")[0] for name in self.names)
        reach = f"; * does not reach {listed(self.frames)}, name these in full" if "*" in pattern else ""
        examples = listed(list(self._shared)[:3])
        return (
            f"{shown(pattern)} is no parameter{near}; "
            f"expected names such as {examples} or *.theta, of {listed(owners)}{reach}"
        )

    @property
    def _shared(self) -> Sequence[str]:
        return [name for name in self.names if name.partition(".")[0] not in self.frames]

    def _reaches(self, pattern: str, name: str) -> bool:
        owner = name.partition(".")[0]
        if owner in self.frames and pattern.partition(".")[0] != owner:
            return False
        return pattern == name or fnmatchcase(name, pattern)
