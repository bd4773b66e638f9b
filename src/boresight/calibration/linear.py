"""A fit's neighbourhood: the readings as linear functions of its parameters and of what might be added to them.

Many rows are thinned: what a few thousand do not ask for is not worth adding.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from boresight.arm import HARMONICS, SAG
from boresight.calibration.campaign import Freedom, Term
from boresight.calibration.robust import Fit
from boresight.calibration.thinning import thinned
from boresight.inference import Shrunk, Squares, select_visible, shrink
from boresight.sensing import Cell

ANGLES, LENGTHS, ONCE, TWICE = "angles", "lengths", "once a turn", "twice a turn"

KINDS: dict[str, tuple[str, ...]] = {"geometry": (ANGLES, LENGTHS), "gravity": ("gravity",), "harmonics": (ONCE, TWICE)}
"""The kinds of parameters, each of which has a standard deviation to be learned, by what they describe."""

ADDED = (*KINDS["gravity"], *KINDS["harmonics"])
"""The kinds that are beyond geometry."""

USUAL_STD = {ANGLES: 1e-3, LENGTHS: 1e-3, "gravity": 1e-3, ONCE: 1e-3, TWICE: 1e-3}
"""Where learning begins [rad or m]."""

SEEN = 1e-3
"""What changes readings by less than this share of the most effective of its kind is not added: gravity cannot turn
an upright axis."""


@dataclass(frozen=True)
class Neighbourhood:
    """Readings near a fit, each over its standard deviation, rows that the fit left out left out.

    Attributes:
        cell: the nominal cell with everything that might be added.
        names: the free parameters and then what might be added.
        kind: (parameters,) each one's kind; "" where its standard deviation is not to be learned.
        at: (parameters,) where the fit is.
        prior_std: (parameters,) of those without a kind, infinite where nothing is believed.
        jacobian: (rows, channels, parameters).
        left: (rows, channels) measured minus predicted.
        std: (rows, channels) what they are divided by; infinite where a row has no such channel.
        joints: (rows, joints).
    """

    cell: Cell
    names: tuple[str, ...]
    kind: tuple[str, ...]
    at: Float[np.ndarray, "parameters"]
    prior_std: Float[np.ndarray, "parameters"]
    jacobian: Float[np.ndarray, "rows channels parameters"]
    left: Float[np.ndarray, "rows channels"]
    std: Float[np.ndarray, "rows channels"]
    joints: Float[np.ndarray, "rows joints"]

    def columns(self, terms: Iterable[str]) -> Int[np.ndarray, "some"]:
        """Returns the places of the parameters of geometry and some terms."""
        kinds = {"", *(kind for term in ("geometry", *terms) for kind in KINDS[term])}
        return np.array([place for place, kind in enumerate(self.kind) if kind in kinds])

    def distinct(self) -> Neighbourhood:
        """Returns the neighbourhood without additions that change readings as geometry and earlier ones do.

        About a level axis, the weight of the link that turns with it is a wave of the joint's angle, once a turn.
        """
        flat = self.jacobian.reshape(-1, len(self.names))
        size = np.linalg.norm(flat, axis=0)
        visible = set(select_visible(flat / np.where(size > 0.0, size, 1.0), list(range(len(self.names))), SEEN))
        return self._some([p for p, kind in enumerate(self.kind) if p in visible or kind not in ADDED])

    def _some(self, places: list[int]) -> Neighbourhood:
        return replace(
            self,
            names=tuple(self.names[p] for p in places),
            kind=tuple(self.kind[p] for p in places),
            at=self.at[places],
            prior_std=self.prior_std[places],
            jacobian=self.jacobian[:, :, places],
        )

    def squares(self, rows: Int[np.ndarray, "some"] | slice = slice(None)) -> Squares:
        """Returns the normal equations of some rows."""
        jacobian = self.jacobian[rows]
        return Squares.of(jacobian.reshape(-1, jacobian.shape[2]), self.left[rows].ravel())

    def learned(self, squares: Squares, terms: Iterable[str]) -> tuple[Shrunk, dict[str, float]]:
        """Returns the fit of geometry and some terms to some rows, and every kind's standard deviation."""
        columns = self.columns(terms)
        present = list(dict.fromkeys(self.kind[column] for column in columns if self.kind[column]))
        group = np.array([present.index(self.kind[c]) if self.kind[c] else -1 for c in columns])
        start = np.array([USUAL_STD[kind] for kind in present])
        found = shrink(squares.on(columns), self.at[columns], self.prior_std[columns], group, start)
        return found, dict(zip(present, (float(std) for std in found.group_std), strict=True))


