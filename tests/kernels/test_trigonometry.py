import math

import numba
import numpy as np

from boresight.kernels.trigonometry import SMALL, sincos, small_sincos

ABSOLUTE = 4e-16
LOST_PER_RADIAN = 4e-17


@numba.njit
def over(angles, sines, cosines):
    for i in range(len(angles)):
        sines[i], cosines[i] = sincos(angles[i])


def worst_error(angles: np.ndarray) -> float:
    sines, cosines = np.empty_like(angles), np.empty_like(angles)
    over(angles, sines, cosines)
    return max(max(abs(s - math.sin(a)), abs(c - math.cos(a))) for a, s, c in zip(angles, sines, cosines, strict=True))


def test_sine_and_cosine_within_a_turn_equal_the_library():
    assert worst_error(np.random.default_rng(0).uniform(-2 * np.pi, 2 * np.pi, 100_000)) <= ABSOLUTE


def test_sine_and_cosine_of_large_angles_lose_a_bit_a_turn():
    for reach in (10.0, 30.0, 100.0):
        angles = np.random.default_rng(1).uniform(-reach, reach, 100_000)
        assert worst_error(angles) <= ABSOLUTE + LOST_PER_RADIAN * reach


def test_sine_and_cosine_at_and_beside_quarter_turns_equal_the_library():
    quarters = np.arange(-4, 5) * (np.pi / 2)
    beside = [quarters + step for step in (0.0, 1e-16, -1e-16, 1e-12, -1e-12, 1e-8, -1e-8, 1e-3, -1e-3)]
    eighths = np.arange(-8, 9) * (np.pi / 4)
    angles = np.concatenate([*beside, eighths, np.nextafter(eighths, 200), np.nextafter(eighths, -200)])
    assert worst_error(angles) <= ABSOLUTE + LOST_PER_RADIAN * 7.0


def test_sine_and_cosine_of_zero_are_exact():
    assert sincos(0.0) == (0.0, 1.0)


def test_small_angles_are_exact_to_the_last_bits():
    angles = np.concatenate([np.linspace(-SMALL, SMALL, 10_001), [1e-300, -1e-17, 0.0]])
    pairs = np.array([small_sincos(angle) for angle in angles])
    np.testing.assert_allclose(pairs[:, 0], np.sin(angles), rtol=0, atol=2e-16)
    np.testing.assert_allclose(pairs[:, 1], np.cos(angles), rtol=0, atol=2.3e-16)
