"""Jumps of a sensor's level between blocks of rows: it was moved, knocked or re-zeroed, and nobody said so.

For each block that could be (all rows of a sensor from one on, or a session) a step on one channel is added to the
fit, linearised; what it would take off the residuals says how likely it is there. Steps are taken up one after the
other, the likeliest first, until none is left that chance would not give once in a hundred campaigns.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from boresight.calibration.robust import Fit
from boresight.calibration.thinning import thinned
from boresight.sensing.linear import slopes_of
from boresight.units import in_millimetres

FALSE_ALARMS = 0.002
"""Share of campaigns without a jump in which one may be reported. Residuals are scaled by their own size, clipped and
corrected for likeness, which a t-distribution does not know: at 0.01, 2 of 120 clean campaigns had one."""

SHORTEST = 5
"""Fewer rows than this are outliers, which are found one by one, and not a block."""

MOST = 5
"""Jumps reported; a sensor with more is not worth calibrating with."""

_CLIPPED = 3.0
"""Standard deviations beyond which a residual says no more: outliers are not steps."""

_ITERATIONS = 10

_TRIED = 500
"""Blocks tried for each channel: of 10,000 rows, a jump is found to within 20; many rows are thinned to so many."""

_UNSEEN = 1e-6
"""A step of which less than this share is its own, and no parameter's, is not seen."""


@dataclass(frozen=True, slots=True)
class Jump:
    """A block of rows that a sensor read differently.

    Attributes:
        sensor: its name.
        type: its kind.
        channel: what it reads, as in the columns of an observations file.
        line: the first line of the block.
        session: the session that the block is, or None for all rows of the sensor from `line` on.
        size: how much more is read there than elsewhere [m, or rad of an angle].
        std: standard deviation of that.
        angle: whether it is an angle.
        named: whether rows have sessions.
    """

    sensor: str
    type: str
    channel: str
    line: int
    session: str | None
    size: float
    std: float
    angle: bool
    named: bool

    @property
    def words(self) -> str:
        """What a person should know, as a sentence."""
        if self.session is None:
            where, than = f"From line {self.line} on", "before"
        else:
            where, than = f"In session {self.session!r}", "in the others"
        amount = f"{1e3 * abs(self.size):.3g} mrad" if self.angle else in_millimetres(abs(self.size))
        told = f"{where} {self._read(amount)} than {than} ({abs(self.size) / self.std:.0f} standard deviations)"
        return f"{told}: {self._mend()}"

    def _read(self, amount: str) -> str:
        more = self.size > 0.0
        if self.type == "plane_contact":
            return f"the tip is felt {amount} {'lower' if more else 'higher'} over its plane"
        if self.type == "point_contact":
            return f"the tip is felt {amount} {'more' if more else 'less'} along {self.channel} of its point"
        which = "" if self.sensor == "sensor" else f" of {self.sensor}"
        if self.type in ("laser_ranger", "draw_wire"):
            return f"the {'range' if self.type == 'laser_ranger' else 'length'}s{which} are {amount} {_longer(more)}"
        return f"{self.channel}{which} is {amount} {'more' if more else 'less'}"

    def _mend(self) -> str:
        if self.type not in ("laser_ranger", "draw_wire"):
            return "was something moved? If so, calibrate with the rows of one block, or take the rows again."
        rows = "" if self.named else "give the rows a `session` column and "
        return f"was the sensor moved or re-zeroed? If so, {rows}say `offset_per: session` of it in the campaign."


def _longer(more: bool) -> str:
    return "longer" if more else "shorter"


def find_jumps(fit: Fit) -> tuple[Jump, ...]:
    """Returns the jumps that a fit leaves unexplained, the likeliest first.

    Args:
        fit: the final fit; rows that it left out are looked at too, as a whole block may have been.
    """
    rows = thinned(fit.problem.readings)
    if len(rows) < len(fit.ratio):
        fit = replace(fit, problem=fit.problem.on(rows), ratio=fit.ratio[rows])
    blocks = _blocks(fit)
    if not blocks:
        return ()
    linear, found = _Linear.of(fit), list[_Block]()
    while len(found) < MOST:
        stepped = linear.with_steps(found)
        block, score, freedom = stepped.likeliest(blocks)
        if block in found or score < _critical(len(blocks), freedom):
            break
        found.append(block)
    sizes, stds = linear.with_steps(found).steps
    return tuple(_jump(fit, *each) for each in zip(found, sizes, stds, strict=True))


