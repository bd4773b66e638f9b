"""Plain YAML scalars by the core schema of YAML 1.2, and nothing else.

YAML 1.1 reads `no` as false, `1:30` as 90 and `1_000` as 1000; a file of numbers can do without.
"""

from __future__ import annotations

import math
import re

Scalar = bool | int | float | str | None

_WORDS: dict[str, bool | float | None] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((sign + word for sign in ("", "+") for word in (".inf", ".Inf", ".INF")), math.inf),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), -math.inf),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), math.nan),
}
_BASES = ((re.compile(r"[-+]?[0-9]+"), 10), (re.compile(r"0o[0-7]+"), 8), (re.compile(r"0x[0-9a-fA-F]+"), 16))
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_LONGEST_NUMBER = 400

TAGS = {f"tag:yaml.org,2002:{kind}" for kind in ("null", "bool", "int", "float", "str")}
"""The tags a scalar may carry in writing (`!!str 5`)."""


def plain_scalar(text: str) -> Scalar:
    """Returns the value of a scalar written without quotes."""
    if text in _WORDS:
        return _WORDS[text]
    if len(text) > _LONGEST_NUMBER:
        return text
    for pattern, base in _BASES:
        if pattern.fullmatch(text):
            whole = int(text, base)
            # Beyond 64 bits nobody counts: a number of that size is a measure.
            return whole if abs(whole) < 2**63 else _as_float(whole)
    return float(text) if _FLOAT.fullmatch(text) else text


def _as_float(whole: int) -> float:
    try:
        return float(whole)
    except OverflowError:
        return math.inf
