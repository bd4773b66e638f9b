"""How a mutant is made (paper, eq. 14 to 16).

Every strategy here is `o + K (best - o) + F (b - c)`: an origin o, drawn by K towards the best member, plus
a scaled difference of two random members.

| name | origin o | K | |
|---|---|---|---|
| `rand/1` | a random member | 0 | eq. 14; diverse and slow |
| `best/1` | a random member | 1 | eq. 15; fast and easily caught |
| `trade-off` | a random member | 1/2 | eq. 16; between the two, the default |
| `rand-to-best/1` | a random member | F | eq. 16 with K = F (Storn & Price's name) |
| `current-to-best/1` | the member itself | F | |

The paper's equation (16) is lost; `trade-off` and `rand-to-best/1` are the two readings of it that behave as
the paper reports. Over seeds K = 1/2 was the more reliable.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Strategy:
    """A way to make mutants.

    Attributes:
        name: as the command line knows it.
        pull: K; None stands for K = F.
        from_current: whether the origin is the member itself rather than a random one.
    """

    name: str
    pull: float | None
    from_current: bool = False


RAND_1 = Strategy("rand/1", 0.0)
BEST_1 = Strategy("best/1", 1.0)
TRADE_OFF = Strategy("trade-off", 0.5)
RAND_TO_BEST_1 = Strategy("rand-to-best/1", None)
CURRENT_TO_BEST_1 = Strategy("current-to-best/1", None, from_current=True)

STRATEGIES: dict[str, Strategy] = {
    strategy.name: strategy for strategy in (TRADE_OFF, RAND_TO_BEST_1, CURRENT_TO_BEST_1, BEST_1, RAND_1)
}
"""Every strategy by name."""
