"""The complete model: every parameter that may be wrong, estimated or not, and the joint posterior of all of them.

Leaving a parameter out of the estimate decides what the search moves, not what is known. The error of the identified
arm is that of the estimated parameters, x, and of the others, r, which stay at nominal. With the readings linearised
at the fit, y = J x + K r + e, least squares answers x^ = C J'(y) with C = (J'J + P^-1)^-1, so that r shifts x^ by
D r with D = C J'K, and the joint posterior of (x, r) is

    [C + D S D', -D S]
    [  -S D',      S ]    with S = (R^-1 + K'K - K'J C J'K)^-1,

R being the prior covariance of r. Where the readings contradict r = 0, the posterior mean of r is m = S K'(y - J x^),
and the outer product of the shift (-D m, m) is added: the identified arm stays where the estimate put it.

Type A is what comes from the readings' noise, Type B what comes from priors and stated standard deviations (JCGM 100,
the GUM, sections 4.2 and 4.3).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from boresight.calibration.noise_size import NoiseSize
from boresight.calibration.robust import Fit
from boresight.calibration.scale_held import scale_held
from boresight.inference import Moments
from boresight.inference.coverage import effective_freedom, interval_factor
from boresight.inference.posterior import posterior_root
from boresight.sensing.linear import model_of, triangle_of

UNIDENTIFIABLE = 1e-8
"""A direction of parameters without priors whose singular value is below this share of the largest is a gauge."""

IN_GAUGE = 0.5
"""A parameter of which a gauge direction holds more than this share stays where it was by convention."""


@dataclass(frozen=True)
class CompleteModel:
    """What is known of every parameter after a fit.

    Attributes:
        names: the estimated parameters, then the others that may be wrong.
        estimated: how many of them were estimated.
        prior_std: (parameters,) prior standard deviations [m, rad or 1], infinite where there is none.
        covariance: (parameters, parameters) of estimate minus truth; gauge directions are left out of it.
        noise_covariance: the part of it that comes from the readings' noise (Type A).
        mean: (parameters,) posterior mean minus the identified values.
        conditional_covariance: (free, free) of the estimated parameters, were all others as stated.
        gauge: (directions, parameters) combinations of parameters without priors that change no reading.
        freedom: degrees of freedom with which the size of the noise is known.
        model_std: standard deviation [m] of what the model leaves unexplained.
    """

    names: tuple[str, ...]
    estimated: int
    prior_std: Float[np.ndarray, "parameters"]
    covariance: Float[np.ndarray, "parameters parameters"]
    noise_covariance: Float[np.ndarray, "parameters parameters"]
    mean: Float[np.ndarray, "parameters"]
    conditional_covariance: Float[np.ndarray, "free free"]
    gauge: Float[np.ndarray, "directions parameters"]
    freedom: float
    model_std: float

    @property
    def free_covariance(self) -> Float[np.ndarray, "free free"]:
        """The covariance of the estimated parameters alone."""
        return self.covariance[: self.estimated, : self.estimated]

    @property
    def half_width_95(self) -> Float[np.ndarray, "parameters"]:
        """Half-width of each parameter's 95 % interval, by Student's t where the noise's size was estimated."""
        variance, noise = np.diag(self.covariance), np.diag(self.noise_covariance)
        return interval_factor(effective_freedom(variance, noise, self.freedom)) * np.sqrt(variance)

    @property
    def prior_of(self) -> dict[str, float]:
        """Prior standard deviation [m, rad or 1] of each parameter that was not estimated."""
        others = slice(self.estimated, None)
        return dict(zip(self.names[others], self.prior_std[others].tolist(), strict=True))

    @property
    def in_gauge(self) -> Bool[np.ndarray, "parameters"]:
        """Which parameters are held by convention: the readings and the priors say nothing of them."""
        if not len(self.gauge):
            return np.zeros(len(self.names), dtype=bool)
        basis = np.linalg.qr(self.gauge.T)[0]
        return np.sum(basis**2, axis=1) > IN_GAUGE

    @property
    def moments(self) -> Moments:
        """What the tool's accuracy follows from; before any reading, parameters without a prior are taken as known."""
        prior = np.diag(np.where(np.isfinite(self.prior_std), self.prior_std, 0.0) ** 2)
        return Moments(
            self.names, self.covariance, self.noise_covariance, prior, self.gauge, self.freedom, self.model_std
        )


def complete_model(fit: Fit, others: Mapping[str, float], noise: NoiseSize) -> CompleteModel:
    """Returns the joint posterior of the estimated parameters and of others that stay at nominal.

    Args:
        fit: the final fit, its row weights and model error as they came out.
        others: prior standard deviation [m, rad or 1] of each parameter that may be wrong and was not estimated.
        noise: the size of the readings' noise.
    """
    problem, x = fit.problem, fit.x
    free, names = len(x), (*problem.names, *others)
    point = np.append(x, np.zeros(len(others)))
    triangle = triangle_of(
        model_of(problem.cell, problem.readings, names),
        point,
        np.sqrt(problem.row_weight)[:, None] / (noise.scale * problem.std),
    )
    prior_std = np.append(problem.prior_std, np.array(list(others.values())))
    gauge = _gauge(triangle.slopes, prior_std, problem.scale)
    slopes = triangle.slopes - (triangle.slopes @ gauge.T) @ gauge if len(gauge) else triangle.slopes
    J, K = slopes[:, :free], slopes[:, free:]
    root = posterior_root(J, prior_std[:free])
    if len(gauge):
        root = root - gauge[:, :free].T @ (gauge[:, :free] @ root)
    C, whole = root @ root.T, posterior_root(slopes, prior_std)[free:]
    S = whole @ whole.T
    D = C @ (J.T @ K)
    by_others = np.vstack([-D, np.eye(len(others))])
    pull = -(K.T @ triangle.residual)
    held = scale_held(problem.cell, problem.readings, names)
    pull *= [name != held for name in others]  # smaller arms leave smaller residuals of contacts, and mean nothing
    mean = by_others @ (S @ pull) if others else np.zeros(free)
    covariance = by_others @ S @ by_others.T + np.outer(mean, mean)
    covariance[:free, :free] += C
    of_noise = np.zeros_like(covariance)
    of_noise[:free, :free] = C @ (J.T @ J) @ C
    return CompleteModel(names, free, prior_std, covariance, of_noise, mean, C, gauge, noise.freedom, problem.model_std)


def _gauge(
    slopes: Float[np.ndarray, "parameters parameters"],
    prior_std: Float[np.ndarray, "parameters"],
    scale: Float[np.ndarray, "free"],
) -> Float[np.ndarray, "directions parameters"]:
    """Returns an orthonormal basis of what parameters without priors can do that no reading shows."""
    flat = np.flatnonzero(np.isinf(prior_std))
    if not len(flat):
        return np.zeros((0, len(prior_std)))
    scaled = slopes[:, flat] * scale[flat]
    _, sizes, directions = np.linalg.svd(scaled)
    unseen = directions[np.count_nonzero(sizes > UNIDENTIFIABLE * max(sizes[0], 1e-300)) :] * scale[flat]
    gauge = np.zeros((len(unseen), len(prior_std)))
    gauge[:, flat] = np.linalg.qr(unseen.T)[0].T if len(unseen) else unseen
    return gauge
