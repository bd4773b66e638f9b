"""The benchmarks' command line; a full run replaces its own section of results.md, a quick one only prints."""

import argparse
import importlib
import json
import os
import sys

NAMES = (
    "speed",
    "intervals",
    "robustness",
    "evolution",
    "strategies",
    "studies",
    "compensation",
    "beyond",
)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("name", choices=NAMES, nargs="?", default="speed", help="what to measure; speed by default")
    parser.add_argument("--quick", action="store_true", help="a tenth of the work or less; nothing is written")
    parser.add_argument("--json", action="store_true", help="print figures, tables and numbers as JSON")
    parser.add_argument("--gpu", action="store_true", help="speed on an NVIDIA card instead of the processor")
    asked = parser.parse_args()
    if asked.gpu and asked.name != "speed":
        parser.error(f"--gpu measures speed, not {asked.name}")
    for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(threads, "1")  # before NumPy loads: benchmarks count cores by processes
    from boresight.errors import BoresightError

    name = "speed.gpu" if asked.gpu else asked.name
    try:
        report = importlib.import_module(f"benchmarks.{name}").run(asked.quick)
    except BoresightError as error:
        sys.exit(f"benchmarks: {error}")
    if not asked.quick:
        report.write()
    print(json.dumps(report.as_json(), indent=1) if asked.json else report.as_markdown())


if __name__ == "__main__":
    main()
