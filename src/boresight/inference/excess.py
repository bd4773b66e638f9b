"""When residuals are larger than the sensor's noise: how much the model itself is off."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def model_std(residuals: Float[np.ndarray, "values"], std: Float[np.ndarray, "values"], freedom: float) -> float:
    """Returns the standard deviation that, added to the stated ones in squares, explains the residuals.

    It solves sum r² / (s² + m²) = values - freedom for m (Mandel & Paule 1970), and is 0 where the stated
    noise suffices. A scale on the stated deviations would be wrong for real arms: what bends is the arm, and
    it bends as much under the readings that were taken carefully.

    Args:
        residuals: measured minus predicted.
        std: stated standard deviation of each.
        freedom: number of parameters fitted to them.
    """
    expected = max(len(residuals) - freedom, 1.0)
    squares, variances = residuals**2, std**2

    def surplus(variance: float) -> float:
        return float(np.sum(squares / (variances + variance))) - expected

    if surplus(0.0) <= 3.0 * np.sqrt(2.0 * expected):
        return 0.0
    low, high = 0.0, float(np.sum(squares) / expected)
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if surplus(middle) > 0.0 else (low, middle)
    return float(np.sqrt(0.5 * (low + high)))
