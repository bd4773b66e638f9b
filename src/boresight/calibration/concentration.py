"""The rows that agree with each other, where gross errors are many for so few readings.

Falling weights need a start near the truth. With 35 readings for 25 parameters three gross errors bend a fit so far
that good rows look worst. Least trimmed squares asks instead for the h rows that fit best together: from many small
random sets of rows, the model fitted to them chooses the h rows it fits best, these fit it anew, and so on
(concentration steps, Rousseeuw & Van Driessen 2006). Linear algebra alone is needed: within the priors the model is
straight to millimetres, and gross errors are larger.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from boresight.calibration.problem import Problem

CURVATURE_M = 0.002
"""How far [m] the model may be from straight within usual priors."""

ROWS = 300
"""Rows that are looked at: where there are more, falling weights have enough to go by."""

STARTS, STEPS, BEST = 3000, 8, 8
"""Random sets, concentration steps for each, and how many of the best sets are returned."""

_WORK = 4e9


def concentrated(
    problem: Problem, start: Float[np.ndarray, "parameters"]
) -> list[tuple[Bool[np.ndarray, "rows"], Float[np.ndarray, "parameters"]]]:
    """Returns sets of rows that agree with each other, the best first, and the corrections that fit each.

    Args:
        problem: what is to be fitted; its row weights are ignored.
        start: where the model is taken to be straight.
    """
    loose = problem.weighed(np.ones(len(problem.readings)), CURVATURE_M)
    random = np.random.Generator(np.random.Philox(0))
    rows, free = len(problem.readings), len(start)
    looked_at = np.sort(random.permutation(rows)[:ROWS])
    count, channels = len(looked_at), problem.readings.values.shape[1]
    slopes = (loose.sensitivity(start) * problem.scale).reshape(rows, channels, free)[looked_at]
    errors = loose.residual(start)[: rows * channels].reshape(rows, channels)[looked_at]
    gram = np.einsum("rcp,rcq->rpq", slopes, slopes).reshape(count, -1)
    pull = np.einsum("rcp,rc->rp", slopes, errors)
    prior = start / problem.scale
    wanted = (count + min(free // channels, count - 1) + 1) // 2
    starts = int(np.clip(_WORK / (STEPS * count * free**2 * channels), 50, STARTS))

    def fitted(kept: Float[np.ndarray, "sets rows"]) -> tuple[np.ndarray, np.ndarray]:
        """Returns each set's scaled move and what it makes of every row's squared error."""
        normal = (kept @ gram).reshape(len(kept), free, free) + np.eye(free)
        move = -np.linalg.solve(normal, (kept @ pull + prior)[:, :, None])[:, :, 0]
        return move, np.sum((errors + np.einsum("rcp,tp->trc", slopes, move)) ** 2, axis=2)

    fewest = max(2, free // (2 * channels))
    sizes = random.integers(fewest, max(min(wanted, 2 * fewest), fewest) + 1, starts)
    order = np.argsort(random.random((starts, count)), axis=1)
    kept = (np.argsort(order, axis=1) < sizes[:, None]).astype(float)
    for _ in range(STEPS):
        squares = fitted(kept)[1]
        kept = (np.argsort(np.argsort(squares, axis=1), axis=1) < wanted).astype(float)
    kept = np.unique(kept, axis=0)
    move, squares = fitted(kept)
    costs = np.sum(kept * squares, axis=1) + np.sum((prior + move) ** 2, axis=1)
    found = []
    for place in np.argsort(costs, kind="stable")[:BEST]:
        chosen = np.zeros(rows, dtype=bool)
        chosen[looked_at[kept[place] > 0.0]] = True
        found.append((chosen, start + move[place] * problem.scale))
    return found
