"""How certain the identified parameters are (design, section 2)."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

FLAT_PRIOR = 1e3
"""Where nothing is believed beforehand, a standard deviation of this [m or rad] stands in, so that a direction
the data do not see has a large variance rather than none."""

SHRUNK = 0.1
"""A parameter's value comes from the data where they leave less than this share of its prior variance."""


def posterior_covariance(
    jacobian: Float[np.ndarray, "residuals parameters"], prior_std: Float[np.ndarray, "parameters"]
) -> Float[np.ndarray, "parameters parameters"]:
    """Returns the covariance of the maximum a posteriori estimate, (J'J + P^-1)^-1.

    Args:
        jacobian: derivative of the readings, each divided by its standard deviation.
        prior_std: prior standard deviations, infinite where nothing is believed.
    """
    root = posterior_root(jacobian, prior_std)
    return root @ root.T


def posterior_root(
    jacobian: Float[np.ndarray, "residuals parameters"], prior_std: Float[np.ndarray, "parameters"]
) -> Float[np.ndarray, "parameters directions"]:
    """Returns H with H H' the covariance: variances made with it, |H' s|^2, are never negative, whatever is unseen.

    Args:
        jacobian: derivative of the readings, each divided by its standard deviation.
        prior_std: prior standard deviations, infinite where nothing is believed.
    """
    scale = np.minimum(prior_std, FLAT_PRIOR)
    # Of the Jacobian itself: in its square, directions seen ten million times better than others would blur them.
    _, sizes, directions = np.linalg.svd(np.vstack([jacobian * scale, np.eye(len(scale))]), full_matrices=False)
    return scale[:, None] * directions.T / np.maximum(sizes, 1.0)


def sources(std: Float[np.ndarray, "parameters"], prior_std: Float[np.ndarray, "parameters"]) -> tuple[str, ...]:
    """Returns for each parameter whether its value comes from the `data` or from the `prior`."""
    prior = np.minimum(prior_std, FLAT_PRIOR)
    return tuple("data" if shrunk else "prior" for shrunk in std**2 < SHRUNK * prior**2)
