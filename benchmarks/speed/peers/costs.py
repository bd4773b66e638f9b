"""Costs that peers are given: what a careful user would write for each, and ours.

All carry the plane from link to link, as our kernel does, so that search and code are compared and not formulas; all
are held to our own before anything is timed (`hold_to_ours`).

- *NumPy*, whole arrays (configurations, members), members side by side in memory, in blocks of configurations that
  stay in the second-level cache, links that cannot tilt left out. The other way round (members, configurations) and
  with every link turned by beta, 150 members and 35 readings took 0.74 ms instead of 0.51.
- *Compiled*, one member a call, vectorised over the readings, in blocks, compiled with our flags; in a
  compiled loop over members where a peer hands over many.
- *Ours*, `Problem.cost`: a population a call, or one member where a peer takes no more. A tile of 40 lanes is then
  filled with one member, which is what such a caller pays for it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba
import numpy as np

from boresight.calibration.problem import Problem

NUMBERS = ("theta", "d", "a", "alpha", "beta")

BLOCK = 1 << 14
"""Numbers of a whole-array temporary: 128 kB. With 1,000 readings, 64 to 128 kB took 89 ns a range, 256 kB 103, 1 MB
130."""

ROWS = 500
"""Readings that a compiled cost carries through the links together, its state in the first-level cache: 100,000 in one
piece took 12 ns a range, in pieces of 250 to 1,000 4.3 to 4.8."""

BatchCost = Callable[[np.ndarray], np.ndarray]
"""Of (members, parameters)."""

ScalarCost = Callable[[np.ndarray], float]


def link_table(problem: Problem) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Returns nominal link numbers (joints, 5) and the plane (4), each with the member's column or -1."""
    cell, place = problem.cell, {name: column for column, name in enumerate(problem.names)}
    (name, plane), *_ = cell.targets.items()
    links = [f"{joint}.{number}" for joint in cell.arm.joint_names for number in NUMBERS]
    planes = [f"{name}.normal_x", f"{name}.normal_y", f"{name}.normal_z", f"{name}.offset"]
    shape = (-1, len(NUMBERS))
    return (
        np.array([cell.values.get(n, 0.0) for n in links]).reshape(shape),
        np.array([place.get(n, -1) for n in links]).reshape(shape),
        np.array([*plane.normal, plane.offset]),
        np.array([place.get(n, -1) for n in planes]),
    )