def _critical(blocks: int, freedom: float) -> float:
    """Returns the score that chance exceeds for one of so many blocks in `FALSE_ALARMS` of all campaigns."""
    from scipy import special

    return float(special.stdtrit(max(freedom, 1.0), 1.0 - 0.5 * FALSE_ALARMS / blocks))


def _jump(fit: Fit, block: _Block, size: float, std: float) -> Jump:
    problem = fit.problem
    sensor, readings = problem.cell.sensors[block.series.sensor], problem.readings
    lever = sensor.levers[block.series.channel]
    return Jump(
        sensor=block.series.sensor,
        type=sensor.type,
        channel=sensor.channels[block.series.channel],
        line=int(readings.line[block.rows[0]]),
        session=block.session,
        size=size / (lever or 1.0),
        std=std / (lever or 1.0),
        angle=lever is not None,
        named=readings.session is not None,
    )


@dataclass(frozen=True, eq=False)
class _Series:
    """All rows of a sensor in the order of the file, and one of its channels."""

    sensor: str
    channel: int
    rows: Int[np.ndarray, "rows"]


@dataclass(frozen=True, eq=False)
class _Block:
    """Rows of a series that may have been read differently: those from one on, or a session."""

    series: _Series
    rows: Int[np.ndarray, "some"]
    session: str | None = None


def _blocks(fit: Fit) -> list[_Block]:
    """Returns every block that a step could be on; of many rows the blocks from every so manieth on."""
    cell, readings = fit.problem.cell, fit.problem.readings
    sensors = np.array([aim.sensor for aim in cell.aims])[readings.target]
    order = np.argsort(readings.line, kind="stable")
    blocks = []
    for name, sensor in cell.sensors.items():
        rows = order[sensors[order] == name]
        if len(rows) < 2 * SHORTEST:
            continue
        starts = np.unique(np.linspace(SHORTEST, len(rows) - SHORTEST, min(len(rows), _TRIED)).astype(int))
        sessions = [] if readings.session is None else list(dict.fromkeys(readings.session[rows].tolist()))
        own = {session: rows[readings.session[rows] == session] for session in sessions if readings.session is not None}
        for channel in range(len(sensor.channels)):
            series = _Series(name, channel, rows)
            blocks += [_Block(series, rows[start:]) for start in starts]
            blocks += [
                _Block(series, part, str(session))
                for session, part in own.items()
                if SHORTEST <= len(part) <= len(rows) - SHORTEST
            ]
    return blocks


