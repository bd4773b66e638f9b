"""What the data can and cannot know: rank, and the directions that change no reading (design, section 2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

UNSEEN = 1e-8
"""A singular value below this fraction of the largest is zero: the Jacobian is exact, so what the data cannot
see comes out below 1e-14 here, and what they barely see above 1e-5."""


@dataclass(frozen=True)
class Identifiability:
    """The rank of a scaled Jacobian and what lies in its null space.

    Attributes:
        names: the free parameters.
        rank: how many directions the readings see.
        singular_values: (parameters,) of the scaled Jacobian, largest first.
        unseen: (directions, parameters) combinations of scaled parameters that change no reading, each as
            short a list of parameters as possible, its largest entry 1.
    """

    names: tuple[str, ...]
    rank: int
    singular_values: Float[np.ndarray, "parameters"]
    unseen: Float[np.ndarray, "directions parameters"]

    @property
    def condition(self) -> float:
        """Largest over smallest singular value among those seen."""
        return float(self.singular_values[0] / self.singular_values[self.rank - 1]) if self.rank else np.inf


def identify_directions(
    names: tuple[str, ...],
    jacobian: Float[np.ndarray, "residuals parameters"],
    scale: Float[np.ndarray, "parameters"],
) -> Identifiability:
    """Returns what a Jacobian sees of its parameters.

    Args:
        names: of the parameters.
        jacobian: derivative of the readings, each divided by its standard deviation.
        scale: a typical size of each parameter, so that metres and radians compare.
    """
    from scipy import linalg

    scaled = jacobian * scale
    if scaled.shape[1] == 0:
        return Identifiability(names, 0, np.empty(0), np.empty((0, 0)))
    triangle = linalg.qr(scaled, mode="r")[0][: scaled.shape[1]]
    _, found, directions = np.linalg.svd(triangle, full_matrices=True)
    singular = np.zeros(scaled.shape[1])
    singular[: len(found)] = found
    rank = int(np.count_nonzero(singular > UNSEEN * max(singular[0], 1e-300)))
    return Identifiability(names, rank, singular, shortest(directions[rank:]))


def shortest(basis: Float[np.ndarray, "directions parameters"]) -> Float[np.ndarray, "directions parameters"]:
    """Returns a basis of the same space whose vectors touch few parameters: its reduced row echelon form.

    Pivots are chosen by size, so that a parameter that no reading sees stands alone, and each other
    direction is one parameter and those it is confused with.
    """
    rows = basis.copy()
    taken: list[int] = []
    for row in range(len(rows)):
        open_columns = [column for column in range(rows.shape[1]) if column not in taken]
        pivot = max(open_columns, key=lambda column: abs(rows[row, column]))
        taken.append(pivot)
        rows[row] /= rows[row, pivot]
        for other in range(len(rows)):
            if other != row:
                rows[other] -= rows[other, pivot] * rows[row]
    rows[np.abs(rows) < 1e-6] = 0.0
    largest = np.abs(rows).max(axis=1, keepdims=True) if len(rows) else 1.0
    return rows / largest


def select_visible(
    jacobian: Float[np.ndarray, "residuals parameters"], order: list[int], tolerance: float = 1e-6
) -> list[int]:
    """Returns the columns, taken in order of preference, that each show something the earlier ones do not.

    Args:
        jacobian: scaled as in `identify_directions`.
        order: columns in order of preference.
        tolerance: how much of a column, relative to the largest, must be new.
    """
    basis = np.empty((len(jacobian), 0))
    chosen = []
    largest = float(np.max(np.linalg.norm(jacobian, axis=0), initial=0.0))
    for column in order:
        rest = jacobian[:, column].copy()
        for _ in range(2):
            rest -= basis @ (basis.T @ rest)
        size = float(np.linalg.norm(rest))
        if size > tolerance * largest and basis.shape[1] < len(jacobian):
            chosen.append(column)
            basis = np.column_stack([basis, rest / size])
    return chosen
