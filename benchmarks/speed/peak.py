"""The processor's peak, measured: independent fused multiply-adds at the vector width of our kernels.

One vector is loaded for eight fused multiply-adds into eight sums, which the compiler doubles and keeps in registers.
Four sums reached 85 Gflop/s here, five to eight 89 to 90, nine and ten 84, twelve 43: then sums go through memory.
A loop in C of sixteen chains reached 89, and so would 2.8 GHz x 2 units x 8 numbers x 2 operations = 89.6.
"""

from __future__ import annotations

import re
import time
from typing import Any

import numba
import numpy as np

import boresight.kernels.compiling  # noqa: F401 sets the processor's features, and with them the vector width

SUMS, NUMBERS = 8, 1024

_EXPECTED = 80e9
"""Operations a second, about: it says how many rounds fill a time."""


@numba.njit(fastmath=True, error_model="numpy")
def burn(numbers, factors, zero, rounds):
    """Returns a number that depends on every multiplication, all in the precision of what is given."""
    k0, k1, k2, k3, k4, k5, k6, k7 = factors
    total = zero
    for _ in range(rounds):
        a = b = c = d = e = f = g = h = zero
        for i in range(numbers.shape[0]):
            x = numbers[i]
            a += x * k0
            b += x * k1
            c += x * k2
            d += x * k3
            e += x * k4
            f += x * k5
            g += x * k6
            h += x * k7
        total += a * b + c * d + e * f + g * h
    return total


def peak_rate(seconds: float, real: type[np.floating] = np.float64) -> float:
    """Returns the operations a second of a loop that takes about so long; the first call in a precision compiles."""
    expected = _EXPECTED * 8 / np.dtype(real).itemsize
    rounds = max(1, round(seconds * expected / (2 * SUMS * NUMBERS)))
    numbers, factors = np.linspace(0.0, 1.0, NUMBERS).astype(real), tuple(np.linspace(0.5, 1.5, SUMS).astype(real))
    burn(numbers, factors, real(0.0), 1)
    began = time.perf_counter()
    burn(numbers, factors, real(0.0), rounds)
    return 2 * SUMS * NUMBERS * rounds / (time.perf_counter() - began)


def vector_bits(compiled: Any = burn) -> int:
    """Returns the width of the vectors that a compiled function multiplies and adds, or 64 where it is scalar."""
    text = "\n".join(compiled.inspect_asm().values())
    for register, bits in (("zmm", 512), ("ymm", 256), (r"v\d+\.2d", 128)):
        if re.search(rf"v?f(?:n?madd|mla)\w*\s.*{register}", text):
            return bits
    return 128 if re.search(r"mulpd\s", text) else 64
