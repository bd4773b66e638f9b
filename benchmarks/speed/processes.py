"""A command as a process of its own: wall time, processor time and peak memory, as its operating system counts them."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ACCEPTED_OR_NOT = (0, 2)
"""Exit codes of a calibration that ran."""

_COUNTING = """
import os, sys, time
began = time.perf_counter()
quiet = os.open(os.devnull, os.O_WRONLY)
child = os.posix_spawn(sys.argv[1], sys.argv[1:], os.environ, file_actions=[(os.POSIX_SPAWN_DUP2, quiet, 1)])
_, status, usage = os.wait4(child, 0)
print(os.waitstatus_to_exitcode(status), time.perf_counter() - began, usage.ru_utime, usage.ru_maxrss)
"""
"""Starts a command from a small process: on Linux, a child's peak memory begins with that of who started it, which
here may be half a gigabyte."""


@dataclass(frozen=True)
class Ended:
    """A process that has ended.

    Attributes:
        code: its exit code.
        wall: time from its start to its end [s].
        user: processor time of all its threads [s].
        peak: largest resident memory [bytes].
        said: what it wrote on stderr.
    """

    code: int
    wall: float
    user: float
    peak: int
    said: str


def boresight(arguments: Sequence[str], folder: Path, environment: Mapping[str, str] | None = None) -> Ended:
    """Returns how `python -m boresight ...` ended, run in a folder.

    Args:
        arguments: of the command.
        folder: where it runs; files it writes stay there.
        environment: what differs from this process's own.
    """
    command = [sys.executable, "-m", "boresight", *arguments]
    with tempfile.TemporaryFile() as errors:
        counted = subprocess.run(
            [sys.executable, "-I", "-S", "-c", _COUNTING, *command],
            cwd=folder,
            env=os.environ | dict(environment or {}),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=errors,
            check=True,
        )
        errors.seek(0)
        said = errors.read().decode(errors="replace")
    code, wall, user, peak = counted.stdout.split()
    in_bytes = 1 if sys.platform == "darwin" else 1024
    return Ended(int(code), float(wall), float(user), int(peak) * in_bytes, said)
