"""The benchmarks' command line; a full run replaces its own section of results.md, a quick one only prints."""

import argparse
import importlib
import json
import os

NAMES = ("intervals", "robustness", "evolution", "case1", "studies", "compensation")


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("name", choices=NAMES)
    parser.add_argument("--quick", action="store_true", help="a tenth of the work or less; nothing is written")
    parser.add_argument("--json", action="store_true", help="print figures and tables as JSON")
    asked = parser.parse_args()
    for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(threads, "1")  # before NumPy loads: benchmarks count cores by processes
    report = importlib.import_module(f"benchmarks.{asked.name}").run(asked.quick)
    if not asked.quick:
        report.write()
    print(json.dumps(report.as_json(), indent=1) if asked.json else report.as_markdown())


if __name__ == "__main__":
    main()
