"""One seed: every variant identified, and how far each ended from the truth."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from boresight.calibration.problem import Problem
from boresight.reproduction import setting
from boresight.reproduction.ambiguity import without_azimuth
from boresight.reproduction.experiment import Experiment, experiment
from boresight.reproduction.identifiable import Ranks, ranks
from boresight.reproduction.pose_errors import PoseErrors, rms
from boresight.reproduction.rivals import Found, from_nominal, modern
from boresight.reproduction.variants import ASSUMPTIONS, CHOSEN, LEAST_SQUARES, MODERN, NOMINAL, Variant
from boresight.search import evolve

Errors = Float[np.ndarray, "rows"]


@dataclass(frozen=True)
class Run:
    """One identification.

    Attributes:
        names: the free parameters.
        x: (parameters,) their identified corrections [m, rad, 1].
        real: (parameters,) the preset errors.
        cost_mm2: H at the end (eq. 22).
        optimum_mm2: H of the same data at the optimum, which least squares finds.
        history_mm2: lowest H of every generation, the first population's first; empty without evolution.
        evaluations: how often H was evaluated.
        seconds: wall time.
        range_mm: (rows,) measured minus predicted ranges.
        real_range_mm: (rows,) ranges without noise minus predicted ones.
        calibration: pose errors where readings were taken.
        validation: pose errors at the validation configurations.
        validation_turned: the same with the turn about z0 removed (`ambiguity`).
    """

    names: tuple[str, ...]
    x: Float[np.ndarray, "parameters"]
    real: Float[np.ndarray, "parameters"]
    cost_mm2: float
    optimum_mm2: float
    history_mm2: Float[np.ndarray, "generations"]
    evaluations: int
    seconds: float
    range_mm: Errors
    real_range_mm: Errors
    calibration: PoseErrors
    validation: PoseErrors
    validation_turned: PoseErrors

    @cached_property
    def from_optimum(self) -> float:
        """RMS range error over that of the optimum."""
        return float(np.sqrt(self.cost_mm2 / self.optimum_mm2))

    @property
    def range_rms_mm(self) -> float:
        """Root mean square of measured minus predicted ranges."""
        return rms(self.range_mm)

    @property
    def range_max_mm(self) -> float:
        """The largest range error."""
        return float(np.max(np.abs(self.range_mm)))


@dataclass(frozen=True)
class Trial:
    """Everything that was found for a seed.

    Attributes:
        seed: which.
        runs: by variant.
        ranks: what its configurations could identify.
    """

    seed: int
    runs: dict[Variant, Run]
    ranks: Ranks


def run_trial(task: tuple[int, tuple[Variant, ...]]) -> Trial:
    """Returns what all variants find for a seed; it depends on nothing else, times aside."""
    seed, variants = task
    campaigns = {name: experiment(seed, ASSUMPTIONS[name]) for name in dict.fromkeys(v.under for v in variants)}
    problems = {(v.under, v.rows): campaigns[v.under].on(v.rows) for v in variants}
    optima = {key: from_nominal(problem) for key, problem in problems.items()}
    runs = {}
    for variant in variants:
        key = (variant.under, variant.rows)
        problem, optimum = problems[key], optima[key]
        if variant.method == LEAST_SQUARES:
            found, history = Found(optimum.best, optimum.evaluations, optimum.seconds), np.empty(0)
        else:
            found, history = _search(problem, variant.method, seed)
        runs[variant] = _run(campaigns[variant.under], problem, found, history, optimum.best)
    return Trial(seed, runs, ranks(campaigns.get(CHOSEN) or experiment(seed)))


def _search(problem: Problem, method: str, seed: int) -> tuple[Found, np.ndarray]:
    """Returns where a search ended, and its lowest cost [mm²] by generation where it is ours."""
    if method == NOMINAL:
        return Found(np.zeros(len(problem.names)), 0, 0.0), np.empty(0)
    if method in MODERN:
        return modern(problem, method, seed), np.empty(0)
    settings = setting.evolution(method)
    problem.cost.load(settings, problem.box)
    evolved = evolve(problem.cost, problem.box, settings, setting.STOPS, seed=seed)
    return Found(evolved.best, evolved.evaluations, evolved.seconds), 1e6 * evolved.history[:, 0]


def _run(campaign: Experiment, problem: Problem, found: Found, history: np.ndarray, optimum: np.ndarray) -> Run:
    """Returns a run judged against the truth."""
    truth, identified = campaign.truth, problem.fitted(found.x)
    joints, target = problem.readings.joints, problem.readings.target
    values, nominal = truth.values, problem.cell.values
    there, here = truth.poses(campaign.validation), identified.poses(campaign.validation)
    errors = problem.errors(found.x)[:, 0]
    cost, lowest = problem.cost(np.stack([found.x, optimum]))
    return Run(
        names=problem.names,
        x=found.x,
        real=np.array([values[name] - nominal[name] for name in problem.names]),
        cost_mm2=1e6 * float(cost),
        optimum_mm2=1e6 * float(lowest),
        history_mm2=history,
        evaluations=found.evaluations,
        seconds=found.seconds,
        range_mm=-1e3 * errors,
        real_range_mm=1e3 * (truth.predict(joints, target)[:, 0] - problem.readings.values[:, 0] - errors),
        calibration=PoseErrors.between(identified.poses(joints), truth.poses(joints)),
        validation=PoseErrors.between(here, there),
        validation_turned=PoseErrors.between(without_azimuth(here, there), there),
    )
