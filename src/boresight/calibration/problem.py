"""Residuals and their exact Jacobian as functions of the free parameters, block by block."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain

import numpy as np
from jaxtyping import Float

from boresight.calibration.campaign import Freedom
from boresight.calibration.configurations import repeats_of
from boresight.calibration.plain_cost import PlainCost
from boresight.calibration.thinning import thinned
from boresight.inference import posterior_covariance, posterior_root
from boresight.search import Box, Triangle, reduced
from boresight.sensing import Cell, Readings
from boresight.sensing.compiled import CompiledCost, compile_program, compile_rows
from boresight.sensing.linear import Model, model_of, slopes_of, triangle_of

MISSED_M = 10.0
"""Residual [m] of a beam that looks away from its plane, and of zero slope: worse than any hit, finite."""

LARGEST_SCALE = 0.1
"""Largest size [m or rad] that a correction is measured in, however wide its bounds: beyond it, one parameter's
scale would drown the others in the rank."""

ROBUST_WITHIN = 3.0
"""Standard deviations within which evolution's robust cost is quadratic; beyond, a residual counts by its size."""

UNBOUNDED_HALF_WIDTH = {"length": 0.05, "angle": 0.05, "number": 0.05}
"""Half-width of evolution's box for parameters that nobody bounded: frames that were just found from the data,
which geometry of the usual size moves by millimetres and milliradians."""