def neighbourhood_of(fit: Fit, terms: tuple[Term, ...], learn: bool) -> Neighbourhood:
    """Returns the neighbourhood of a fit.

    Args:
        fit: where.
        terms: what might be added.
        learn: whether the standard deviations of the geometry's own parameters are to be learned too.
    """
    problem, kept = fit.problem, np.flatnonzero(fit.kept)
    rows = kept[thinned(problem.readings.chosen(kept))]
    readings, std = problem.readings.chosen(rows), problem.std[rows]
    cell = equipped(problem.cell, terms)
    own = tuple(_own_kind(cell, freedom, terms, learn) for freedom in problem.freedoms)
    added = {name: kind for name in cell.index if (kind := _kind(name, terms)) and name not in problem.names}
    names = (*problem.names, *added)
    corrections = np.zeros(len(cell.parameters))
    corrections[[cell.index[name] for name in problem.names]] = fit.x
    errors, full = cell.errors(readings, corrections), cell.slopes(readings, corrections)
    jacobian = np.nan_to_num(full[:, :, [cell.index[name] for name in names]] / std[:, :, None], nan=0.0)
    everything = Neighbourhood(
        cell=cell,
        names=names,
        kind=(*own, *added.values()),
        at=np.append(fit.x, np.zeros(len(added))),
        prior_std=np.append(problem.prior_std, np.full(len(added), np.inf)),
        jacobian=jacobian,
        left=np.nan_to_num(-errors / std, nan=0.0),
        std=std,
        joints=readings.joints,
    )
    return _seen(everything, len(problem.names))


def equipped(cell: Cell, terms: tuple[Term, ...]) -> Cell:
    """Returns the cell whose arm has what terms describe, new parts of it zero."""
    arm = cell.arm.with_sag() if "gravity" in terms else cell.arm
    arm = arm.with_harmonics() if "harmonics" in terms else arm
    return cell if arm is cell.arm else replace(cell, arm=arm)


def _own_kind(cell: Cell, freedom: Freedom, terms: tuple[Term, ...], learn: bool) -> str:
    """Returns the kind of a free parameter, "" if what is believed of it is not to be learned: of links alone it is."""
    kind = _kind(freedom.parameter, terms)
    of_link = freedom.parameter.rpartition(".")[0] in cell.arm.joint_names
    if kind or not learn or freedom.prior_std is None or not of_link:
        return kind
    quantity = cell.parameters[cell.index[freedom.parameter]].quantity
    return {"angle": ANGLES, "length": LENGTHS, "number": ""}[quantity]


def _kind(name: str, terms: tuple[Term, ...]) -> str:
    """Returns the kind of a parameter that terms add, "" for others."""
    number = name.rpartition(".")[2]
    if number in HARMONICS and "harmonics" in terms:
        return ONCE if number.endswith("1") else TWICE
    return "gravity" if number.startswith(SAG) and "gravity" in terms else ""


def _seen(everything: Neighbourhood, own: int) -> Neighbourhood:
    """Returns the neighbourhood without additions that hardly change a reading."""
    size = np.sqrt(np.sum(everything.jacobian**2, axis=(0, 1)))
    most = {kind: max(size[p] for p, k in enumerate(everything.kind) if k == kind) for kind in everything.kind}
    keep = [p for p, kind in enumerate(everything.kind) if p < own or size[p] > SEEN * most[kind]]
    return everything._some(keep)
