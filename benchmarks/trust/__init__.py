"""Whether a result is ever silently wrong: accepted, its cause not named, the tool further off than twice what is said.

Many kinds of campaigns (`scenarios.py`), each drawn afresh for every seed by kinematics and sensors that share nothing
with the package: every independent number of the arm is wrong by 1.5 mrad or 1.5 mm (standard deviation; for an arm of
usual reach), in a few as widely as the default prior, and one thing that users meet goes wrong. The files are written,
loaded and calibrated with the defaults, evolution included, as `boresight calibrate` does. Then the tool's position is
compared with the truth at the 500 configurations of the result's pose uncertainty: in the base frame where the result
is accepted for absolute accuracy, after the best rigid motion where it is for relative.

`judging.py` says what the outcomes are, `claims.py` what counts as named; the truth is how the cell stands after the
last row. Lengths in the tables are root mean squares over the configurations, medians over the accepted runs; the
ratios' 95 % are percentiles over them; `turn` is the orientation's error in the base frame, which is not judged;
`relative` counts runs that are accepted for relative accuracy; `before` is the nominal arm's true error.
"""

from __future__ import annotations

import sys
from pathlib import Path

from benchmarks.report import Report
from benchmarks.trust.records import DEFAULT, Records
from benchmarks.trust.running import Record, run_one
from benchmarks.trust.scenarios import matching
from benchmarks.trust.tables import figures_of, tables_of
from boresight.errors import InputError
from boresight.parallel import completed, local_workers

SEEDS, SEEDS_QUICK = 20, 1

NOTE = (
    "*covered*: accepted, and the true error is within the claimed 95 % radius; *named*: outside, but a warning, a "
    "reason or one of the first three explanations or sensitivities names the cause; *wide*: outside, within twice the "
    "radius; *SILENT*: beyond twice the radius, and nothing names the cause. Behind a name stands in how many runs."
)


def run(
    quick: bool,
    scenarios: str = "*",
    seeds: int | None = None,
    workers: int | None = None,
    records: Path = DEFAULT,
) -> Report:
    """Returns the report of all runs.

    Args:
        quick: one seed each.
        scenarios: a pattern of names.
        seeds: how many, from 0.
        workers: how many processes; all cores by default.
        records: file that runs are kept in.

    Raises:
        InputError: no scenario has such a name.
    """
    count = seeds or (SEEDS_QUICK if quick else SEEDS)
    found = matching(scenarios)
    if not found:
        raise InputError(f"--scenarios {scenarios}: no scenario matches; benchmarks/trust/scenarios.py names them all")
    tasks = [(each.name, seed) for each in found for seed in range(count)]
    kept = run_all(tasks, workers, Records(records))
    return Report(
        "trust",
        f"{len(found)} kinds of campaigns, {count} each, calibrated with the defaults; the module's docstring says how "
        "they are drawn and judged.",
        figures_of(kept),
        tables_of(kept),
        (NOTE,),
        {"runs": [each.as_json() for each in kept]},
    )


def run_all(tasks: list[tuple[str, int]], workers: int | None, records: Records) -> list[Record]:
    """Returns the records of all tasks, in order; those that are on file are not run again."""
    missing = [task for task in tasks if task not in records.found]
    if workers == 1:
        for place, task in enumerate(missing):
            _kept(run_one(task), place, len(missing), records)
    elif missing:
        with local_workers(workers) as pool:
            for place, (_, record) in enumerate(completed(pool, run_one, missing)):
                _kept(record, place, len(missing), records)
    return [records.found[task] for task in tasks]


def _kept(record: Record, place: int, of: int, records: Records) -> None:
    """Files a run and tells of it, on one line of a terminal."""
    records.add(record)
    last = place + 1 == of
    said = f"{place + 1}/{of}  {record.outcome}: {record.scenario}, seed {record.seed}"
    if sys.stderr.isatty():
        print(f"\r{said:<100}", end="\n" if last else "", file=sys.stderr, flush=True)
    elif last or (place + 1) % 20 == 0:
        print(said, file=sys.stderr, flush=True)