@dataclass(frozen=True)
class Problem:
    """What is fitted, to what.

    Attributes:
        cell: the nominal cell.
        readings: measured values.
        freedoms: the free parameters, each once.
        model_std: standard deviation [m] of what the model itself leaves unexplained.
        row_weights: weight of each row's squared residuals in least squares, 0 where it is left out; None
            weighs all alike.
    """

    cell: Cell
    readings: Readings
    freedoms: tuple[Freedom, ...]
    model_std: float = 0.0
    row_weights: Float[np.ndarray, " rows"] | None = None

    @cached_property
    def std(self) -> Float[np.ndarray, "rows channels"]:
        """Standard deviation of each residual [m]: the sensor's noise and the model's own, in squares.

        The model's own counts once a configuration, however many rows were taken there.

        Infinite where a row's sensor has no such channel, so that it has no say in anything.
        """
        if self.model_std == 0.0:
            return self.readings.std
        return np.hypot(self.readings.std, self.model_std * np.sqrt(self.repeats)[:, None])

    @cached_property
    def repeats(self) -> Float[np.ndarray, " rows"]:
        """How many rows share each row's configuration: what the model leaves unexplained there, they share too."""
        return repeats_of(self.readings.joints).astype(float)

    @cached_property
    def row_weight(self) -> Float[np.ndarray, " rows"]:
        """Weight of each row's squared residuals in least squares."""
        return np.ones(len(self.readings)) if self.row_weights is None else self.row_weights

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The free parameters' names."""
        return tuple(freedom.parameter for freedom in self.freedoms)

    @cached_property
    def columns(self) -> list[int]:
        """The free parameters' places among the cell's."""
        return [self.cell.index[name] for name in self.names]

    @cached_property
    def model(self) -> Model:
        """The readings as a function of the free parameters."""
        return model_of(self.cell, self.readings, self.names)

    @cached_property
    def believed_std(self) -> Float[np.ndarray, "parameters"]:
        """Standard deviations of what was believed before any reading, infinite where nothing was."""
        return np.array([np.inf if f.prior_std is None else f.prior_std for f in self.freedoms])

    @cached_property
    def prior_std(self) -> Float[np.ndarray, "parameters"]:
        """Standard deviations that hold the parameters: learned or believed; infinite where neither."""
        learned = [np.nan if f.learned_std is None else f.learned_std for f in self.freedoms]
        return np.where(np.isnan(learned), self.believed_std, learned)

    @cached_property
    def half_width(self) -> Float[np.ndarray, "parameters"]:
        """Half-widths of the search, infinite where there is no bound."""
        return np.array([np.inf if f.within is None else f.within for f in self.freedoms])

    @cached_property
    def scale(self) -> Float[np.ndarray, "parameters"]:
        """A typical size of each correction, so that metres and radians compare."""
        return np.minimum(np.minimum(self.prior_std, self.half_width), LARGEST_SCALE)

    @cached_property
    def box(self) -> Box:
        """Where evolution searches."""
        return Box(-self._evolved_half_width, self._evolved_half_width)

    @cached_property
    def cost(self) -> CompiledCost | PlainCost:
        """The compiled cost [m²] of all rows: squared residuals, scaled to the usual noise, and priors."""
        return self._compiled(0.0)

    @cached_property
    def robust_cost(self) -> CompiledCost | PlainCost:
        """The same with residuals beyond `ROBUST_WITHIN` standard deviations counted by size, not by square."""
        return self._compiled((ROBUST_WITHIN * self.usual_std) ** 2)

    @property
    def usual_std(self) -> float:
        """The median standard deviation of a residual [m]."""
        return float(np.median(self.std[self.readings.read]))

    def corrections(self, x: Float[np.ndarray, "parameters"]) -> Float[np.ndarray, "all"]:
        """Returns corrections of all the cell's parameters from those of the free ones."""
        full = np.zeros(len(self.cell.parameters))
        full[self.columns] = x
        return full

    def errors(self, x: Float[np.ndarray, "parameters"]) -> Float[np.ndarray, "rows channels"]:
        """Returns predicted minus measured values [m]; NaN where a beam misses."""
        return self.model.errors(x)

    def residual(self, x: Float[np.ndarray, "parameters"]) -> Float[np.ndarray, "residuals"]:
        """Returns errors over their standard deviations, then corrections over theirs (MAP)."""
        errors = np.nan_to_num(self.errors(x), nan=MISSED_M)
        return np.concatenate([(errors * self._root_weight).ravel(), x / self.prior_std])

    def jacobian(self, x: Float[np.ndarray, "parameters"]) -> Float[np.ndarray, "residuals parameters"]:
        """Returns the exact derivative of `residual`, whole: for few rows, and for tests."""
        return np.vstack([self.sensitivity(x), np.diag(1.0 / self.prior_std)])

    def sensitivity(self, x: Float[np.ndarray, "parameters"]) -> Float[np.ndarray, "values parameters"]:
        """Returns the derivative of the weighed readings over their standard deviations, priors left out, whole."""
        slopes = slopes_of(self.model, x, self.readings)
        return (slopes * self._root_weight[:, :, None]).reshape(-1, len(self.columns))

    def square(self, x: Float[np.ndarray, "parameters"]) -> float:
        """Returns the sum of the squares of `residual`."""
        errors = np.nan_to_num(self.errors(x), copy=False, nan=MISSED_M)
        errors *= self._root_weight
        return float(np.vdot(errors, errors) + np.sum((x / self.prior_std) ** 2))

    def triangle(self, x: Float[np.ndarray, "parameters"]) -> Triangle:
        """Returns what least squares needs of `residual` and `jacobian`."""
        prior = np.column_stack([np.diag(1.0 / self.prior_std), x / self.prior_std]).T
        rows = (block.columns for block in self.model.blocks(x, self._root_weight, MISSED_M))
        return reduced(chain(rows, [np.ascontiguousarray(prior)]), len(x))

    def seen(self, x: Float[np.ndarray, "parameters"]) -> Float[np.ndarray, "parameters parameters"]:
        """Returns the triangular factor R of `sensitivity`: R'R is its own square, and its singular values R's."""
        at, slopes = self.__dict__.get("_last_seen", (None, None))
        if at is None or not np.array_equal(at, x):
            slopes = triangle_of(self.model, x, self._root_weight).slopes
            self.__dict__["_last_seen"] = x.copy(), slopes  # a fit's end is asked for several times
        return slopes

    def leverage(self, x: Float[np.ndarray, "parameters"]) -> Float[np.ndarray, "rows channels"]:
        """Returns the variance of each predicted value after the fit over the variance of its error."""
        found, root = np.empty(self.std.shape), posterior_root(self.seen(x), self.prior_std).T
        for block in self.model.blocks(x, 1.0 / self.std, MISSED_M):
            found[block.rows] = np.sum((root @ block.columns[:-1]) ** 2, axis=0).reshape(-1, self.cell.channels)
        return found

    def covariance(self, x: Float[np.ndarray, "parameters"]) -> Float[np.ndarray, "parameters parameters"]:
        """Returns the posterior covariance of the free corrections."""
        return posterior_covariance(self.seen(x), self.prior_std)

    def fitted(self, x: Float[np.ndarray, "parameters"]) -> Cell:
        """Returns the cell with the corrections applied."""
        return self.cell.corrected(dict(zip(self.names, (float(value) for value in x), strict=True)))

    def weighed(self, row_weight: Float[np.ndarray, " rows"], model_std: float) -> Problem:
        """Returns the same problem with other rows' weights and another standard deviation [m] of the model's own."""
        problem = replace(self, row_weights=row_weight, model_std=model_std)
        problem.__dict__["model"] = self.model  # weights do not change it, and a robust fit weighs every round
        if "repeats" in self.__dict__:
            problem.__dict__["repeats"] = self.repeats
        return problem

    def on(self, rows: Float[np.ndarray, "some"]) -> Problem:
        """Returns the same problem on some of the rows."""
        return replace(self, readings=self.readings.chosen(rows), row_weights=self.row_weight[rows])

    def thinned(self) -> Problem:
        """Returns the same problem on a few of its rows where there are many, else itself; see `thinning`."""
        rows = thinned(self.readings)
        return self if len(rows) == len(self.readings) else self.on(rows)

    def _compiled(self, loss: float) -> CompiledCost | PlainCost:
        weight, prior = self.usual_std**2 / self.std**2, self.usual_std**2 / self.prior_std**2
        if not all(sensor.readouts for sensor in self.cell.sensors.values()):
            return PlainCost(self, weight, prior, loss)
        program = compile_program(self.cell, self.names, prior, loss)
        return CompiledCost(program, compile_rows(self.cell, self.readings, weight))

    @cached_property
    def _root_weight(self) -> Float[np.ndarray, "rows channels"]:
        return np.sqrt(self.row_weight)[:, None] / self.std

    @cached_property
    def _evolved_half_width(self) -> Float[np.ndarray, "parameters"]:
        usual = [UNBOUNDED_HALF_WIDTH[self.cell.parameters[column].quantity] for column in self.columns]
        return np.where(np.isfinite(self.half_width), self.half_width, usual)


def rms(errors: Float[np.ndarray, "*values"]) -> float:
    """Returns the root of the mean square of the finite errors; NaN if there are none."""
    finite = errors[np.isfinite(errors)]
    return float(np.sqrt(np.mean(finite**2))) if finite.size else float("nan")
