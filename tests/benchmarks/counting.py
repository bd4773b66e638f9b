"""Numbers that count what is computed with them."""

from __future__ import annotations

import math
from types import SimpleNamespace


class Counted:
    """A float; every addition, subtraction, multiplication, division and root of one counts, a change of sign not."""

    __array_ufunc__ = None
    operations = 0

    def __init__(self, value):
        self.value = float(value)

    @classmethod
    def of(cls, value):
        cls.operations += 1
        return cls(value)

    def __add__(self, other):
        return Counted.of(self.value + float(other))

    def __sub__(self, other):
        return Counted.of(self.value - float(other))

    def __rsub__(self, other):
        return Counted.of(float(other) - self.value)

    def __mul__(self, other):
        return Counted.of(self.value * float(other))

    def __truediv__(self, other):
        return Counted.of(self.value / float(other))

    def __rtruediv__(self, other):
        return Counted.of(float(other) / self.value)

    __radd__, __rmul__ = __add__, __mul__

    def __neg__(self):
        return Counted(-self.value)

    def __lt__(self, other):
        return self.value < float(other)

    def __gt__(self, other):
        return self.value > float(other)

    def __float__(self):
        return self.value


def _sqrt(value):
    return Counted.of(math.sqrt(float(value)))


MATH = SimpleNamespace(sqrt=_sqrt)
"""In place of `math`, which would take numbers out of the count."""