@dataclass(frozen=True)
class _Linear:
    """A fit made straight at its optimum, with steps on some blocks beside its parameters.

    Attributes:
        slopes: (rows, channels, parameters) derivative of the values over their standard deviations; steps last.
        prior: precision of each parameter, 0 of a step.
        errors: (rows, channels) measured minus predicted over the standard deviations, 0 where there is none.
        std: (rows, channels) standard deviation of each value [m].
        products: sums of the slopes' products. Sums over rows are NumPy's own loops: those of BLAS differ in the last
            digits with its threads.
        count: how many of the parameters are steps.
        distinct: share of the values that repeat no other's configuration: what a model leaves there, they share.
    """

    slopes: Float[np.ndarray, "rows channels parameters"]
    prior: Float[np.ndarray, "parameters"]
    errors: Float[np.ndarray, "rows channels"]
    std: Float[np.ndarray, "rows channels"]
    products: Float[np.ndarray, "parameters parameters"]
    count: int = 0
    distinct: float = 1.0

    @classmethod
    def of(cls, fit: Fit) -> _Linear:
        """Returns a fit without steps."""
        problem, std = fit.problem, fit.problem.readings.std
        errors = problem.errors(fit.x)
        std = np.where(np.isfinite(errors), std, np.inf)
        slopes = slopes_of(problem.model, fit.x, problem.readings) / std[:, :, None]
        distinct = float(np.mean(1.0 / problem.repeats)) if problem.model_std > 0.0 else 1.0
        products = np.einsum("rcp,rcq->pq", slopes, slopes)
        return cls(slopes, 1.0 / problem.prior_std**2, np.nan_to_num(-errors) / std, std, products, 0, distinct)

    def with_steps(self, blocks: list[_Block]) -> _Linear:
        """Returns the fit with a step on each of some blocks."""
        steps = np.zeros((*self.std.shape, len(blocks)))
        for place, block in enumerate(blocks):
            steps[block.rows, block.series.channel, place] = 1.0 / self.std[block.rows, block.series.channel]
        slopes, prior = np.concatenate([self.slopes, steps], axis=2), np.append(self.prior, np.zeros(len(blocks)))
        crossed = np.einsum("rcp,rck->pk", self.slopes, steps)
        products = np.block([[self.products, crossed], [crossed.T, np.einsum("rck,rcl->kl", steps, steps)]])
        return _Linear(slopes, prior, self.errors, self.std, products, len(blocks), self.distinct)

    @cached_property
    def read(self) -> Bool[np.ndarray, "rows channels"]:
        """Which values there are."""
        return np.isfinite(self.std)

    @cached_property
    def inverse(self) -> Float[np.ndarray, "parameters parameters"]:
        """Covariance of the parameters, were the standard deviations right."""
        precision = self.products + np.diag(self.prior)
        scale = 1.0 / np.sqrt(np.maximum(np.diag(precision), 1e-300))
        return scale[:, None] * np.linalg.pinv(scale[:, None] * precision * scale) * scale

    @cached_property
    def solution(self) -> tuple[Float[np.ndarray, "parameters"], Float[np.ndarray, "rows channels"]]:
        """Where robust least squares leads: the parameters' changes, and the residuals clipped where they are gross."""
        moved, pulled = np.zeros(len(self.prior)), self.errors
        for _ in range(_ITERATIONS):
            rest = self.errors - np.einsum("rcp,p->rc", self.slopes, moved)
            limit = _CLIPPED * _scale(rest[self.read])
            pulled = np.clip(rest, -limit, limit)
            moved = moved + self.inverse @ np.einsum("rcp,rc->p", self.slopes, pulled)
        return moved, pulled

    @cached_property
    def freedom(self) -> float:
        """Values less the parameters that they decide."""
        decided = float(np.sum(self.products * self.inverse))
        return max(self.distinct * float(np.count_nonzero(self.read)) - decided, 1.0)

    @property
    def spread(self) -> float:
        """Size of the residuals over the stated standard deviations."""
        return float(np.sqrt(np.sum(self.solution[1] ** 2) / self.freedom))

    @property
    def steps(self) -> tuple[list[float], list[float]]:
        """The sizes [m] of the steps and their standard deviations."""
        chosen = slice(len(self.prior) - self.count, None)
        stds = self.spread * np.sqrt(np.diag(self.inverse)[chosen])
        return self.solution[0][chosen].tolist(), stds.tolist()

    def likeliest(self, blocks: list[_Block]) -> tuple[_Block, float, float]:
        """Returns the block on which one more step is likeliest, its score, and the score's degrees of freedom.

        The score is the step's size over its standard deviation. Where neighbouring rows are alike even after the step
        is taken off, as where the arm moves in ways that the model does not have and rows were taken along a path,
        each says less and the score is lower.
        """
        pulled = self.solution[1]
        gains = np.array([self._gain(block, pulled) for block in blocks])
        block = blocks[int(np.argmax(gains))]
        after = self.with_steps([block])
        rows, channel = block.series.rows, block.series.channel
        rest = after.solution[1][rows, channel]
        square = float(np.sum(rest**2)) * self.read.sum() / (max(len(rest), 1) * after.freedom) + 1e-300
        alike = float(np.clip(np.sum(rest[1:] * rest[:-1]) / max(float(np.sum(rest**2)), 1e-300), 0.0, 0.99))
        widened = np.sqrt(square * (1.0 + alike) / (1.0 - alike))
        return block, float(gains.max() / widened), after.freedom

    def _gain(self, block: _Block, pulled: Float[np.ndarray, "rows channels"]) -> float:
        """Returns the size of a step over its standard deviation, were the stated ones right."""
        rows, channel = block.rows, block.series.channel
        weight = 1.0 / self.std[rows, channel]
        shared = np.einsum("r,rp->p", weight, self.slopes[rows, channel])
        whole = float(np.einsum("r,r->", weight, weight))
        power = whole - float(np.einsum("p,pq,q->", shared, self.inverse, shared))
        if power <= _UNSEEN * whole:
            return 0.0
        return abs(float(np.einsum("r,r->", weight, pulled[rows, channel]))) / np.sqrt(power)


def _scale(rest: Float[np.ndarray, "values"]) -> float:
    """Returns the standard deviation of what is normal in residuals with gross ones among them."""
    return max(1.4826 * float(np.median(np.abs(rest))), 1e-9)