def numpy_cost(problem: Problem) -> BatchCost:
    """Returns the cost [m²] of (parameters, members), as SciPy's `vectorized=True` calls it."""
    nominal, column, plane, plane_column = link_table(problem)
    cosine, sine = (g(problem.readings.joints).T[:, :, None].copy() for g in (np.cos, np.sin))
    measured = problem.readings.values
    tilts = (nominal[:, 4] != 0.0) | (column[:, 4] >= 0)

    def of_block(rows: slice, start: tuple, links: tuple) -> np.ndarray:
        nx, ny, nz, f = start
        st, ct, d, a, sa, ca, sb, cb = links
        for j in range(len(nominal)):
            cq, sq = cosine[j, rows], sine[j, rows]
            s, c = sq * ct[j] + cq * st[j], cq * ct[j] - sq * st[j]
            nx, ny = c * nx + s * ny, c * ny - s * nx
            f = f + nz * d[j] + nx * a[j]
            ny, nz = ca[j] * ny + sa[j] * nz, ca[j] * nz - sa[j] * ny
            if tilts[j]:
                nx, nz = cb[j] * nx - sb[j] * nz, sb[j] * nx + cb[j] * nz
        residual = f / nz + measured[rows]
        return np.einsum("rm,rm->m", residual, residual)

    def cost(members: np.ndarray) -> np.ndarray:
        padded = np.vstack([members, np.zeros(members.shape[1])])
        theta, d, a, alpha, beta = np.moveaxis(nominal[:, :, None] + padded[column], 1, 0)
        nx, ny, nz, f = plane[:, None] + padded[plane_column]
        ny = np.sqrt(np.maximum(1.0 - nx**2 - nz**2, 0.0))
        links = (*(g(theta) for g in (np.sin, np.cos)), d, a, *(g(x) for x in (alpha, beta) for g in (np.sin, np.cos)))
        step = max(1, BLOCK // members.shape[1])
        blocks = range(0, len(measured), step)
        return sum(of_block(slice(first, first + step), (nx, ny, nz, f), links) for first in blocks)

    return cost


@numba.njit(fastmath=True, error_model="numpy")
def _moved(x, value, place):
    return value + (x[place] if place >= 0 else 0.0)


@numba.njit(fastmath=True, error_model="numpy")
def _compiled_cost(x, nominal, column, plane, plane_column, cosine, sine, measured, state, links):
    x_0, z_0 = _moved(x, plane[0], plane_column[0]), _moved(x, plane[2], plane_column[2])
    y_0, f_0 = np.sqrt(max(1.0 - x_0 * x_0 - z_0 * z_0, 0.0)), _moved(x, plane[3], plane_column[3])
    for j in range(nominal.shape[0]):
        theta, alpha = _moved(x, nominal[j, 0], column[j, 0]), _moved(x, nominal[j, 3], column[j, 3])
        beta = _moved(x, nominal[j, 4], column[j, 4])
        links[j, 0], links[j, 1] = np.sin(theta), np.cos(theta)
        links[j, 2], links[j, 3] = np.sin(alpha), np.cos(alpha)
        links[j, 4], links[j, 5] = np.sin(beta), np.cos(beta)
        links[j, 6], links[j, 7] = _moved(x, nominal[j, 1], column[j, 1]), _moved(x, nominal[j, 2], column[j, 2])
    nx, ny, nz, f = state[0], state[1], state[2], state[3]
    total = 0.0
    for first in range(0, measured.shape[0], state.shape[1]):
        rows = min(state.shape[1], measured.shape[0] - first)
        nx[:], ny[:], nz[:], f[:] = x_0, y_0, z_0, f_0
        for j in range(nominal.shape[0]):
            st, ct, sa, ca = links[j, 0], links[j, 1], links[j, 2], links[j, 3]
            sb, cb, d, a = links[j, 4], links[j, 5], links[j, 6], links[j, 7]
            cq, sq = cosine[j, first:], sine[j, first:]
            for i in range(rows):
                s, c = sq[i] * ct + cq[i] * st, cq[i] * ct - sq[i] * st
                u, v, w = c * nx[i] + s * ny[i], c * ny[i] - s * nx[i], nz[i]
                f[i] += w * d + u * a
                ny[i], t = ca * v + sa * w, ca * w - sa * v
                nx[i], nz[i] = cb * u - sb * t, sb * u + cb * t
        for i in range(rows):
            residual = -f[i] / nz[i] - measured[first + i]
            total += residual * residual
    return total


@numba.njit
def _compiled_costs(members, costs, nominal, column, plane, plane_column, cosine, sine, measured, state, links):
    for i in range(members.shape[0]):
        costs[i] = _compiled_cost(
            members[i], nominal, column, plane, plane_column, cosine, sine, measured, state, links
        )


def _arguments(problem: Problem) -> tuple[np.ndarray, ...]:
    cosine, sine = (np.ascontiguousarray(g(problem.readings.joints).T) for g in (np.cos, np.sin))
    measured = problem.readings.values[:, 0].copy()
    nominal, *rest = link_table(problem)
    state, links = np.empty((4, min(len(measured), ROWS))), np.empty((len(nominal), 8))
    return nominal, *rest, cosine, sine, measured, state, links


def compiled_cost(problem: Problem) -> ScalarCost:
    """Returns the cost [m²] of one member."""
    arguments = _arguments(problem)
    return lambda x: _compiled_cost(x, *arguments)


def compiled_costs(problem: Problem) -> BatchCost:
    """Returns the cost [m²] of (members, parameters)."""
    arguments = _arguments(problem)

    def costs(members: np.ndarray) -> np.ndarray:
        found = np.empty(len(members))
        _compiled_costs(members, found, *arguments)
        return found

    return costs


def our_scalar_cost(problem: Problem) -> ScalarCost:
    """Returns our cost [m²] of one member, a call each."""
    cost: Any = problem.cost
    return lambda x: float(cost(x[None])[0])


def hold_to_ours(problem: Problem, members: int = 150) -> None:
    """Checks that all costs are one function wherever every beam hits.

    Raises:
        AssertionError: one of them is another.
    """
    box = problem.box
    drawn = np.random.default_rng(0).uniform(box.lower, box.upper, (members, len(box)))
    expected = problem.cost(drawn)
    hit = expected < 1e3
    assert hit.any(), "some member hits with every beam"
    for name, costs in {
        "NumPy": numpy_cost(problem)(drawn.T.copy()),
        "compiled": np.array([compiled_cost(problem)(member) for member in drawn]),
        "compiled, all members": compiled_costs(problem)(drawn),
        "ours, one member": np.array([our_scalar_cost(problem)(member) for member in drawn]),
    }.items():
        np.testing.assert_allclose(costs[hit], expected[hit], rtol=1e-9, err_msg=name)
