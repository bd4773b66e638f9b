"""Workers of a Dask cluster, as an executor like any other."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterator
from concurrent.futures import Executor

from boresight.errors import InputError

PATIENCE_S = 15.0
"""How long to look for the scheduler, and for a first worker."""

DEATHS = 20
"""How many workers may die under a task before the scheduler gives it up."""


_ADDRESS = re.compile(r"((tcp|tls|ucx|wss?)://)?(\[[0-9a-fA-F:.]+\]|[A-Za-z0-9._-]{1,253}):([0-9]{1,5})/?")
_EXPECTED = "expected an address such as tcp://host:8786, as `dask scheduler` prints it"
_SHOWN = 60


@contextlib.contextmanager
def cluster_workers(address: str) -> Iterator[tuple[Executor, int]]:
    """Yields the executor of a Dask scheduler, and how many threads its workers have now.

    Args:
        address: of the scheduler: tcp://host:8786.

    Raises:
        InputError: Dask is not installed, or there is no scheduler or no worker.
    """
    parts = _ADDRESS.fullmatch(address)
    if parts is None or not 0 < int(parts[4]) < 2**16:
        given = ascii(address) if len(address) <= _SHOWN else f"{len(address):,} characters"
        raise InputError(f"--scheduler: got {given}; {_EXPECTED}")
    try:
        from distributed import Client
    except ImportError:
        raise InputError("--scheduler needs Dask; install it with: pip install 'boresight[cluster]'") from None
    try:
        client = Client(address, timeout=PATIENCE_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(
            f"--scheduler: no Dask scheduler answers at {address} ({_first_line(error)}); {_EXPECTED}"
        ) from None
    with client:
        try:
            client.wait_for_workers(1, timeout=PATIENCE_S)
        except TimeoutError:
            raise InputError(
                f"--scheduler: {address} has no workers; start some: dask worker {address} --nworkers 2 --nthreads 1"
            ) from None
        yield client.get_executor(pure=False, retries=DEATHS), sum(client.nthreads().values())


def _first_line(error: Exception) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]
