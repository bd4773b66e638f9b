"""Counter-based random numbers: a number depends on its address alone, never on who drew before.

An address is (seed, run, generation, member, draw). Any worker can compute any number, so a study gives
the same answer on one worker or many, and a search can be replayed from any generation.

The mixing function is the finaliser of SplitMix64 (Steele, Lea & Flood, "Fast splittable pseudorandom
number generators", OOPSLA 2014); the draws of one key are exactly that generator's sequence from it.
It was preferred to Philox 4x32-10, which needs ten rounds for the same 64 bits. Keys are `np.uint64`: a plain
int would be compiled as a signed number and give others.
"""

from __future__ import annotations

import numpy as np

from boresight.kernels.compiling import compiled

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
_MIX_2 = np.uint64(0x94D049BB133111EB)
_S30, _S27, _S31, _S32 = np.uint64(30), np.uint64(27), np.uint64(31), np.uint64(32)
_LOW = np.uint64(0xFFFFFFFF)
_UNIT = 1.0 / 4294967296.0


@compiled
def mix(z):
    """Returns 64 well-mixed bits of a 64-bit number."""
    z = (z ^ (z >> _S30)) * _MIX_1
    z = (z ^ (z >> _S27)) * _MIX_2
    return z ^ (z >> _S31)


@compiled
def draw(key, index):
    """Returns the 64 bits of draw number `index` (from 0) under a key."""
    return mix(key + (np.uint64(index) + np.uint64(1)) * _GOLDEN)


@compiled
def subkey(key, index):
    """Returns the key of stream number `index` under a key; streams of different indices are unrelated."""
    return mix(mix(key + _GOLDEN) ^ ((np.uint64(index) + np.uint64(1)) * _MIX_2))


@compiled
def run_key(seed, run):
    """Returns the key of one run of one seed."""
    return subkey(mix(np.uint64(seed) + _GOLDEN), run)


@compiled
def low_uniform(bits):
    """Returns a number in [0, 1) from the low 32 bits of a draw."""
    return np.float64(np.int64(bits & _LOW)) * _UNIT


@compiled
def high_uniform(bits):
    """Returns a number in [0, 1) from the high 32 bits of a draw."""
    return np.float64(np.int64(bits >> _S32)) * _UNIT


@compiled
def below(bits, count):
    """Returns a whole number in [0, count) from the high 32 bits of a draw, count being at most 2^32.

    By a product instead of a remainder (Lemire, "Fast random integer generation in an interval", 2019, without its
    rejection: no number is likelier than another by more than count / 2^32). Remainders took 2 ns more each.
    """
    return ((bits >> _S32) * np.uint64(count)) >> _S32
