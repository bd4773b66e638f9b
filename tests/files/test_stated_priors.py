"""Standard deviations that a campaign states of what it does not estimate."""

from __future__ import annotations

import math

import numpy as np
import pytest

from boresight.errors import InputError

UNITS = "units: {length: mm, angle: deg}\nsensor:"


def in_millimetres(campaign_with, *pairs):
    lengths = ("sensor:", UNITS), ("0.0002", "0.2"), ("-0.69", "-690")
    return campaign_with(*lengths, ("within: 0.025", "within: 1"), *pairs)


def loaded(folder, text):
    return folder.write(campaign=text, observations="j1,j2,range\n10,20,300\n15,30,310\n").load()


def test_sensor_plane_and_frames_are_read_in_the_campaigns_units(folder, campaign_with):
    text = in_millimetres(
        campaign_with,
        ("noise_std: 0.2", "noise_std: 0.2, bias_std: 0.5, scale_std: 0.0005"),
        ("offset: -690", "offset: -690, offset_std: 2, normal_std: 0.1"),
        ("targets:", "base: {xyz: [0, 0, 0], rpy: [0, 0, 0], xyz_std: 3, rpy_std: 0.2}\ntargets:"),
    )
    priors = loaded(folder, text).priors
    assert priors["sensor.bias"] == pytest.approx(0.5e-3)
    assert priors["sensor.scale"] == pytest.approx(5e-4)
    assert priors["deck.offset"] == pytest.approx(2e-3)
    assert priors["deck.normal_x"] == pytest.approx(math.radians(0.1))  # at right angles to the normal: the whole tilt
    assert {priors[f"base.{axis}"] for axis in "xyz"} == {3e-3}
    assert priors["base.yaw"] == pytest.approx(math.radians(0.2))


def test_flatness_is_the_width_of_a_uniform_zone(folder, campaign_with):
    plain = loaded(folder, in_millimetres(campaign_with)).readings
    flat = loaded(folder, in_millimetres(campaign_with, ("offset: -690", "offset: -690, flatness: 0.3"))).readings
    added = np.sqrt(flat.std**2 - plain.std**2)
    assert np.all(added >= 0.3e-3 / math.sqrt(12.0) * (1.0 - 1e-9))


def test_joint_noise_of_an_unknown_joint_is_refused_with_those_there_are(folder, campaign_with):
    with pytest.raises(InputError, match=r"joint_noise_std.*there is no such joint; the joints are j1, j2"):
        loaded(folder, in_millimetres(campaign_with, ("sensor:", "joint_noise_std: {j9: 0.01}\nsensor:")))


def test_joint_noise_is_of_every_revolute_joint_or_by_name(folder, campaign_with):
    every = loaded(folder, in_millimetres(campaign_with, ("sensor:", "joint_noise_std: 0.01\nsensor:")))
    assert every.joint_noise_std == pytest.approx((math.radians(0.01),) * 2)
    one = loaded(folder, in_millimetres(campaign_with, ("sensor:", "joint_noise_std: {j2: 0.02}\nsensor:")))
    assert one.joint_noise_std == pytest.approx((0.0, math.radians(0.02)))


def test_a_prior_that_reaches_no_parameter_is_refused(folder, campaign_with):
    text = in_millimetres(campaign_with, ("sensor:", "priors: [{parameters: [j9.d], prior_std: 1}]\nsensor:"))
    with pytest.raises(InputError, match="j9"):
        loaded(folder, text)
