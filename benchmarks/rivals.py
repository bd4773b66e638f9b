"""Case 1 as others' differential evolution is given it: costs for SciPy and pygmo, held to our own before timing.

Both carry the plane from link to link as our kernel does: the comparison is of search and code, not of formulas.
"""

from __future__ import annotations

from collections.abc import Callable

import numba
import numpy as np

from boresight.calibration.problem import Problem

NUMBERS = ("theta", "d", "a", "alpha", "beta")


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


def numpy_cost(problem: Problem) -> Callable[[np.ndarray], np.ndarray]:
    """Returns the cost [m²] of (parameters, members), as SciPy's `vectorized=True` calls it, in whole-array NumPy."""
    nominal, column, plane, plane_column = link_table(problem)
    cosine, sine = np.cos(problem.readings.joints), np.sin(problem.readings.joints)
    measured = problem.readings.values[:, 0]

    def cost(members: np.ndarray) -> np.ndarray:
        padded = np.vstack([members, np.zeros(members.shape[1])])
        theta, d, a, alpha, beta = np.moveaxis(nominal[:, :, None] + padded[column], 1, 0)[:, :, :, None]
        nx, ny, nz, f = (plane[:, None] + padded[plane_column])[:, :, None]
        ny = np.sqrt(np.maximum(1.0 - nx**2 - nz**2, 0.0))
        st, ct, sa, ca, sb, cb = (g(x) for x in (theta, alpha, beta) for g in (np.sin, np.cos))
        for j in range(len(nominal)):
            s, c = sine[:, j] * ct[j] + cosine[:, j] * st[j], cosine[:, j] * ct[j] - sine[:, j] * st[j]
            nx, ny = c * nx + s * ny, c * ny - s * nx
            f = f + nz * d[j] + nx * a[j]
            ny, nz = ca[j] * ny + sa[j] * nz, ca[j] * nz - sa[j] * ny
            nx, nz = cb[j] * nx - sb[j] * nz, sb[j] * nx + cb[j] * nz
        return np.sum((-f / nz - measured) ** 2, axis=1)

    return cost


def scalar_cost(problem: Problem) -> Callable[[np.ndarray], float]:
    """Returns the cost [m²] of one member, compiled with the same flags as ours, vectorised over the readings."""
    nominal, column, plane, plane_column = link_table(problem)
    cosine, sine = (np.ascontiguousarray(g(problem.readings.joints).T) for g in (np.cos, np.sin))
    measured = problem.readings.values[:, 0].copy()
    state = np.empty((4, len(measured)))

    @numba.njit(fastmath=True, error_model="numpy")
    def compiled(x, nominal, column, plane, plane_column, cosine, sine, measured, state):
        value = np.empty(4)
        for i in range(4):
            value[i] = plane[i] + (x[plane_column[i]] if plane_column[i] >= 0 else 0.0)
        value[1] = np.sqrt(max(1.0 - value[0] ** 2 - value[2] ** 2, 0.0))
        nx, ny, nz, f = state[0], state[1], state[2], state[3]
        nx[:], ny[:], nz[:], f[:] = value[0], value[1], value[2], value[3]
        link = np.empty(5)
        for j in range(nominal.shape[0]):
            for k in range(5):
                link[k] = nominal[j, k] + (x[column[j, k]] if column[j, k] >= 0 else 0.0)
            st, ct, d, a = np.sin(link[0]), np.cos(link[0]), link[1], link[2]
            sa, ca, sb, cb = np.sin(link[3]), np.cos(link[3]), np.sin(link[4]), np.cos(link[4])
            cq, sq = cosine[j], sine[j]
            for i in range(measured.shape[0]):
                s, c = sq[i] * ct + cq[i] * st, cq[i] * ct - sq[i] * st
                u, v, w = c * nx[i] + s * ny[i], c * ny[i] - s * nx[i], nz[i]
                f[i] += w * d + u * a
                ny[i], t = ca * v + sa * w, ca * w - sa * v
                nx[i], nz[i] = cb * u - sb * t, sb * u + cb * t
        total = 0.0
        for i in range(measured.shape[0]):
            residual = -f[i] / nz[i] - measured[i]
            total += residual * residual
        return total

    arguments = (nominal, column, plane, plane_column, cosine, sine, measured, state)
    return lambda x: compiled(x, *arguments)


class PygmoProblem:
    """The problem as pygmo asks for it."""

    def __init__(self, cost: Callable[[np.ndarray], float], problem: Problem) -> None:
        self.cost, self.box = cost, problem.box

    def fitness(self, x: np.ndarray) -> tuple[float]:
        """Returns the cost of one member."""
        return (self.cost(x),)

    def get_bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Returns the box."""
        return self.box.lower, self.box.upper

    def __deepcopy__(self, memory: object) -> PygmoProblem:
        """Returns itself: nothing in it changes, and compiled functions are not copied."""
        return self
