"""The benchmarks' command line; a full run replaces its own section of results.md, a quick one only prints."""

import argparse
import importlib
import json
import os
import sys
from pathlib import Path

NAMES = (
    "speed",
    "intervals",
    "robustness",
    "trust",
    "placements",
    "evolution",
    "strategies",
    "studies",
    "compensation",
    "beyond",
)


OF_TRUST = ("scenarios", "seeds", "workers", "records")
"""Options that this benchmark alone has."""


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("name", choices=NAMES, nargs="?", default="speed", help="what to measure; speed by default")
    parser.add_argument("--quick", action="store_true", help="a tenth of the work or less; nothing is written")
    parser.add_argument("--json", action="store_true", help="print figures, tables and numbers as JSON")
    parser.add_argument("--gpu", action="store_true", help="speed on an NVIDIA card instead of the processor")
    trust = parser.add_argument_group("trust", "with --scenarios or --seeds, nothing is written")
    trust.add_argument("--scenarios", metavar="GLOB", help='names that match: "*plane*"; `|` stands between several')
    trust.add_argument("--seeds", type=_count, metavar="N", help="campaigns of each scenario; 20 by default")
    trust.add_argument("--workers", type=_count, metavar="W", help="processes; all cores by default")
    trust.add_argument("--records", type=Path, metavar="FILE", help="runs are kept here, and not run again")
    asked = parser.parse_args()
    own = {name: value for name in OF_TRUST if (value := getattr(asked, name)) is not None}
    if own and asked.name != "trust":
        parser.error(f"--{next(iter(own))} is of trust, not {asked.name}")
    if asked.gpu and asked.name != "speed":
        parser.error(f"--gpu measures speed, not {asked.name}")
    for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(threads, "1")  # before NumPy loads: benchmarks count cores by processes
    from boresight.errors import BoresightError

    name = "speed.gpu" if asked.gpu else asked.name
    try:
        report = importlib.import_module(f"benchmarks.{name}").run(asked.quick, **own)
    except BoresightError as error:
        sys.exit(f"benchmarks: {error}")
    if not asked.quick and not {"scenarios", "seeds"} & own.keys():
        report.write()
    print(json.dumps(report.as_json(), indent=1) if asked.json else report.as_markdown())


def _count(text: str) -> int:
    if not text.isascii() or not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"expected a whole number above 0, got {text}")
    return int(text)


if __name__ == "__main__":
    main()
