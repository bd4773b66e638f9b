"""Many independent runs on every core; results come in order and do not depend on the number of workers."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from typing import Any

from boresight.parallel import in_order, local_workers


def on_all_cores(function: Callable[[Any], Any], tasks: Iterable[Any]) -> list[Any]:
    """Returns the function's value of every task; tasks carry their own seeds."""
    workers = os.environ.get("BORESIGHT_WORKERS")
    with local_workers(int(workers) if workers else None) as pool:
        return in_order(pool, function, list(tasks))
