"""Everything the paper's section 4 claims, measured over many seeds."""

from __future__ import annotations

from collections.abc import Callable

from boresight.parallel import completed, local_workers, worker_count
from boresight.reproduction.measurements import Measurements
from boresight.reproduction.trials import Trial, run_trial
from boresight.reproduction.variants import modern_is_installed, variants

SEEDS = 300
"""Seeds of a full run: a share of 95 % is then known to ± 2.5 % (two standard errors)."""

QUICK_SEEDS = 16
"""Seeds of a quick run."""


def reproduce(
    seeds: int = SEEDS,
    *,
    seed: int = 0,
    workers: int | None = None,
    on_progress: Callable[[int], None] | None = None,
) -> Measurements:
    """Returns what was measured: every variant for every seed, the same on any number of workers, times aside.

    Args:
        seeds: how many.
        seed: the first of them; the others follow it.
        workers: processes; one a core by default.
        on_progress: called with the number of seeds done.
    """
    modern = modern_is_installed()
    tasks = [(seed + place, variants(modern)) for place in range(seeds)]
    trials: dict[int, Trial] = {}
    if worker_count(workers) == 1 or seeds == 1:
        for place, task in enumerate(tasks):
            trials[place] = run_trial(task)
            if on_progress:
                on_progress(len(trials))
        return Measurements(tuple(trials.values()), modern)
    with local_workers(workers) as pool:
        for place, trial in completed(pool, run_trial, tasks):
            trials[place] = trial
            if on_progress:
                on_progress(len(trials))
    return Measurements(tuple(trials[place] for place in range(seeds)), modern)
