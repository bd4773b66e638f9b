"""All that least squares needs of a Jacobian with many rows and few columns: its triangular factor.

J and the residuals r enter a sum of squares as R and Q'r of the QR factorisation of [J r]; R has J's singular values
and right singular vectors, and R'R = J'J. Rows are taken block by block, the triangle so far on top of the next ones
(Golub & Van Loan 2013, section 6.5; Demmel, Grigori, Hoemmen & Langou 2012), so a million rows need the memory of one
block. Normal equations take blocks as well, and square the condition number.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.kernels.reducing import fold


@dataclass(frozen=True)
class Triangle:
    """Some rows of a linear least-squares problem, in as few as there are parameters.

    Attributes:
        slopes: (parameters, parameters) R.
        residual: (parameters,) the first numbers of Q'r; the others are all that no step can change.
        square: sum of the squared residuals, r'r.
    """

    slopes: Float[np.ndarray, "parameters parameters"]
    residual: Float[np.ndarray, "parameters"]
    square: float

    @classmethod
    def of(
        cls, jacobian: Float[np.ndarray, "residuals parameters"], residual: Float[np.ndarray, "residuals"]
    ) -> Triangle:
        """Returns the triangle of rows that are all there."""
        return reduced([np.ascontiguousarray(np.column_stack([jacobian, residual]).T)], jacobian.shape[1])

    @property
    def gradient(self) -> Float[np.ndarray, "parameters"]:
        """Half the derivative of the sum of squares, J'r."""
        return self.slopes.T @ self.residual

    def scaled(self, scale: Float[np.ndarray, "parameters"]) -> Triangle:
        """Returns the triangle of parameters measured in other units: their numbers times these are the old ones."""
        return Triangle(self.slopes * scale, self.residual, self.square)


def reduced(blocks: Iterable[Float[np.ndarray, "columns rows"]], parameters: int) -> Triangle:
    """Returns the triangle of all rows.

    Args:
        blocks: (parameters + 1, rows) derivatives by each parameter, then the residuals, some rows at a time.
        parameters: how many.
    """
    whole = np.zeros((parameters + 1, parameters + 1))
    for block in blocks:
        fold(whole, block)
    last = whole[:, parameters]
    return Triangle(whole[:parameters, :parameters], last[:parameters], float(last @ last))
