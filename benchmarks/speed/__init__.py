"""How fast, beside whom, and how near to what the machine can do: `python -m benchmarks [--quick] [--json] [--gpu]`.

One file a workload, one a peer (`peers`). Whatever is compared runs in turns (`timing`); the median of the turns is
the main number, the minimum stands beside it. Beside each time stands where it ended, so that no speed is bought with
a worse answer. `--gpu` measures a card instead (`gpu`).
"""

from __future__ import annotations

from benchmarks.report import Report


def run(quick: bool) -> Report:
    """Returns the speed table and the roofline."""
    from benchmarks.speed.measuring import measure

    return measure(quick)
