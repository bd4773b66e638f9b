"""Many independent runs on every core; results come in order and do not depend on the number of workers."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from typing import Any


def on_all_cores(function: Callable[[Any], Any], tasks: Iterable[Any], chunk: int = 8) -> list[Any]:
    """Returns the function's value of every task; tasks carry their own seeds."""
    with ProcessPoolExecutor(max_workers=int(os.environ.get("BORESIGHT_WORKERS", os.cpu_count() or 1))) as pool:
        return list(pool.map(function, tasks, chunksize=chunk))
