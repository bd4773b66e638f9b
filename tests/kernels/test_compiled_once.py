"""What a process compiles itself and what it loads from disk give the same numbers, to the last bit."""

import os
import subprocess
import sys

import pytest

SCRIPT = """
import hashlib
import numpy as np
from boresight.kernels.reducing import fold
rng = np.random.default_rng(0)
for rows in (30, 45, 128, 300):
    triangle = np.zeros((25, 25))
    fold(triangle, rng.random((25, rows)))
    print(hashlib.sha256(triangle.tobytes()).hexdigest())
"""


@pytest.mark.long
def test_the_first_process_on_a_machine_computes_what_later_ones_do(tmp_path):
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    first, later = (
        subprocess.run([sys.executable, "-c", SCRIPT], env=environment, capture_output=True, text=True, check=True)
        for _ in range(2)
    )
    assert len(first.stdout.split()) == 4
    assert first.stdout == later.stdout
