import itertools

import numba
import numpy as np

from boresight.kernels.random import below, draw, high_uniform, low_uniform, run_key, subkey

COUNT = 100_000
CHI_SQUARE_99_DEGREES = (58.0, 157.0)
"""Between these a chi-square of 99 degrees of freedom lies but for 0.05 % of seeds at either end."""
SIGMAS = 4.5


@numba.njit
def draws(key, count):
    out = np.empty(count, dtype=np.uint64)
    for i in range(count):
        out[i] = draw(key, i)
    return out


@numba.njit
def first_draws_of_neighbouring_keys(key, count):
    out = np.empty(count, dtype=np.uint64)
    for i in range(count):
        out[i] = draw(subkey(key, i), 0)
    return out


@numba.njit
def uniforms(bits, low, high):
    for i in range(len(bits)):
        low[i], high[i] = low_uniform(bits[i]), high_uniform(bits[i])


@numba.njit
def key_at(seed, run, generation, member):
    return subkey(subkey(run_key(seed, run), generation), member)


def key_of(seed, run):
    """Keys are 64 unsigned bits: numba would take a small Python integer for a signed number."""
    return np.uint64(run_key(np.uint64(seed), np.uint64(run)))


def low_and_high(bits):
    low, high = np.empty(len(bits)), np.empty(len(bits))
    uniforms(bits, low, high)
    return low, high


def test_draws_are_splitmix64():
    """The published vector of seed 1234567 (Vigna's splitmix64.c, as in Rosetta Code and Java's SplittableRandom)."""
    assert draws(np.uint64(1234567), 5).tolist() == [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
        4593380528125082431,
        16408922859458223821,
    ]


def test_a_draw_depends_on_its_index_alone():
    key = np.uint64(99)
    assert [int(draw(key, i)) for i in (7, 3, 5)] == draws(key, 8)[[7, 3, 5]].tolist()


def chi_square(uniform: np.ndarray) -> float:
    counts = np.bincount((uniform * 100).astype(int), minlength=100)
    expected = len(uniform) / 100
    return float(np.sum((counts - expected) ** 2) / expected)


def test_draws_of_one_key_are_uniform():
    for uniform in low_and_high(draws(key_of(1, 0), COUNT)):
        assert uniform.min() >= 0.0
        assert uniform.max() < 1.0
        assert CHI_SQUARE_99_DEGREES[0] < chi_square(uniform) < CHI_SQUARE_99_DEGREES[1]


def test_first_draws_of_neighbouring_keys_are_uniform():
    for uniform in low_and_high(first_draws_of_neighbouring_keys(key_of(1, 0), COUNT)):
        assert CHI_SQUARE_99_DEGREES[0] < chi_square(uniform) < CHI_SQUARE_99_DEGREES[1]


def test_low_and_high_halves_and_neighbouring_keys_are_uncorrelated():
    low, high = low_and_high(draws(key_of(1, 0), COUNT))
    first_low, first_high = low_and_high(first_draws_of_neighbouring_keys(key_of(1, 0), COUNT))
    pairs = [
        (low, high),
        (low[1:], low[:-1]),
        (high[1:], low[:-1]),
        (first_low[1:], first_low[:-1]),
        (first_high[1:], first_high[:-1]),
        (first_low[2:], first_low[:-2]),
        (first_low, low),
        (first_low, low_and_high(first_draws_of_neighbouring_keys(key_of(1, 1), COUNT))[0]),
        (first_low, low_and_high(first_draws_of_neighbouring_keys(key_of(2, 0), COUNT))[0]),
    ]
    for one, other in pairs:
        assert abs(np.corrcoef(one, other)[0, 1]) < SIGMAS / np.sqrt(len(one))


def test_every_bit_flips_in_half_of_neighbouring_keys():
    bits = first_draws_of_neighbouring_keys(key_of(5, 5), COUNT)
    flipped = bits[1:] ^ bits[:-1]
    for place in range(64):
        share = np.mean((flipped >> np.uint64(place)) & np.uint64(1))
        assert abs(share - 0.5) < SIGMAS * 0.5 / np.sqrt(COUNT)


def test_every_address_has_its_own_key():
    addresses = list(itertools.product(range(6), range(6), range(6), range(6)))
    keys = {int(key_at(*address)) for address in addresses}
    assert len(keys) == len(addresses)


def test_whole_numbers_below_a_count_are_uniform():
    bits = draws(key_of(3, 0), COUNT)
    picked = np.array([int(below(each, 100)) for each in bits])
    assert picked.min() == 0
    assert picked.max() == 99
    squares = np.sum((np.bincount(picked, minlength=100) - COUNT / 100) ** 2) / (COUNT / 100)
    assert CHI_SQUARE_99_DEGREES[0] < squares < CHI_SQUARE_99_DEGREES[1]
    assert {int(below(each, 1)) for each in bits[:100]} == {0}
