"""How every free parameter moves the sensor, or a target, in a set of configurations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from boresight.geometry import Plane, Point
from boresight.sensing import Cell, Target
from boresight.units import Quantity

_ROWS = 300
"""Configurations looked at: what moves alike in these moves alike in all."""


@dataclass(frozen=True)
class Movements:
    """Twists of the sensor by the free parameters, and what it aims at.

    Attributes:
        names: the free parameters.
        quantities: what each measures.
        twists: (rows, parameters, 6) the sensor's twist (v, w) about the world's origin a unit of each
            parameter, in the world; zero for a target's.
        of_target: for each parameter the target it belongs to, or "".
        poses: (rows, 4, 4) `T_world_sensor`.
        aimed: (rows,) index of each row's target among `targets`; -1 where it has none.
        mounted: (rows,) index of each row's mount.
        mounts: their names.
        targets: the targets that some row aims at, by name.
        sensors: by mount the type of a sensor there.
        point_names: the targets of the cell that are points, aimed at or not.
        base: `T_world_base`.
        first_axis: direction of the first joint's axis in the world.
        values: how many values are read in all.
    """

    names: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    twists: Float[np.ndarray, "rows parameters 6"]
    of_target: tuple[str, ...]
    poses: Float[np.ndarray, "rows 4 4"]
    aimed: Int[np.ndarray, "rows"]
    mounted: Int[np.ndarray, "rows"]
    mounts: tuple[str, ...]
    targets: dict[str, Target]
    sensors: dict[str, str]
    point_names: frozenset[str]
    base: Float[np.ndarray, "4 4"]
    first_axis: Float[np.ndarray, "3"]
    values: int

    @property
    def aimed_at(self) -> list[str]:
        """The targets that some row aims at."""
        return list(self.targets)

    @property
    def planes(self) -> dict[str, Plane]:
        """The planes among them."""
        return {name: target for name, target in self.targets.items() if isinstance(target, Plane)}

    @property
    def points(self) -> dict[str, Point]:
        """The points among them."""
        return {name: target for name, target in self.targets.items() if isinstance(target, Point)}

    @property
    def too_few(self) -> bool:
        """Whether there are fewer values than parameters, so that more is unseen than symmetry explains."""
        return self.values < len(self.names)


def movements_of(
    cell: Cell,
    joints: Float[np.ndarray, "rows joints"],
    target: Int[np.ndarray, "rows"],
    names: tuple[str, ...],
    corrections: Float[np.ndarray, "parameters"] | None = None,
) -> Movements:
    """Returns how the named parameters move what is measured.

    Args:
        cell: the cell.
        joints: configurations [rad or m].
        target: for each row the index of its aim.
        names: parameters of interest.
        corrections: added to the nominal values, in the order of the cell's parameters; none by default.
    """
    some = np.unique(np.linspace(0, len(joints) - 1, min(_ROWS, len(joints))).astype(int))
    moving = len(cell.moving)
    motion = cell.linearised_poses(joints[some], target[some], corrections)
    columns = [cell.index[name] for name in names]
    twists = np.zeros((len(some), len(names), 6))
    for place, column in enumerate(columns):
        if column < moving:
            twists[:, place] = motion.twists[:, column]
    by_name = (
        {} if corrections is None else {p.name: float(c) for p, c in zip(cell.parameters, corrections, strict=True)}
    )
    targets = cell.corrected({name: c for name, c in by_name.items() if cell.index[name] >= moving}).targets
    first = cell.arm.joints[0]
    axis = motion.twists[0, cell.index[f"{first.name}.d"], :3]  # d shifts along the axis, whichever way the joint moves
    aims = [cell.aims[place] for place in target[some]]
    used = [name for name in targets if any(aim.target == name for aim in aims)]
    widths = np.array([len(cell.sensors[aim.sensor].channels) for aim in cell.aims])
    return Movements(
        names,
        tuple(cell.parameters[column].quantity for column in columns),
        twists,
        tuple("" if column < moving else name.partition(".")[0] for name, column in zip(names, columns, strict=True)),
        motion.poses,
        np.array([used.index(aim.target) if aim.target in used else -1 for aim in aims]),
        np.array([list(cell.mounts).index(aim.mount) for aim in aims]),
        tuple(cell.mounts),
        {name: targets[name] for name in used},
        {aim.mount: cell.sensors[aim.sensor].type for aim in aims},
        frozenset(name for name, target in targets.items() if isinstance(target, Point)),
        cell.base.matrix,
        axis,
        int(np.sum(widths[target])),
    )
