"""What is wrong about a sensor, or what is stated of its noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmarks.trust.faults.fault import Fault, Rows, late, normal


def bias(amount: float) -> Fault:
    """Returns a ranger that reads too long [m]."""
    return Fault(("sensor.bias",), r"sensor\.bias|\bbias\b", sensor=lambda values, time: values + amount)


def scale(amount: float) -> Fault:
    """Returns a sensor that reads 1 + amount times what is there."""
    return Fault(("sensor.scale",), r"sensor\.scale|\bscale\b", sensor=lambda values, time: (1.0 + amount) * values)


def step(amount: float) -> Fault:
    """Returns a ranger whose zero moves half way [m]."""
    return Fault(
        ("step*", "*jump*"), r"\bstep|jump|than before", sensor=lambda values, time: values + amount * late(time)
    )


def zero_drift(amount: float) -> Fault:
    """Returns a ranger whose zero drifts steadily [m]."""
    return Fault(("drift*",), r"\bdrift", sensor=lambda values, time: values + amount * time[:, None])


def quantised(quantum: float) -> Fault:
    """Returns a ranger with few digits [m]."""
    return Fault(
        ("*quanti*", "*resolution*"),
        r"quanti|resolution|digits|noise_std",
        rows=lambda rows, random: replace(rows, values=quantum * np.round(rows.values / quantum)),
    )


def heavy_tails() -> Fault:
    """Returns noise of Student's t with three degrees of freedom, of the stated standard deviation."""
    return Fault(
        words=r"left out|noise_std",
        noise=lambda random, rows: random.standard_t(3.0, rows.values.shape) / np.sqrt(3.0),
    )


def noise_with_incidence(times: float) -> Fault:
    """Returns noise that grows to so many times where the beam grazes."""

    def noise(random: np.random.Generator, rows: Rows) -> np.ndarray:
        return normal(random, rows) * (1.0 + (times - 1.0) * (1.0 - np.abs(rows.cosine[:, None])))

    return Fault(words=r"noise_std", noise=noise)


def noise_understated() -> Fault:
    """Returns nothing wrong but what is stated of the noise, which the scenario says."""
    return Fault(("*noise*",), r"noise_std")
