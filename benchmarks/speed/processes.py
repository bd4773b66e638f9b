"""A command as a process of its own: wall time, processor time and peak memory, as its operating system counts them."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ACCEPTED_OR_NOT = (0, 2)
"""Exit codes of a calibration that ran."""


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
        began = time.perf_counter()
        process = subprocess.Popen(
            command,
            cwd=folder,
            env=os.environ | dict(environment or {}),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=errors,
        )
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - began
        process.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        said = errors.read().decode(errors="replace")
    in_bytes = 1 if sys.platform == "darwin" else 1024
    return Ended(process.returncode, wall, usage.ru_utime, usage.ru_maxrss * in_bytes, said)
