"""What ranges can identify, counted on the Jacobian (paper, section 3.1 and 4.3)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from boresight.geometry import Plane
from boresight.inference import identify_directions
from boresight.reproduction import setting
from boresight.reproduction.experiment import Experiment
from boresight.sensing import Cell

FLOOR = Plane.of((0.0, 0.0, 1.0), -0.15)
"""z + f = 0, the plane that the paper warns of."""

_SCALE = {"length": 0.02, "angle": 0.05, "number": 0.02}


@dataclass(frozen=True, slots=True)
class Ranks:
    """Numbers of independent parameters in a seed's configurations of case 2.

    Attributes:
        of_paper: rank of the 24 link parameters and the plane's two, 26 in all.
        of_pose: rank of every number of links, base and mount where the whole pose is measured.
        of_one_plane: the same from ranges to one known plane.
        of_floor: rank of the 24 link parameters from ranges to the plane z + f = 0.
        blind_to: which single parameters change no range to that plane.
    """

    of_paper: int
    of_pose: int
    of_one_plane: int
    of_floor: int
    blind_to: tuple[str, ...]


def ranks(campaign: Experiment) -> Ranks:
    """Returns what the configurations of case 2 could identify, at the nominal model."""
    cell = campaign.problem.cell
    joints = campaign.readings.joints[: setting.CASES[2]]
    links = [name for name in (setting.AZIMUTH, *setting.PRESET) if not name.startswith("deck")]
    everything = [parameter.name for parameter in cell.parameters[: len(cell.chain.parameters)]]
    floor = replace(cell, targets={"deck": FLOOR})
    flat = _slopes(floor, links, joints)
    sizes = np.linalg.norm(flat, axis=0)
    return Ranks(
        of_paper=_rank(_slopes(cell, [setting.AZIMUTH, *setting.PRESET], joints)),
        of_pose=_rank(_pose_slopes(cell, joints)),
        of_one_plane=_rank(_slopes(cell, everything, joints)),
        of_floor=_rank(flat),
        blind_to=tuple(name for name, size in zip(links, sizes, strict=True) if size < 1e-9 * sizes.max()),
    )


def _slopes(cell: Cell, names: list[str], joints: np.ndarray) -> np.ndarray:
    """Returns the scaled derivative of the ranges by the named parameters; beams that miss count for nothing."""
    _, jacobian = cell.linearise(joints, np.zeros(len(joints), dtype=int))
    columns = [cell.index[name] for name in names]
    return np.nan_to_num(jacobian[:, 0, columns], nan=0.0) * _scale(cell, columns)


def _pose_slopes(cell: Cell, joints: np.ndarray) -> np.ndarray:
    """Returns the scaled derivative of the whole pose by every number of links, base and mount."""
    twists = cell.chain.linearise(joints).twists
    rows, parameters, _ = twists.shape
    return np.swapaxes(twists, 1, 2).reshape(6 * rows, parameters) * _scale(cell, list(range(parameters)))


def _scale(cell: Cell, columns: list[int]) -> np.ndarray:
    return np.array([_SCALE[cell.parameters[column].quantity] for column in columns])


def _rank(scaled: np.ndarray) -> int:
    names = tuple(map(str, range(scaled.shape[1])))
    return identify_directions(names, scaled, np.ones(scaled.shape[1])).rank
